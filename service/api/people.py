"""The people who come with the service: recipes with names."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter

from engine import people

router = APIRouter(prefix="/api/people", tags=["rigs"])


@router.get("")
async def list_people() -> dict[str, Any]:
    """List the people: each name is a rig's name, each recipe one to start from."""
    return {
        "people": [
            {"name": person.name, "title": person.title, "recipe": person.recipe.to_json()}
            for person in people().values()
        ]
    }
