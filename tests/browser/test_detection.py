"""An independent detector finds every person's face, in every action unit, from five sides.

Optional, and some half an hour long: it runs where MediaPipe, whose package holds its detector's
weights, is installed (`.venv/bin/pip install mediapipe==0.10.14`).
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

mediapipe = pytest.importorskip("mediapipe", reason="MediaPipe, an optional detector, is missing")

from engine import people  # noqa: E402

pytestmark = [pytest.mark.browser, pytest.mark.filterwarnings("ignore")]
SIDES = "0,25,-25,50,-50"
LEAST_SCORE = 0.5


@pytest.fixture(scope="module")
def detector() -> Iterator[Any]:
    """MediaPipe's short-range face detector."""
    detection = mediapipe.solutions.face_detection
    with detection.FaceDetection(model_selection=0, min_detection_confidence=0.1) as found:
        yield found


@pytest.mark.parametrize("person", sorted(people()))
def test_a_face_is_found_in_every_unit_from_every_side(
    person: str, detector: Any, tmp_path: Path
) -> None:
    command = [sys.executable, "-m", "service", "sheet", "--rig", person, "-o", str(tmp_path)]
    done = subprocess.run(
        [*command, "--view", SIDES, "--size", "220"],
        cwd=Path(__file__).parents[2],
        capture_output=True,
        text=True,
        timeout=1800,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    pictures = sorted(tmp_path.glob("*.jpg"))
    assert len(pictures) >= 5 * 24
    scores = {picture.stem: score(detector, picture) for picture in pictures}
    missed = {name: found for name, found in scores.items() if found < LEAST_SCORE}
    assert missed == {}, f"{len(missed)} of {len(scores)}"


def score(detector: Any, picture: Path) -> float:
    """Return how sure the detector is of its best face, 0 for none."""
    with Image.open(picture) as image:
        found = detector.process(np.asarray(image.convert("RGB")))
    return max((one.score[0] for one in found.detections or ()), default=0.0)
