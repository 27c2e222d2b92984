"""The REST routes; each one is parse, call, answer."""

from __future__ import annotations

from fastapi import APIRouter

from . import (
    clips,
    emotions,
    expressions,
    facs,
    idle,
    insight,
    maps,
    people,
    rigs,
    schemas,
    sessions,
    system,
    textures,
    tickets,
)
from .answers import ERRORS

router = APIRouter(responses=ERRORS)
for module in (
    system,
    people,
    rigs,
    expressions,
    textures,
    maps,
    emotions,
    sessions,
    idle,
    tickets,
    facs,
    insight,
    clips,
    schemas,
):
    router.include_router(module.router)

__all__ = ["router"]
