"""What a command says twice, or in vain, or against FACS: named to whoever sent it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from engine import FacsWarning, Keyframe, Rig, broken_rules, unit_key, whole_of

from .bodies import Controls, Units
from .facs import named_units, one_key, playable
from .shapes import shaped


def clashes(
    command: Units, keyframe: Keyframe, rig: Rig, held: Mapping[str, float] | None = None
) -> list[FacsWarning]:
    """Return a warning about each thing that `command` says in more than one way, or in vain.

    Args:
        command: What a client sent.
        keyframe: The command made of it, checked against the rig.
        rig: Whose units they are.
        held: What its layer holds with it, by key; without it, what the keyframe names.
    """
    named = keyframe
    of_shapes: tuple[FacsWarning, ...] = ()
    if isinstance(command, Controls) and (command.arkit or command.visemes):
        # Their tables name units and axes, not the client.
        named, of_shapes = _itself(command, keyframe, rig), shaped(command, rig).warnings
    return [
        *playable(command, rig).warnings,
        *of_shapes,
        *_repeated(command, rig),
        *_sides(named, rig),
        *_overruled(named, rig),
        *_against_facs(named, rig, held),
    ]


def _itself(controls: Controls, keyframe: Keyframe, rig: Rig) -> Keyframe:
    """Return a command without what the shapes in it come to."""
    posed = {group: getattr(controls, group) for group in ("jaw", "gaze", "tongue")}
    axes = {
        group: pose.model_dump(exclude_none=True) if pose else {} for group, pose in posed.items()
    }
    return replace(keyframe, action_units=playable(controls, rig).units, **axes)


def _repeated(command: Units, rig: Rig) -> Iterator[FacsWarning]:
    """A unit named again: the last one of a FACS string counts, and numbers before strings."""
    seen: dict[str, str] = {}
    for named in named_units(command, rig):
        key, place = named.key, named.place
        if key in seen:
            where = f"twice in {place}" if seen[key] == place else "in facs and in action_units"
            message = f"{key} is named {where}; the latter counts"
            yield FacsWarning("named_once", (key,), message)
        seen[key] = place


def _sides(keyframe: Keyframe, rig: Rig) -> Iterator[FacsWarning]:
    """A unit named for both sides or lips and for one: the one counts there."""
    resolved = [rig.resolve_unit(key) for key in keyframe.action_units]
    both = {unit.name for unit, side in resolved if not side}
    for unit, side in resolved:
        whole = whole_of(unit.name)
        if whole in both and unit.name not in rig.action_units:
            message = f"{whole} and {unit.name} are both named; {unit.name} counts on its lip"
            yield FacsWarning("side_over_both", (whole, unit.name), message)
        if side and unit.name in both:
            one = unit_key(unit.name, side)
            message = f"{unit.name} and {one} are both named; {one} counts on its side"
            yield FacsWarning("side_over_both", (unit.name, one), message)


def _overruled(keyframe: Keyframe, rig: Rig) -> Iterator[FacsWarning]:
    """A unit part of which is also commanded by itself: what is named itself counts."""
    own = {name: name.partition(".")[0] for name, value in keyframe.muscles.items() if value}
    for key, intensity in keyframe.action_units.items():
        unit, side = rig.resolve_unit(key)
        if intensity == 0.0:
            continue
        for muscle, stem in own.items():
            if _moves(unit.muscles, muscle, stem, side):
                message = f"{muscle} is named itself, so {key} does not move it"
                yield FacsWarning("named_itself", (key,), message)
        for place in unit.pose:
            group, axis = place.split(".")
            if axis in getattr(keyframe, group):
                message = f"{place} is named itself, so {key} does not move it"
                yield FacsWarning("named_itself", (key,), message)


def _against_facs(
    keyframe: Keyframe, rig: Rig, held: Mapping[str, float] | None
) -> Iterator[FacsWarning]:
    """A rule of FACS that this command breaks, by itself or with what its layer holds."""
    named = {one_key(key, rig) for key, value in keyframe.action_units.items() if value}
    here = keyframe.action_units if held is None else held
    for warning in broken_rules({one_key(key, rig): value for key, value in here.items()}):
        # A layer may hold L12 and R12 where AU12 was named, and the other way round.
        if _stems(named) & _stems(warning.units):
            yield warning


def _stems(keys: Iterable[str]) -> set[str]:
    return {key.removeprefix("AU").lstrip("LRTB") for key in keys}


def _moves(weights: Mapping[str, float], muscle: str, stem: str, side: str) -> bool:
    other_side = bool(side) and "." in muscle and not muscle.endswith(f".{side}")
    return not other_side and weights.get(muscle, weights.get(stem, 0.0)) != 0.0
