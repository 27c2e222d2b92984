"""The people who come with the service: recipes with names."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter

from engine import people, recipe_attributes

router = APIRouter(prefix="/api/people", tags=["rigs"])


@router.get("")
async def list_people() -> dict[str, Any]:
    """List the people, each name a rig's name, and what any recipe may ask for."""
    return {
        "people": [
            {"name": person.name, "title": person.title, "recipe": person.recipe.to_json()}
            for person in people().values()
        ],
        "attributes": recipe_attributes(),
    }
