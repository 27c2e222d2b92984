"""JSON Schemas of what the service reads, for editors and for programs that write it."""

from __future__ import annotations

from typing import Any

from .bodies import NewClip

_DRAFT = "https://json-schema.org/draft/2020-12/schema"


def timeline_schema() -> dict[str, Any]:
    """Return the schema of a timeline, the body of `POST /api/clips` and the file of `clip`."""
    schema = NewClip.model_json_schema()
    said = "What a face does, and how its clip is made: keyframes in order of time."
    return {"$schema": _DRAFT, **schema, "title": "Risorius timeline", "description": said}
