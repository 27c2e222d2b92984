"""Every code that FACS has, whether a rig moves it or not."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources


@dataclass(frozen=True)
class Code:
    """One code of FACS.

    Attributes:
        name: "AU12"; "M59" for a movement of head or eyes.
        title: What it is called.
        kind: "action", "descriptor", "head", "eyes", "visibility" or "behaviour".
        sides: What FACS scores by itself: "L" and "R" of the face, "T" and "B" of the lips.
        nearest: Codes that come nearest, for a face that does not have it.
    """

    name: str
    title: str
    kind: str
    sides: str = ""
    nearest: tuple[str, ...] = ()


@cache
def facs_codes() -> Mapping[str, Code]:
    """Return the codes by name, in FACS order."""
    text = resources.files("engine").joinpath("data", "facs_codes.json").read_text("utf-8")
    entries = json.loads(text)["codes"]
    codes = [Code(**{**entry, "nearest": tuple(entry.get("nearest", ()))}) for entry in entries]
    return {code.name: code for code in codes}
