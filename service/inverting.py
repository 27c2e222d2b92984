"""The inverse of a file of targets, for the command line."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from engine import EngineError, builtin_rig

from .explaining import explain
from .insight import inverse_of
from .insight_bodies import InverseRequest
from .tables import markdown_table


class InverseRefused(Exception):
    """Targets that cannot be searched for; the message is one sentence."""


def invert_file(source: Path, rig: str, show: Callable[[float], None]) -> dict[str, Any]:
    """Return the answer to a file of targets as plain data.

    Args:
        source: JSON as `POST /api/rigs/{rig}/inverse` takes it.
        rig: Name of a built-in rig or a person.
        show: Told the share of the work done.

    Raises:
        InverseRefused: If the file cannot be read, or its targets cannot be used.
    """
    try:
        data = json.loads(source.read_text(encoding="utf-8"))
        request = InverseRequest.model_validate(data)
        return inverse_of(builtin_rig(rig), request, progress=show).to_json()
    except OSError as error:
        raise InverseRefused(f"{source} cannot be read: {error.strerror}.") from error
    except ValidationError as error:
        message = explain(list(error.errors()), data)
        raise InverseRefused(f"{source} holds no targets: {message}.") from error
    except (ValueError, RecursionError) as error:
        raise InverseRefused(f"{source} is not a JSON file: {error}.") from error
    except EngineError as error:
        raise InverseRefused(f"The targets cannot be searched for: {error}.") from error


def inverse_markdown(data: dict[str, Any]) -> str:
    """Return an answer as Markdown tables."""
    kind = "action unit" if data["action_units"] else "muscle"
    found = data["action_units"] or data["activations"]
    moved = [(name, f"{value:.2f}") for name, value in found.items() if value >= 0.005]
    jaw = ", ".join(f"{axis} {value:.1f}" for axis, value in data["jaw"].items())
    rows = []
    for mark in data["landmarks"]:
        target = ", ".join("any" if v is None else f"{v:.1f}" for v in mark["target"])
        reached = ", ".join(f"{v:.1f}" for v in mark["reached"])
        rows.append((mark["name"], target, reached, f"{mark['residual_mm']:.2f}"))
    lines = [
        *markdown_table((kind, "activation"), moved),
        "",
        f"Jaw: {jaw}. {data['iterations']} iterations, rms {data['rms_mm']:.2f} mm.",
        "",
        *markdown_table(("landmark", "wanted, mm", "reached, mm", "left, mm"), rows),
    ]
    return "\n".join(lines)
