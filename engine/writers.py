"""Who holds what in the layers of a face, whose word counts, and until when.

In a layer each writer holds a set of its own. Of one thing that several hold, the one who came
last counts, and the others wait beneath. Whoever waits and writes again comes to the top, unless
the one above is still at it: so two who write at once never take it from each other by turns.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from .arrays import BoolArray, FloatArray
from .channels import GROUPS
from .errors import InvalidValue
from .held import EXPRESSION, Held, Thing, hold_units, recipe_of, sides_of, unit_key, units_of
from .onset import fade_lengths
from .rig import Rig
from .timeline import ANYONE, LAYERS, TICKS_PER_SECOND, Keyframe, ticks
from .touches import touched

MOST_WRITERS = 64
"""Writers that a layer has at once, at most."""
AT_IT = 30
"""Ticks for which a writer is at it after a write: half a second."""


@dataclass(frozen=True)
class Expired:
    """A writer whose time was up: its layer, when that was, and over how many ticks it lets go."""

    layer: str
    tick: int
    fade_out: int


@dataclass(frozen=True)
class Heard:
    """What counts of one thing in a layer.

    Attributes:
        owner: Whose word it is.
        place: Where it stands among the layer's writers.
        value: What it comes to, over what others ask beneath.
        share: How much of the lower layers it overrides, 0..1.
    """

    owner: str
    place: int
    value: float
    share: float


class Writers:
    """The writers of every layer of one face, and what each holds."""

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        self._held: dict[str, dict[str, Held]] = {layer: {} for layer in LAYERS}
        self._count = 0
        # The first tick at which a writer's time is up: asked for several times a tick.
        self._alarm: int | None = None

    def take(self, keyframe: Keyframe, tick: int) -> FloatArray:
        """Take a command at `tick`; return the ticks that each channel takes for it, (channels,).

        A command that replaces lets go of what its owner held, and without an owner of all.

        Raises:
            InvalidValue: If the layer has as many writers as it may.
        """
        layer, before = self._held[keyframe.layer], self._units_for(keyframe)
        if keyframe.owner not in layer and len(layer) >= MOST_WRITERS:
            raise InvalidValue(
                f"layer {keyframe.layer!r} has {MOST_WRITERS} writers, the most there may be; "
                f"{keyframe.owner!r} can write once one of them lets go"
            )
        held = layer.setdefault(keyframe.owner, Held(since=tick))
        if keyframe.replace:
            for each in layer.values() if keyframe.owner == ANYONE else (held,):
                each.clear()
        self._place(layer, held, held.take(keyframe, self.rig), tick)
        self._held[keyframe.layer] = {o: each for o, each in layer.items() if not each.empty}
        lengths = fade_lengths(self.rig, before, self._units_for(keyframe), keyframe)
        ends = [] if keyframe.ttl is None else [tick + max(1, ticks(keyframe.ttl))]
        if keyframe.hold is not None:
            ends.append(tick + int(lengths.max()) + ticks(keyframe.hold))
        held.expires = min(ends, default=None)
        self._alarm = self._first_end()
        return lengths

    def expire(self, tick: int) -> Iterator[Expired]:
        """Let go of every writer whose time is up, one after another, the first to end first."""
        if self._alarm is None or tick < self._alarm:
            return
        due = sorted(
            (held.expires, layer, owner)
            for layer, owners in self._held.items()
            for owner, held in owners.items()
            if held.expires is not None and tick >= held.expires
        )
        for end, layer, owner in due:
            fade_out = self._held[layer].pop(owner).fade_out
            self._alarm = self._first_end()
            yield Expired(layer, end, fade_out)

    def alarm(self) -> int | None:
        """Return the tick at which the first writer's time is up, None where all stay."""
        return self._alarm

    def _first_end(self) -> int | None:
        ends = (held.expires for owners in self._held.values() for held in owners.values())
        return min((end for end in ends if end is not None), default=None)

    def units(self, layer: str) -> dict[str, float]:
        """Return the action units that count in a layer."""
        return dict(self._whole(layer).action_units)

    def _units_for(self, keyframe: Keyframe) -> dict[str, float]:
        """Return the units that tell how long a command takes: none, if it says so itself."""
        return self.units(keyframe.layer) if keyframe.fade is None else {}

    def vector(self, layer: str) -> tuple[FloatArray, FloatArray, BoolArray, BoolArray]:
        """Return what a layer asks of each channel, its share of it, whether it asks, or only adds.

        All of shape (channels,). What several writers move goes by the weight of the last of them.
        """
        whole = self._whole(layer)
        target, claimed = channels_of(self.rig, whole)
        shares = np.where(claimed, whole.weight, 0.0)
        heard = self._heard(layer)
        groups: dict[tuple[int, float], set[Thing]] = {}
        for thing, each in heard.items():
            groups.setdefault((self._held[layer][each.owner].newest, each.share), set()).add(thing)
        alone = len(self._held[layer]) < 2
        for (_, share), own in () if alone else sorted(groups.items()):
            _, moved = channels_of(self.rig, whole.only(own, self.rig))
            shares[moved & claimed] = share
        return target, shares, claimed, touched(self.rig, whole)

    def on(self, rig: Rig) -> Writers:
        """Return the same writers, with the same holds, on `rig`."""
        twin = Writers(rig)
        twin._held, twin._count = copy.deepcopy(self._held), self._count
        twin._alarm = self._alarm
        return twin

    def beneath(self, keyframe: Keyframe) -> dict[str, list[str]]:
        """Return the other writers under whom things of a command wait, and what waits."""
        heard = self._heard(keyframe.layer)
        held = self._held[keyframe.layer].get(keyframe.owner)
        waiting: dict[str, list[str]] = {}
        for thing in sorted(Held().take(keyframe, self.rig)) if held is not None else ():
            owner = heard[thing].owner if thing in heard else self._cover(keyframe.layer)[1]
            if owner != keyframe.owner and held is not None and thing in held.places:
                waiting.setdefault(owner, []).append(_shown(thing))
        return {owner: list(dict.fromkeys(names)) for owner, names in waiting.items()}

    def clear(self) -> None:
        """Let go of everything."""
        self._held, self._alarm = {layer: {} for layer in LAYERS}, None

    def keyframes(self, tick: int) -> list[Keyframe]:
        """Return commands that make a face at rest hold what is held at `tick`, in their order."""
        commands: list[tuple[int, Keyframe]] = []
        for layer, owners in self._held.items():
            for owner, held in owners.items():
                if held.expires is None or held.expires > tick:
                    commands += self._retold(layer, owner, held, tick)
        return [keyframe for _, keyframe in sorted(commands, key=lambda each: each[0])]

    def report(self, tick: int) -> dict[str, object]:
        """Return what each layer that is held comes to, and its writers, as plain data."""
        return {
            layer: {**_plain(self._whole(layer)), "writers": self._writers(layer, tick)}
            for layer, owners in self._held.items()
            if any(held.told for held in owners.values())
        }

    def weighed_units(self) -> Iterator[tuple[tuple[str, str], float, float]]:
        """Yield each unit and side that counts in a layer, its value and share, lowest first."""
        for layer in LAYERS:
            for key, (value, share) in self.shared_units(layer).items():
                for _, name, side in sides_of(self.rig, [key]):
                    yield (name, side), value, share

    def shared_units(self, layer: str) -> dict[str, tuple[float, float]]:
        """Return the action units that count in a layer, each with its value and share."""
        whole, heard = self._whole(layer), self._heard(layer)
        units = {}
        for key, value in whole.action_units.items():
            sides = [heard[side].share for side in sides_of(self.rig, [key]) if side in heard]
            units[key] = value, max(sides, default=whole.weight)
        return units

    def _place(self, layer: Mapping[str, Held], held: Held, named: set[Thing], tick: int) -> None:
        """Put what a writer has just named where it belongs among the layer's writers."""
        self._count += 1
        fresh = EXPRESSION in named and self._comes_up(layer, held, EXPRESSION, tick)
        for thing in named:
            by_emotion = EXPRESSION in named and thing != EXPRESSION
            if fresh if by_emotion else self._comes_up(layer, held, thing, tick):
                held.places[thing] = self._count
            elif by_emotion:
                held.places[thing] = held.places[EXPRESSION]
            held.written[thing] = tick
        if EXPRESSION in named:
            held.places = {t: at for t, at in held.places.items() if t in named or t[0] != "unit"}
        # Lips that part or rejoin are held under names that the command did not say.
        place = max((held.places[thing] for thing in named), default=self._count)
        for thing in held.things(self.rig):
            held.places.setdefault(thing, place)
            held.written.setdefault(thing, tick)
        # What is held as one has one place.
        for key in held.action_units:
            sides = sides_of(self.rig, [key])
            held.places.update(dict.fromkeys(sides, max(held.places[side] for side in sides)))
        for each in layer.values():
            here = each.things(self.rig)
            each.places = {thing: each.places[thing] for thing in each.places if thing in here}
            each.written = {thing: each.written[thing] for thing in each.places}

    def _comes_up(self, layer: Mapping[str, Held], held: Held, thing: Thing, tick: int) -> bool:
        """Return whether a write of `thing` brings its writer to the top of it.

        It does for whoever did not hold it, and over others who are not at it any more. Over units
        there are emotions too, and over an emotion units.
        """
        mine = held.places.get(thing)
        if mine is None:
            return True
        above = [
            other.written[each]
            for other in layer.values()
            for each, place in other.places.items()
            if other is not held and place > mine and _contend(thing, each)
        ]
        return bool(above) and tick - max(above) >= AT_IT

    def _cover(self, layer: str) -> tuple[int, str]:
        """Return the place and owner of the emotion that came last: it covers units below it."""
        places = [(held.places.get(EXPRESSION, 0), o) for o, held in self._held[layer].items()]
        return max(places, default=(0, ANYONE))

    def _heard(self, layer: str) -> dict[Thing, Heard]:
        """Return what counts of each thing that is held in a layer: the last, over those before."""
        cover, _ = self._cover(layer)
        stack = sorted(
            (place, owner, thing)
            for owner, held in self._held[layer].items()
            for thing, place in held.places.items()
            if place >= cover or thing[0] not in ("unit", "expression")
        )
        values = {o: held.things(self.rig) for o, held in self._held[layer].items()}
        heard: dict[Thing, Heard] = {}
        for place, owner, thing in stack:
            weight, value = self._held[layer][owner].weight, values[owner][thing]
            below = heard.get(thing)
            if below is not None and weight < 1.0:
                share = weight + below.share * (1.0 - weight)
                if share > 0.0:
                    value += (below.value - value) * below.share * (1.0 - weight) / share
                weight = share
            heard[thing] = Heard(owner, place, value, weight)
        return heard

    def _rising(self, layer: str) -> list[tuple[str, Held]]:
        """Return a layer's writers, the one who came to the top last at the end."""
        return sorted(self._held[layer].items(), key=lambda each: each[1].newest)

    def _whole(self, layer: str) -> Held:
        """Return what counts in a layer, of all its writers."""
        owners = self._rising(layer)
        if len(owners) < 2:
            return owners[0][1] if owners else Held()
        whole, heard = Held(weight=owners[-1][1].weight), self._heard(layer)
        for thing, each in heard.items():
            kind, name, axis = thing
            if kind == "muscle":
                whole.muscles[name] = each.value
            elif kind == "axis":
                whole.axes[name, axis] = each.value
            elif kind == "expression":
                whole.expression = True
                felt = self._held[layer][each.owner]
                whole.emotion, whole.plays = felt.emotion, felt.plays
        # In the order in which they came up: a lip of one writer parts a unit of another.
        sides: dict[int, dict[tuple[str, str], float]] = {}
        for thing, each in heard.items():
            if thing[0] == "unit":
                sides.setdefault(each.place, {})[thing[1:]] = each.value
        for _, named in sorted(sides.items()):
            hold_units(self.rig, whole.action_units, units_of(named))
        return whole

    def _retold(
        self, layer: str, owner: str, held: Held, tick: int
    ) -> Iterator[tuple[int, Keyframe]]:
        """Yield commands that hold what a writer holds, each with its place among all."""
        left = None if held.expires is None else (held.expires - tick) / TICKS_PER_SECOND
        for place in sorted(set(held.places.values())):
            part = held.only({t for t, at in held.places.items() if at == place}, self.rig)
            units = dict(part.action_units)
            if part.expression:
                units = {**self._not_yet(part), **units}
            yield (
                place,
                Keyframe(
                    layer=layer,
                    owner=owner,
                    action_units=units,
                    muscles=part.muscles,
                    jaw=part.axes_of("jaw"),
                    gaze=part.axes_of("gaze"),
                    head=part.axes_of("head"),
                    tongue=part.axes_of("tongue"),
                    emotion=part.emotion,
                    expression=part.expression,
                    plays=part.plays,
                    hold=left,
                    fade_out=held.fade_out / TICKS_PER_SECOND,
                    weight=held.weight,
                ),
            )

    def _not_yet(self, part: Held) -> dict[str, float]:
        """Return a 0 for each side of an emotion's units that is not held with it."""
        recipe, there = recipe_of(part.emotion, self.rig), part.things(self.rig)
        sides = sides_of(self.rig, recipe)
        return {unit_key(side[1], side[2]): 0.0 for side in sides if side not in there}

    def _writers(self, layer: str, tick: int) -> list[dict[str, object]]:
        return [
            {
                "owner": owner,
                **_plain(held),
                "since": held.since,
                "expires_in": None
                if held.expires is None
                else (held.expires - tick) / TICKS_PER_SECOND,
            }
            for owner, held in self._rising(layer)
        ]


