"""A rig: one head with its tissue, muscles, action units and emotions, named by its content."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from .arrays import FloatArray
from .cache import content_key
from .channels import GROUPS, LIMITS, MIRRORED, Channels
from .combination import SIDES, Combination, together
from .emotion import Emotion, find_emotion
from .errors import EngineError, InvalidValue, UnknownName
from .facs import (
    LIPS,
    ActionUnit,
    FacsWarning,
    lip_part,
    parse_facs,
    print_facs,
    split_side,
)
from .force_basis import jaw_rides, whole_pull
from .head import (
    LEVELS,
    STANDARD,
    Head,
    Recipe,
    muscle_strength,
    paper_head,
    people,
    person_head,
    reference_head,
    tissue_of_life,
)
from .head.storage import source_key
from .jaw import JawHinge
from .muscle import AirPressure, LidMuscle, LinearMuscle, Muscle, SphincterMuscle, mirrored
from .rig_data import (
    load_action_units,
    load_combinations,
    load_emotions,
    load_muscles,
    load_reaches,
)
from .timeline import LAYERS, Keyframe, check_owner
from .tissue import PAPER_PARAMETERS, TissueParameters, check_fields

BUILTIN_RIGS = ("standard", "paper")
MAX_ACTIVATION = 1.5
"""Greatest activation of a muscle, after sums: beyond it the springs leave their measured range."""
PAPER_FORCE_SHARE = 0.42
"""Force scales of the `paper` rig against the standard's: its tissue has no pre-tension to move."""
PAPER_FORCE_SHARES: Mapping[str, float] = {
    "frontalis_lateral": 0.53,
    "levator_labii_alaeque_nasi": 0.56,
    "levator_labii_superioris": 0.36,
    "zygomatic_major": 0.50,
    "depressor_anguli_oris": 0.64,
    "depressor_labii_inferioris": 0.26,
    "mentalis": 0.54,
    "orbicularis_oris": 0.44,
}
"""The same where 0.42 leaves a landmark of Table 1 outside its human range; by muscle, no side."""
FORCE_SHARES = (0.5, 2.4)
"""Least and greatest force of a muscle against the head it was fitted on."""
MOST_OF_A_MUSCLE = 1.0e4
"""Greatest number that an edit of a muscle may set, either way."""
EDITABLE = (
    "attachment",
    "insertion",
    "center",
    "plane",
    "normal",
    "radius",
    "angle",
    "strength",
    "force_scale",
    "semi_major",
    "semi_minor",
    "hoop",
    "bulge",
    "extent",
    "upper",
    "lower",
    "gain",
)


@dataclass(frozen=True)
class Model:
    """Which of the declared forms of the physics a face runs.

    Attributes:
        integrator: "rk2" (midpoint, the paper's), "heun", "symplectic_euler", "rk4" or "verlet",
            which moves sixteen faces at once: `engine.lanes`.
        forces: "rest" (weights from the rest pose) or "current" (from the moving skin).
        springs: "continuous" or "literal" (Eq. 20 as printed).
        sphincter: "ring" or "literal" (Eq. 11 as printed).
    """

    integrator: str = "rk2"
    forces: str = "rest"
    springs: str = "continuous"
    sphincter: str = "ring"

    def __post_init__(self) -> None:
        for f in fields(self):
            value = getattr(self, f.name)
            if value not in MODEL_CHOICES[f.name]:
                raise UnknownName(f"model {f.name}", str(value), MODEL_CHOICES[f.name])

    @property
    def runs_together(self) -> bool:
        """Whether the kernel for many faces at once has these springs and forces."""
        return self.forces == "rest" and self.springs == "continuous"

    @property
    def live(self) -> Model:
        """These forms as live faces run them, where the kernel for many faces has them.

        It draws what the paper's integrator does (`tests/engine/test_accuracy.py`), in a twentieth
        of the time. The paper's own springs and forces keep the paper's integrator.
        """
        return replace(self, integrator="verlet") if self.runs_together else self

    @classmethod
    def for_rig(cls, rig: Rig, **choices: str) -> Model:
        """Return the rig's own model with `choices` in place.

        Raises:
            UnknownName: For a form that does not exist.
        """
        return replace(rig.model, **choices)


