"""The six tools, as a model reads of them."""

from __future__ import annotations

from .answered import EmotionSet, ExportedClip, Expressions, FaceNow, OpenedFace, UnitsSet
from .asked import ExportClip, GetState, ListExpressions, OpenFace, SetActionUnits, SetEmotion
from .clips import export_clip
from .expressions import list_expressions
from .faces import get_state, open_face, set_action_units, set_emotion
from .tool import Tool

INSTRUCTIONS = (
    "Risorius is a human face, simulated muscle by muscle, that a person watches in a web page. "
    "Call open_face once, tell the person its viewer_url, and keep its session_id for everything "
    "else. Then give the face what you feel: set_emotion for a feeling by name, set_action_units "
    "for exact facial movements in FACS. Each call is the whole face from then on and moves there "
    "smoothly, so nothing has to be reset first; label neutral, or facs 0, is the face at rest."
)

TOOLS: tuple[Tool, ...] = (
    Tool(
        name="list_expressions",
        title="List expressions",
        description=(
            "List what a face can show: emotions with the FACS units that they play, action units "
            "with what is seen, and the people whose faces can be opened. You rarely need it: "
            "set_emotion understands any common emotion word or face emoji. Call it to choose "
            "among fine shades, to look up which action unit does what, or to read the labels of "
            "a published set such as goemotions. It changes nothing."
        ),
        asks=ListExpressions,
        answers=Expressions,
        run=list_expressions,
        reads_only=True,
        repeats=True,
    ),
    Tool(
        name="open_face",
        title="Open a face",
        description=(
            "Open a new face, at rest. Call this once, before anything else, and use the "
            "session_id that it answers in every other call; a second call opens a second face. "
            "Always tell the user the viewer_url: it is the web page on which they see the face."
        ),
        asks=OpenFace,
        answers=OpenedFace,
        run=open_face,
    ),
    Tool(
        name="set_emotion",
        title="Set an emotion",
        description=(
            "Make the face show an emotion, in place of what you set before: "
            '{"session_id": "…", "label": "happiness", "intensity": 0.7}. Give label for one '
            "emotion, scores for a mixture, or valence and arousal. It stays until your next call; "
            "with hold, in seconds, it passes by itself, as a reaction does. label neutral is "
            "rest. An unknown word is refused with the nearest ones that are known. The answer "
            "names the FACS units played and where they come from."
        ),
        asks=SetEmotion,
        answers=EmotionSet,
        run=set_emotion,
    ),
    Tool(
        name="set_action_units",
        title="Set action units",
        description=(
            "Make the face show exact movements, in FACS, in place of what you set before: "
            '{"session_id": "…", "facs": "6C+12D"} is a smile that reaches the eyes. With keep '
            "true it is added to what you set before: L46E adds a wink, 51C a turned head. Common "
            "units: 1 and 2 raise the inner and outer brows, 4 lowers them, 5 widens the eyes, 6 "
            "raises the cheeks, 7 tightens the lids, 9 wrinkles the nose, 10 raises the upper "
            "lip, 12 smiles, 15 lowers the lip corners, 17 raises the chin, 20 stretches the "
            "lips, 23 tightens them, 25 parts them, 26 drops the jaw, 43 closes the eyes, 51 and "
            "52 turn the head left and right, 53 and 54 lift and lower it, 61 and 62 move the "
            "eyes left and right. facs 0 lets go. warnings name every unit that clashes or is "
            "absent."
        ),
        asks=SetActionUnits,
        answers=UnitsSet,
        run=set_action_units,
        repeats=True,
    ),
    Tool(
        name="get_state",
        title="Look at a face",
        description=(
            "Read what a face is told to show now: as FACS, by layer, and by writer, for others "
            "(a speech program, a person at the sliders) may move the same face. Call it when the "
            "user asks how the face looks, or when it may have been changed by somebody else; not "
            "after every call of yours, whose answers say what was set. It changes nothing."
        ),
        asks=GetState,
        answers=FaceNow,
        run=get_state,
        reads_only=True,
        repeats=True,
    ),
    Tool(
        name="export_clip",
        title="Export a clip",
        description=(
            "Render an animation to a file (GLB, for Blender, Unity, Unreal, three.js) and answer "
            "its URL, which you give to the user. Either give timeline, a list of moments, each "
            'the whole face from then on: [{"time": 0, "emotion": "surprise"}, {"time": 1.5, '
            '"emotion": "happiness"}, {"time": 4, "facs": "0"}]; or give session_id for the '
            "last seconds of a live face. If status is not done when it answers, call it again "
            "with clip_id."
        ),
        asks=ExportClip,
        answers=ExportedClip,
        run=export_clip,
    ),
)