def channels_of(rig: Rig, held: Held) -> tuple[FloatArray, BoolArray]:
    """Return what is asked of each channel, and whether it is, shape (channels,)."""
    channels = rig.channels
    target = rig.contraction(held.action_units)
    claimed = target != 0.0
    for name, value in held.muscles.items():
        index = channels.muscle_names.index(name)
        target[index], claimed[index] = value, True
    for (group, axis), value in held.axes.items():
        index = channels.index(group, axis)
        target[index], claimed[index] = value, True
    return target, claimed


def _plain(held: Held) -> dict[str, object]:
    """Return what is held as plain data."""
    report: dict[str, object] = {
        "action_units": dict(held.action_units),
        "muscles": dict(held.muscles),
        "weight": held.weight,
    }
    for group in GROUPS:
        if axes := held.axes_of(group):
            report[group] = axes
    if held.plays:
        report["emotion"] = dict(held.plays)
    elif held.emotion is not None:
        report["emotion"] = {"label": held.emotion[0], "intensity": held.emotion[1]}
    return report


def _contend(thing: Thing, other: Thing) -> bool:
    """Return whether a writer above at `other` stands over who writes `thing`."""
    if thing == EXPRESSION:
        return other[0] in ("unit", "expression")
    return other == thing or (thing[0] == "unit" and other == EXPRESSION)


def _shown(thing: Thing) -> str:
    """Return a thing as commands name it."""
    kind, name, axis = thing
    if kind == "axis":
        return f"{name}.{axis}"
    return unit_key(name, "") if kind == "unit" else name or kind