MODEL_CHOICES: Mapping[str, tuple[str, ...]] = {
    "integrator": ("rk2", "heun", "symplectic_euler", "rk4", "verlet"),
    "forces": ("rest", "current"),
    "springs": ("continuous", "literal"),
    "sphincter": ("ring", "literal"),
}
PAPER_MODEL = Model(forces="current", springs="literal", sphincter="literal")


@dataclass(frozen=True, eq=False)
class Rig:
    """Everything that makes one face move.

    Attributes:
        name: "standard", "paper", or what it was derived as.
        head: Surface, skin, parts.
        parameters: Constants of its tissue.
        muscles: In channel order.
        action_units: By name.
        emotions: By name.
        combinations: Rules of units that act together.
        jaw: Its hinge.
        model: The forms of the physics it runs unless a session says otherwise.
        recipe: What the person looks like; None for the paper's mask and heads from files.
        level: Detail of its drawn skin, where it has a recipe.
    """

    name: str
    head: Head
    parameters: TissueParameters
    muscles: tuple[Muscle, ...]
    action_units: Mapping[str, ActionUnit]
    emotions: Mapping[str, Emotion]
    combinations: tuple[Combination, ...] = ()
    jaw: JawHinge = field(default_factory=JawHinge)
    model: Model = field(default_factory=Model)
    recipe: Recipe | None = None
    level: str = "high"

    @cached_property
    def id(self) -> str:
        """Hash of the rig's content: the same face has the same id everywhere, at every level."""
        head = self.head
        # A recipe says what is drawn, at whatever level; the tissue is the same at all of them.
        drawn = (head.drawn.vertices, head.drawn.colors) if self.recipe is None else ()
        return content_key(
            source_key(),
            head.points,
            head.polygons,
            head.depth,
            head.anchor_weight,
            head.jaw_weight,
            *drawn,
            self.parameters,
            self.muscles,
            sorted(self.action_units.items()),
            sorted(self.emotions.items()),
            self.combinations,
            self.jaw,
            self.model,
            self.recipe,
        )[:16]

    @cached_property
    def channels(self) -> Channels:
        """Order of the numbers a command sets."""
        return Channels(tuple(muscle.name for muscle in self.muscles))

    @property
    def muscle_names(self) -> tuple[str, ...]:
        """Names of the muscles, in channel order."""
        return self.channels.muscle_names

    def muscle(self, name: str) -> Muscle:
        """Return a muscle by its full name.

        Raises:
            UnknownName: If there is none.
        """
        for muscle in self.muscles:
            if muscle.name == name:
                return muscle
        raise UnknownName("muscle", name, self.muscle_names)

    def resolve_emotion(self, label: str) -> Emotion:
        """Return the emotion that `label` names.

        Raises:
            UnknownName: With the nearest known labels.
        """
        return find_emotion(self.emotions, label)

    def resolve_unit(self, key: str) -> tuple[ActionUnit, str]:
        """Return the unit and side ("", "L", "R") that "AU12", "L12" or "12" names.

        One lip, "T28", is a unit of its own and has no side.

        Raises:
            UnknownName: If the rig has no such unit.
        """
        if key in self.action_units:
            return self.action_units[key], ""
        try:
            name, side = split_side(key)
        except EngineError:
            name, side = key, ""
        unit = self.action_units.get(name)
        if unit is not None and side in LIPS:
            unit, side = lip_part(unit, side), ""
        if unit is None:
            raise UnknownName("action unit", key, self.action_units)
        return unit, side

    def contraction(self, units: Mapping[str, float]) -> FloatArray:
        """Return the channel vector of action units at intensities, held to its limits.

        Units add up, but for what the rig's combinations say of those that act together.

        Args:
            units: Intensity 0..1 by "AU12", "L12", "R12" or "T28"; a side counts before both, and
                one lip adds to a whole: `hold_units` says which of them counts.

        Raises:
            UnknownName: For a unit the rig does not have.
        """
        levels: dict[str, dict[str, float]] = {side: {} for side in SIDES}
        resolved = [(*self.resolve_unit(key), units[key]) for key in sorted(units)]
        for unit, side, intensity in sorted(resolved, key=lambda entry: entry[1] != ""):
            for each in self._sides_of(unit, side):
                levels[each][unit.name] = intensity
        total = np.zeros(self.channels.count)
        for side in SIDES:
            total += self._side_vector(levels[side], side)
        return np.asarray(np.clip(total, *self._limits))

    def check(self, keyframe: Keyframe) -> list[str]:
        """Return warnings about a command that can be played.

        Raises:
            UnknownName: For a unit, muscle, layer, emotion or axis that is not there.
            InvalidValue: For a number outside its range.
        """
        if keyframe.layer not in LAYERS:
            raise UnknownName("layer", keyframe.layer, LAYERS)
        check_owner(keyframe.owner)
        warnings = [str(warning) for warning in self.unit_warnings(keyframe.action_units)]
        for key, value in keyframe.action_units.items():
            _check_range(key, value, 0.0, 1.0)
        for name, value in keyframe.muscles.items():
            least = least_activation(self.muscle(name))
            _check_range(name, value, least, MAX_ACTIVATION)
        for group, axes in GROUPS.items():
            for axis, value in getattr(keyframe, group).items():
                if axis not in axes:
                    raise UnknownName(f"{group} axis", axis, axes)
                _check_range(f"{group}.{axis}", value, *LIMITS[group, axis])
        if keyframe.emotion is not None:
            self.resolve_emotion(keyframe.emotion[0])
            _check_range("intensity", keyframe.emotion[1], 0.0, 1.0)
        _check_range("weight", keyframe.weight, 0.0, 1.0)
        for name in ("fade", "fade_out", "hold", "ttl"):
            value = getattr(keyframe, name)
            if value is not None:
                _check_range(name, value, 0.0, 3600.0)
        return warnings

    def unit_warnings(self, units: Mapping[str, float]) -> list[FacsWarning]:
        """Return what to know of units at intensities by "AU12", "L12" or "R12" on this rig.

        Raises:
            UnknownName: For a unit the rig does not have.
        """
        warnings = []
        for key, value in units.items():
            unit, side = self.resolve_unit(key)
            if unit.still:
                message = f"{key} moves nothing on this rig"
                warnings.append(FacsWarning("still", (key,), message))
            elif unit.one_sided and not side and value:
                message = f"{key} is one-sided in FACS; without L or R it is the left one"
                warnings.append(FacsWarning("one_sided", (key,), message))
        return warnings

    def at_level(self, level: str) -> Rig:
        """Return this rig with its skin drawn at a level of detail: "low", "medium" or "high".

        It is the same face and keeps its id. A rig without a recipe has one level only.

        Raises:
            UnknownName: There is no such level.
        """
        if level not in LEVELS:
            raise UnknownName("level of detail", level, LEVELS)
        if self.recipe is None or level == self.level:
            return self
        return replace(self, head=person_head(self.recipe, level), level=level)

    def derive(
        self,
        *,
        recipe: Mapping[str, object] | None = None,
        tissue: Mapping[str, object] | None = None,
        muscles: Mapping[str, Mapping[str, object]] | None = None,
        action_units: Mapping[str, Mapping[str, object]] | None = None,
        emotions: Mapping[str, object] | None = None,
        name: str | None = None,
    ) -> Rig:
        """Return this rig with edits, at its level; the same edits give the same id at each.

        Args:
            recipe: What changes of the person, by attribute; earlier edits stay.
            tissue: Tissue parameters by name.
            muscles: By full muscle name, the fields to change.
            action_units: By name, `{"muscles": {"zygomatic_major": 1.0}, "jaw": 0, "title": …}`.
            emotions: By name, a FACS string, or `{"recipe": …, "scale": …, "synonyms": […]}`.
            name: Of the new rig.

        Raises:
            UnknownName: For anything named that is not there.
            InvalidValue: For a value outside its limits.
        """
        if recipe:
            return self._as_person(recipe).derive(
                tissue=tissue,
                muscles=muscles,
                action_units=action_units,
                emotions=emotions,
                name=name,
            )
        edited = tuple(
            _edited_muscle(muscle, (muscles or {}).get(muscle.name, {})) for muscle in self.muscles
        )
        for muscle_name in muscles or {}:
            self.muscle(muscle_name)
        units = dict(self.action_units)
        for unit_name, spec in (action_units or {}).items():
            units[unit_name] = self._custom_unit(unit_name, spec)
        parameters = self.parameters.edited(tissue or {})
        check_fields(self.head, parameters)
        rig = replace(
            self,
            name=name or self.name,
            parameters=parameters,
            muscles=edited,
            action_units=units,
        )
        labels = dict(self.emotions)
        for label, emotion_spec in (emotions or {}).items():
            labels[label.strip().lower()] = rig._custom_emotion(label, emotion_spec)
        return replace(rig, emotions=labels)

    def describe(self) -> dict[str, object]:
        """Return the rig as plain data: what clients build their panels from.

        Beside what is set of a muscle stand the least and greatest `activation`, and `jaw_share`:
        by how much of the jaw's turn its bone end rides, or all of a ring.
        """
        head = self.head
        rides = jaw_rides(head, self.muscles)[:, 0]
        return {
            "id": self.id,
            "name": self.name,
            "model": asdict(self.model),
            "recipe": self.recipe.to_json() if self.recipe else None,
            "muscles": [
                {
                    **asdict(muscle),
                    "activation": [min(0.0, max(-1.0, least_activation(muscle))), 1.0],
                    "jaw_share": round(float(share), 4),
                }
                for muscle, share in zip(self.muscles, rides, strict=True)
            ],
            "action_units": [
                {**asdict(unit), "jaw": unit.jaw, "range": [0.0, 1.0]}
                for unit in self.action_units.values()
            ],
            "combinations": [asdict(rule) for rule in self.combinations],
            "emotions": [asdict(emotion) for emotion in self.emotions.values()],
            "tissue": self.parameters.to_json(),
            **{
                group: {axis: list(LIMITS[group, axis]) for axis in axes}
                for group, axes in GROUPS.items()
            },
            "layers": list(LAYERS),
            "mesh": {
                "surface_vertices": len(head.points),
                "tissue_nodes": 3 * head.sheet_count,
                "tissue_polygons": len(head.polygons),
                "drawn_vertices": len(head.drawn.vertices),
                "drawn_triangles": len(head.drawn.triangles),
            },
        }

    def _as_person(self, changes: Mapping[str, object]) -> Rig:
        """Return another person with what was edited here."""
        if self.recipe is None:
            raise InvalidValue(
                f"the {self.name} rig takes no recipe; its face is always the same. "
                "Derive from 'standard' or from a person"
            )
        recipe = Recipe.of(changes, self.recipe)
        before = rig_from_recipe(self.recipe, level=self.level)
        after = rig_from_recipe(recipe, name=self.name, level=self.level)
        muscles = tuple(
            replace(new, **_differences(now, old))
            for now, old, new in zip(self.muscles, before.muscles, after.muscles, strict=True)
        )
        return replace(
            after,
            parameters=after.parameters.edited(self.parameters.edits_of(before.parameters)),
            muscles=muscles,
            action_units=self.action_units,
            emotions=self.emotions,
            combinations=self.combinations,
            jaw=self.jaw,
            model=self.model,
        )

    def _sides_of(self, unit: ActionUnit, side: str) -> tuple[str, ...]:
        """Return the sides of the face that a unit named with `side` moves."""
        if unit.one_sided:
            return (side or "L",)
        return (side,) if side else SIDES

    def _side_vector(self, levels: Mapping[str, float], side: str) -> FloatArray:
        """Return what units at intensities `levels` do by their half of the face."""
        acting = together(self.combinations, levels)
        vector = np.zeros(self.channels.count)
        for name, intensity in sorted(acting.levels.items()):
            unit, _ = self.resolve_unit(name)
            scale = unit.scale(intensity)
            moved = self._moved_by[side].get(name)
            for index, share, weight, stem in moved or self._weights(unit, side):
                vector[index] += share * scale * weight * acting.factors.get((name, stem), 1.0)
            for place, value in unit.pose.items():
                group, axis = place.split(".")
                # A one-sided unit does it all by itself; else half is each side's.
                half = 1.0 if unit.one_sided else 0.5
                sign = -1.0 if unit.one_sided and side == "R" and (group, axis) in MIRRORED else 1.0
                vector[self.channels.index(group, axis)] += sign * half * scale * value
        for index, share, stem in self._muscles_of[side] if acting.adds else ():
            vector[index] += share * acting.adds.get(stem, 0.0)
        return vector

    @cached_property
    def _moved_by(self) -> dict[str, dict[str, list[tuple[int, float, float, str]]]]:
        """What each unit does to the muscles of each side; a command asks for it many times."""
        return {
            side: {name: self._weights(unit, side) for name, unit in self.action_units.items()}
            for side in SIDES
        }

    def _weights(self, unit: ActionUnit, side: str) -> list[tuple[int, float, float, str]]:
        """Return index, share, weight and name without side of the muscles that a unit moves."""
        weights = []
        for index, share, stem in self._muscles_of[side]:
            muscle = self.muscle_names[index]
            weight = unit.muscles.get(muscle, unit.muscles.get(stem, 0.0))
            if weight:
                weights.append((index, share, weight, stem))
        return weights

    @cached_property
    def _muscles_of(self) -> dict[str, list[tuple[int, float, str]]]:
        """Index, share and name without side of the muscles of each side of the face.

        Half of a midline muscle acts for each side: it has only two halves to give.
        """
        muscles: dict[str, list[tuple[int, float, str]]] = {side: [] for side in SIDES}
        for index, name in enumerate(self.muscle_names):
            stem, _, own = name.partition(".")
            for side in own or SIDES:
                muscles[side].append((index, 1.0 if own else 0.5, stem))
        return muscles

    @cached_property
    def _limits(self) -> tuple[FloatArray, FloatArray]:
        """Least and greatest value of each channel, shape (channels,)."""
        limits = [(least_activation(muscle), MAX_ACTIVATION) for muscle in self.muscles]
        limits += [LIMITS[group, axis] for group, axes in GROUPS.items() for axis in axes]
        least, most = np.array(limits).T
        return least, most

    def _custom_unit(self, name: str, spec: Mapping[str, object]) -> ActionUnit:
        known = {"muscles", "jaw", "pose", "title", "region"}
        if not isinstance(spec, Mapping):
            raise InvalidValue(f"action unit {name!r} is {spec!r}; expected an object")
        for key in spec:
            if key not in known:
                raise UnknownName("action unit field", key, known)
        weights = spec.get("muscles", {})
        if not name or not isinstance(weights, Mapping):
            raise InvalidValue(
                f"action unit {name!r}: expected {{'muscles': {{'zygomatic_major': 1.0}}}}"
            )
        stems = {n.partition(".")[0] for n in self.muscle_names} | set(self.muscle_names)
        for muscle, weight in weights.items():
            if muscle not in stems:
                raise UnknownName("muscle", str(muscle), stems)
            _check_range(f"{name}: weight of {muscle}", weight, -MAX_ACTIVATION, MAX_ACTIVATION)
        pose = spec.get("pose", {})
        if not isinstance(pose, Mapping):
            raise InvalidValue(f"action unit {name!r}: pose is {pose!r}; expected an object")
        if "jaw" in spec:
            pose = {**pose, "jaw.pitch": spec["jaw"]}
        places = {f"{group}.{axis}": limits for (group, axis), limits in LIMITS.items()}
        for place, value in pose.items():
            if place not in places:
                raise UnknownName("pose axis", str(place), places)
            _check_range(f"{name}: {place}", value, *places[place])
        return ActionUnit(
            name=name,
            title=str(spec.get("title", name)),
            region=str(spec.get("region", "custom")),
            muscles={str(k): float(v) for k, v in weights.items()},
            pose={str(k): float(v) for k, v in pose.items() if v},
            source="yours",
        )

    def _custom_emotion(self, label: str, spec: object) -> Emotion:
        recipe = spec.get("recipe") if isinstance(spec, Mapping) else spec
        scale = spec.get("scale", "linear") if isinstance(spec, Mapping) else "linear"
        if not isinstance(recipe, str) or not label.strip():
            raise InvalidValue(f"emotion {label!r}: expected a FACS string such as '6C+12D'")
        terms = parse_facs(recipe, str(scale))
        for term in terms:
            self.resolve_unit(term.key)
        if scale != "linear":  # Recipes are kept on one scale, with the same intensities.
            recipe = print_facs(terms)
        synonyms = spec.get("synonyms", ()) if isinstance(spec, Mapping) else ()
        if not isinstance(synonyms, list | tuple) or not all(isinstance(w, str) for w in synonyms):
            raise InvalidValue(f"emotion {label!r}: synonyms are {synonyms!r}; expected words")
        words = tuple(str(word).strip().lower() for word in synonyms)
        return Emotion(label.strip().lower(), recipe, "yours", words)


