"""An independent detector finds every person's face, in every action unit, from five sides.

Optional, and some half an hour long: it runs where MediaPipe, whose package holds its detector's
weights, is installed (`.venv/bin/pip install mediapipe==0.10.14`).
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from engine import builtin_rig, people

mediapipe = pytest.importorskip("mediapipe", reason="MediaPipe, an optional detector, is missing")

pytestmark = [pytest.mark.browser, pytest.mark.filterwarnings("ignore")]
SIDES = "0,25,-25,50,-50"
HEAD_TURNS = tuple(f"AU{code}" for code in range(51, 59))
"""These turn the head by up to 50 degrees themselves: seen from the front they are a side."""
LEAST_SCORE = 0.5


@pytest.fixture(scope="module")
def detector() -> Iterator[Any]:
    """MediaPipe's short-range face detector."""
    detection = mediapipe.solutions.face_detection
    with detection.FaceDetection(model_selection=0, min_detection_confidence=0.1) as found:
        yield found


@pytest.mark.parametrize("person", sorted(people()))
def test_a_face_is_found_in_every_unit_from_every_side(
    person: str, detector: Any, tmp_path: Path, record_property: Callable[[str, object], None]
) -> None:
    rig = builtin_rig("standard")
    named = ("rest", *rig.action_units, *rig.emotions)
    still = [name for name in named if name not in HEAD_TURNS]
    photograph(person, tmp_path, still, SIDES)
    photograph(person, tmp_path, HEAD_TURNS, "0")
    pictures = sorted(tmp_path.glob("*.jpg"))
    assert len(pictures) == 5 * len(still) + len(HEAD_TURNS)
    scores = {picture.stem: score(detector, picture) for picture in pictures}
    least = min(scores, key=lambda name: scores[name])
    record_property("least", f"{scores[least]:.2f} of {len(scores)}, {least}")
    missed = {name: found for name, found in scores.items() if found < LEAST_SCORE}
    assert missed == {}, f"{len(missed)} of {len(scores)}"


def photograph(person: str, folder: Path, poses: Sequence[str], views: str) -> None:
    """Put a picture of each pose from each view into `folder`."""
    command = [sys.executable, "-m", "service", "sheet", "--rig", person, "-o", str(folder)]
    done = subprocess.run(
        [*command, "--only", ",".join(poses), "--view", views, "--size", "160"],
        cwd=Path(__file__).parents[2],
        capture_output=True,
        text=True,
        timeout=3600,
        check=False,
    )
    assert done.returncode == 0, done.stderr


def score(detector: Any, picture: Path) -> float:
    """Return how sure the detector is of its best face, 0 for none."""
    with Image.open(picture) as image:
        found = detector.process(np.asarray(image.convert("RGB")))
    return max((one.score[0] for one in found.detections or ()), default=0.0)
