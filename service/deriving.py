"""Derived rigs: what a client sent, whatever its shape, applied to the rig that it changes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import reduce
from typing import Any

import structlog

from engine import EngineError, Rig, builtin_rig, plain_changes

from .errors import Unprocessable, refused_by_engine

_LOG = structlog.get_logger("rigs")
_UNIT_FIELDS = {"muscles", "jaw", "pose", "title", "region"}
_CHANGES = ("recipe", "tissue", "muscles", "action_units", "emotions", "name")

Steps = Sequence[Mapping[str, Any]]
"""Changes, one after another, that lead from a rig that has a name to another."""


def made_from(root: str, steps: Steps) -> Rig:
    """Make a rig from the name of the one that it comes from and what was changed.

    Raises:
        Unprocessable: If a change cannot be applied.
    """
    return derived_by_steps(builtin_rig(root), steps)


def derived_by_steps(base: Rig, steps: Steps) -> Rig:
    """Derive a rig step by step.

    Raises:
        Unprocessable: If a change cannot be applied.
    """
    return reduce(derived, steps, base)


def derived(base: Rig, changes: Mapping[str, Any]) -> Rig:
    """Derive a rig.

    Raises:
        Unprocessable: If a name is unknown or a value cannot be used.
    """
    given = {key: changes.get(key) for key in _CHANGES}
    if isinstance(given["action_units"], Mapping):
        given["action_units"] = {n: _unit(spec) for n, spec in given["action_units"].items()}
    try:
        return base.derive(**given)
    except EngineError as error:
        raise refused_by_engine(error) from error
    except (TypeError, ValueError, KeyError, AttributeError, ArithmeticError, IndexError) as error:
        _LOG.warning("a rig could not be derived", error=repr(error))
        raise Unprocessable(
            "invalid_value", f"these changes cannot be applied to rig {base.id}: {error}"
        ) from error


def in_plain_changes(base: Rig, changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return changes with conditions (`tissue_age`, `palsy`, `relaxed`) as what they come to.

    Raises:
        Unprocessable: If there is no such condition, or it cannot be had.
    """
    try:
        return plain_changes(base, changes)
    except EngineError as error:
        raise refused_by_engine(error) from error


def _unit(spec: Any) -> Any:
    """Return an action unit as the engine reads it; weights by muscle alone are one too."""
    flat = isinstance(spec, Mapping) and spec and not _UNIT_FIELDS & set(spec)
    return {"muscles": spec} if flat else spec