def least_activation(muscle: Muscle) -> float:
    """Return the least activation of a muscle: below 0 for air, and for lids, which have tone."""
    return -MAX_ACTIVATION if isinstance(muscle, AirPressure | LidMuscle) else 0.0


@lru_cache(maxsize=4)
def builtin_rig(name: str) -> Rig:
    """Return a built-in rig, or that of a person.

    Raises:
        UnknownName: If `name` is not one of `BUILTIN_RIGS` or of the people.
    """
    if name == "standard":
        return rig_from_recipe(STANDARD, name="standard")
    if name in people():
        return rig_from_recipe(people()[name].recipe, name=name)
    if name == "paper":
        rig = rig_from_head(paper_head(), parameters=PAPER_PARAMETERS)
        literal = tuple(_as_in_the_paper(muscle) for muscle in rig.muscles)
        return replace(rig, muscles=literal, model=PAPER_MODEL)
    raise UnknownName("rig", name, (*BUILTIN_RIGS, *people()))


def rig_from_recipe(recipe: Recipe, *, name: str = "person", level: str = "high") -> Rig:
    """Return the rig of the person that a recipe describes: head, tissue, muscles.

    Args:
        recipe: The person.
        name: Of the rig.
        level: Detail of the drawn skin; changes no id.

    Raises:
        UnknownName: There is no such level.
    """
    rig = rig_from_head(
        person_head(recipe, level),
        parameters=living_tissue(recipe),
        # Fitted on the standard person, whose tissue is that of the head that all come from.
        fitted_on=None if recipe == STANDARD else reference_head(level),
    )
    strength = muscle_strength(recipe) / muscle_strength(STANDARD)
    muscles = tuple(_as_strong(muscle, strength) for muscle in rig.muscles)
    units = dict(rig.action_units)
    for unit, factor in _reaches(recipe).items():
        units[unit] = units[unit].reaching(factor)
    return replace(rig, name=name, recipe=recipe, muscles=muscles, level=level, action_units=units)


