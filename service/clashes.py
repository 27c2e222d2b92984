"""What a command says twice, or in vain: named to whoever sent it, never dropped in silence."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from engine import Keyframe, Rig, parse_facs, unit_key

from .bodies import Controls


def clashes(controls: Controls, keyframe: Keyframe, rig: Rig) -> list[str]:
    """Return a sentence about each thing that `controls` say in more than one way.

    Args:
        controls: What a client sent.
        keyframe: The command made of it, checked against the rig.
        rig: Whose units they are.
    """
    return [*_repeated(controls, rig), *_sides(keyframe, rig), *_overruled(keyframe, rig)]


def _repeated(controls: Controls, rig: Rig) -> Iterator[str]:
    """A unit named again: the last one of a FACS string counts, and numbers before strings."""
    seen: dict[str, str] = {}
    terms = parse_facs(controls.facs) if controls.facs is not None else ()
    named = [("facs", term.key) for term in terms]
    named += [("action_units", key) for key in controls.action_units or ()]
    for place, key in named:
        unit, side = rig.resolve_unit(key)
        name = unit_key(unit.name, side)
        if name in seen:
            where = f"twice in {place}" if seen[name] == place else "in facs and in action_units"
            yield f"{name} is named {where}; the latter counts"
        seen[name] = place


def _sides(keyframe: Keyframe, rig: Rig) -> Iterator[str]:
    """A unit named for both sides and for one: the one side counts there."""
    resolved = [rig.resolve_unit(key) for key in keyframe.action_units]
    both = {unit.name for unit, side in resolved if not side}
    for unit, side in resolved:
        if side and unit.name in both:
            one = unit_key(unit.name, side)
            yield f"{unit.name} and {one} are both named; {one} counts on its side"


def _overruled(keyframe: Keyframe, rig: Rig) -> Iterator[str]:
    """A unit part of which is also commanded by itself: what is named itself counts."""
    own = {name: name.partition(".")[0] for name, value in keyframe.muscles.items() if value}
    for key, intensity in keyframe.action_units.items():
        unit, side = rig.resolve_unit(key)
        if intensity == 0.0:
            continue
        for muscle, stem in own.items():
            if _moves(unit.muscles, muscle, stem, side):
                yield f"{muscle} is named itself, so {key} does not move it"
        for place in unit.pose:
            group, axis = place.split(".")
            if axis in getattr(keyframe, group):
                yield f"{place} is named itself, so {key} does not move it"


def _moves(weights: Mapping[str, float], muscle: str, stem: str, side: str) -> bool:
    other_side = bool(side) and "." in muscle and not muscle.endswith(f".{side}")
    return not other_side and weights.get(muscle, weights.get(stem, 0.0)) != 0.0
