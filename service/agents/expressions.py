"""The tool that lists what faces can show."""

from __future__ import annotations

from engine import NEUTRAL, Rig, UnknownName, lexicon, people

from ..components import Components
from ..emotion_words import described_vocabularies
from ..errors import refused_by_engine
from .answered import EmotionLine, Expressions, PersonLine, UnitLine
from .asked import ListExpressions
from .caller import Caller


async def list_expressions(
    asked: ListExpressions, parts: Components, _caller: Caller
) -> Expressions:
    """List emotions, action units and people, those that are asked for."""
    rig = await parts.rigs.get("standard")
    return Expressions(
        emotions=_emotions(asked.vocabulary) if "emotions" in asked.parts else [],
        action_units=_units(rig) if "action_units" in asked.parts else [],
        people=_people() if "people" in asked.parts else [],
    )


def _emotions(vocabulary: str | None) -> list[EmotionLine]:
    if vocabulary is None:
        return [
            EmotionLine(
                label=recipe.name,
                facs=recipe.variants[0].facs or NEUTRAL,
                also=list(recipe.synonyms),
                source=recipe.variants[0].source,
            )
            for recipe in lexicon().recipes.values()
        ]
    try:
        (only,) = described_vocabularies(vocabulary)
    except UnknownName as error:
        raise refused_by_engine(error) from error
    return [
        EmotionLine(label=row["label"], facs=row["recipe"], source=row["source"])
        for row in only["labels"]
    ]


def _units(rig: Rig) -> list[UnitLine]:
    return [
        UnitLine(unit=unit.name, title=unit.title, shows=unit.description)
        for unit in rig.action_units.values()
    ]


def _people() -> list[PersonLine]:
    first = PersonLine(rig="standard", title="the built-in head")
    return [first, *(PersonLine(rig=each.name, title=each.title) for each in people().values())]