def _reaches(recipe: Recipe) -> Mapping[str, float]:
    """Return the factors on units' curves that were measured on a person of this very recipe."""
    for person in people().values():
        if person.recipe == recipe:
            return load_reaches().get(person.name, {})
    return {}


def rig_from_head(
    head: Head, *, parameters: TissueParameters, fitted_on: Head | None = None
) -> Rig:
    """Return `head` with the built-in muscles, action units and emotions on it.

    Args:
        head: Any head.
        parameters: Of its tissue.
        fitted_on: The head on which the muscles' reaches were fitted, to which they scale.
    """
    left = load_muscles(head, fitted_on)
    if fitted_on is not None:
        left = _pulling_as_much(left, head, fitted_on)
    muscles: list[Muscle] = []
    for muscle in left:
        muscles.append(muscle)
        if muscle.name.endswith(".L"):
            muscles.append(mirrored(muscle))
    return Rig(
        name=head.name,
        head=head,
        parameters=parameters,
        muscles=tuple(muscles),
        action_units=load_action_units(),
        emotions=load_emotions(),
        combinations=load_combinations(),
    )


def _pulling_as_much(left: list[Muscle], head: Head, fitted_on: Head) -> list[Muscle]:
    """Return `left` with forces such that each pulls as much in all as on the head it fits.

    Forces are a pressure on skin: a small chin, with less skin under the muscle, would be pulled
    less. But the springs along the skin are no softer on a small face (a triangle's stiffness does
    not depend on its size), so it needs the same whole force to move as far.
    """
    here = whole_pull(head, left)
    there = whole_pull(fitted_on, load_muscles(fitted_on))
    shares = np.clip(there / np.maximum(here, 1e-9), *FORCE_SHARES)
    return [
        muscle
        if isinstance(muscle, LidMuscle)
        else replace(muscle, force_scale=muscle.force_scale * float(share))
        for muscle, share in zip(left, shares, strict=True)
    ]


