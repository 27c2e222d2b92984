"""A puppet on a phone: ARKit's weights move it over a socket, thirty times a second.

python docs/examples/arkit_puppet.py [URL] [--face SESSION] [--seconds 10]
"""

import argparse
import math
import time

from service.client import Client

FPS = 30
LEASE = 0.5  # Seconds for which the face stays as it was told, should the phone go silent.


def weights(seconds: float) -> dict[str, float]:
    """Return what a phone would send: made up here, a face that smiles, talks, looks and blinks."""
    smile = 0.5 - 0.5 * math.cos(2.0 * math.pi * seconds / 3.0)
    blink = max(0.0, 1.0 - abs(seconds % 2.0 - 0.7) / 0.12)
    left, right = (max(0.0, side * math.sin(1.7 * seconds)) for side in (0.6, -0.6))
    return {
        "mouthSmileLeft": smile,
        "mouthSmileRight": 0.7 * smile,
        "cheekSquintLeft": 0.5 * smile,
        "cheekSquintRight": 0.4 * smile,
        "browInnerUp": 0.5 * (1.0 - smile),
        "jawOpen": 0.25 * abs(math.sin(9.0 * seconds)),
        "mouthLeft": 0.2 * smile,
        "eyeBlinkLeft": blink,
        "eyeBlinkRight": blink,
        "eyeLookOutLeft": left,
        "eyeLookInRight": left,
        "eyeLookInLeft": right,
        "eyeLookOutRight": right,
    }


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("url", nargs="?", default="http://127.0.0.1:8000")
parser.add_argument("--face", help="session of a face that is open already")
parser.add_argument("--seconds", type=float, default=10.0)
asked = parser.parse_args()
with Client(asked.url) as client:
    face = client.face(asked.face) if asked.face else client.open_face()
    print("watch it:", face.viewer_url)
    mine = {"owner": "phone", "ttl": LEASE, "fade": 1.0 / FPS, "fade_out": 0.3}
    begin, warned = time.monotonic(), set()
    with face.commands() as commands:
        for frame in range(round(asked.seconds * FPS)):
            for warning in commands.set_controls(arkit=weights(frame / FPS), **mine):
                if warning not in warned:  # The same one comes with each frame.
                    print("warning:", warning)
                    warned.add(warning)
            if frame % FPS == FPS - 1:
                units = face.state()["merged"]["action_units"].items()
                print(f"{(frame + 1) / FPS:.0f} s:", *(f"{k}:{v:.1f}" for k, v in units if v > 0.1))
            time.sleep(max(0.0, begin + (frame + 1) / FPS - time.monotonic()))
    time.sleep(LEASE + 0.2)
    print("The lease is over; held now:", face.state()["layers"] or "nothing")
