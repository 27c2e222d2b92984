"""A chat agent's face: a classifier's scores move it, and timed visemes speak each line on it.

python docs/examples/chat_agent.py [URL] [--face SESSION] [--seconds 30]
"""

import argparse
import time

from service.client import Client, Face

# Of each line what a voice and a classifier make of it: visemes, here of 0.09 s each, and the
# greatest of GoEmotions' 28 scores, here 0.004 for each of the others. Yours come from your own.
LINES = [
    ("You made it back!", "I ou PP E DD I DD PP aa kk", {"joy": 0.62, "surprise": 0.16}),
    ("Is it still raining?", "I SS I DD SS DD I RR E nn I nn", {"curiosity": 0.5, "neutral": 0.2}),
    ("Sit down, tea is ready.", "SS I DD aa nn DD I SS RR E DD I", {"caring": 0.5, "joy": 0.3}),
]


def look(when: str, merged: dict, layers: dict, **_: object) -> None:
    """Print what the face is told to show, how hard the smile pulls, and who holds what."""
    shown = " ".join(f"{unit}:{v:.1f}" for unit, v in merged["action_units"].items() if v > 0.1)
    smile = merged["muscles"].get("zygomatic_major.L", 0.0)
    held = [f"{w['owner']} in {name}" for name, o in layers.items() for w in o["writers"]]
    print(f"  {when}: {shown}; smile {smile:.2f}; {' and '.join(held)}")


def say(face: Face, line: str, visemes: str, scores: list[dict[str, object]]) -> None:
    """Feel a line, then speak it: the mouth is the voice's meanwhile, the rest stays felt."""
    # Of an owner, and with a lease: others may move the face too, and nothing stays for ever.
    felt = face.set_emotion(scores=scores, vocabulary="goemotions", owner="dialogue", ttl=30.0)
    parts = [f"{p['weight']:.2f} {p['recipe']}" for p in felt["parts"] if p["weight"] > 0.05]
    print(line, "->", " + ".join(parts))
    time.sleep(0.7)
    look("before", **face.state())
    cues = [{"viseme": each, "duration": 0.09} for each in visemes.split()]
    spoken = face.speak(cues, owner="voice")
    time.sleep(spoken["sound_in"] + spoken["seconds"] / 2)  # After `sound_in` start your sound.
    look("speaking", **face.state())
    time.sleep(spoken["seconds"] / 2 + 0.2)
    look("after", **face.state())
    for warning in felt["warnings"] + spoken["warnings"]:
        print("  warning:", warning)


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("url", nargs="?", default="http://127.0.0.1:8000")
parser.add_argument("--face", help="session of a face that is open already")
parser.add_argument("--seconds", type=float, default=30.0, help="after these no line begins")
asked = parser.parse_args()
with Client(asked.url) as client:
    face = client.face(asked.face) if asked.face else client.open_face()
    print("watch it:", face.viewer_url)
    (words,) = client.json("GET", "/api/emotions?vocabulary=goemotions")["vocabularies"]
    begin = time.monotonic()
    for line, visemes, greatest in LINES:
        if time.monotonic() - begin < asked.seconds:
            scores = {**{row["label"]: 0.004 for row in words["labels"]}, **greatest}
            say(face, line, visemes, [{"label": k, "score": v} for k, v in scores.items()])
    face.set_controls(replace=True, layer="emotion", owner="dialogue", fade=0.8)  # Let go.