def living_tissue(recipe: Recipe) -> TissueParameters:
    """Return the usual tissue with what is left of it at the recipe's age, sex and weight."""
    usual = TissueParameters()
    edits: dict[str, object] = {}
    for name, share in tissue_of_life(recipe).items():
        value = getattr(usual, name)
        if isinstance(share, dict):
            edits[name] = {layer: getattr(value, layer) * part for layer, part in share.items()}
        else:
            edits[name] = value * share
    return usual.edited(edits)


def _as_strong(muscle: Muscle, strength: float) -> Muscle:
    if isinstance(muscle, LidMuscle | AirPressure) or strength == 1.0:
        return muscle
    return replace(muscle, force_scale=muscle.force_scale * strength)


def _differences(now: Any, old: Any) -> dict[str, Any]:
    """Return the fields of one dataclass that differ from another's."""
    pairs = {f.name: (getattr(now, f.name), getattr(old, f.name)) for f in fields(now)}
    return {name: value for name, (value, before) in pairs.items() if value != before}


def _as_in_the_paper(muscle: Muscle) -> Muscle:
    """Return `muscle` at the paper rig's force, and a sphincter as plain as Eq. 11."""
    if isinstance(muscle, LidMuscle):
        return muscle
    share = PAPER_FORCE_SHARES.get(muscle.name.partition(".")[0], PAPER_FORCE_SHARE)
    weaker = replace(muscle, force_scale=muscle.force_scale * share)
    if isinstance(weaker, SphincterMuscle):
        return replace(weaker, hoop=0.0, bulge=0.0)
    return replace(weaker, bulge=0.0) if isinstance(weaker, LinearMuscle) else weaker


