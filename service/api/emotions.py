"""The words that name faces: vocabularies, their labels, and the recipes that play them."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Query

from engine import UnknownName

from ..emotion_words import described_recipes, described_vocabularies
from ..errors import refused_by_engine

router = APIRouter(prefix="/api/emotions", tags=["sessions"])


@router.get("")
async def list_emotions(
    vocabulary: Annotated[
        str | None, Query(max_length=64, description="The labels of this vocabulary alone.")
    ] = None,
) -> dict[str, Any]:
    """List the vocabularies with what each label plays, and every recipe with its variants."""
    try:
        vocabularies = described_vocabularies(vocabulary)
    except UnknownName as error:
        raise refused_by_engine(error) from error
    return {"vocabularies": vocabularies, "recipes": described_recipes()}