def _edited_muscle(muscle: Muscle, changes: Mapping[str, object]) -> Muscle:
    if not isinstance(changes, Mapping):
        raise InvalidValue(f"muscle {muscle.name}: changes are {changes!r}; expected an object")
    if not changes:
        return muscle
    allowed = {f.name for f in fields(muscle)} & set(EDITABLE)
    edits: dict[str, Any] = {}
    for name, value in changes.items():
        if name not in allowed:
            raise UnknownName("muscle field", name, allowed)
        edits[name] = _like(f"{muscle.name}.{name}", getattr(muscle, name), value)
    return replace(muscle, **edits)


def _like(name: str, old: object, value: object) -> object:
    """Return `value` in the shape of `old`: a number, a point, or a pair of points."""
    if isinstance(old, tuple):
        if name.endswith(".gain") and not isinstance(value, list | tuple):
            value = [value, value]
        if not isinstance(value, list | tuple) or len(value) != len(old):
            raise InvalidValue(f"{name} is {value!r}; expected {len(old)} entries like {old!r}")
        return tuple(_like(name, o, v) for o, v in zip(old, value, strict=True))
    _check_range(name, value, -MOST_OF_A_MUSCLE, MOST_OF_A_MUSCLE)
    return float(value)  # type: ignore[arg-type]


def _check_range(name: str, value: object, low: float, high: float) -> None:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise InvalidValue(f"{name} is {value!r}; expected a finite number")
    if not low <= value <= high:
        raise InvalidValue(f"{name} is {value:g}; it must lie between {low:g} and {high:g}")
