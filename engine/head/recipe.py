"""A recipe: what a person looks like, in the terms of anthropometry.

Shape is given in standard deviations from the norm of the recipe's sex (Farkas, "Anthropometry of
the Head and Face", 1994), so that 0 is the typical face and ±2 holds nineteen people of twenty.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, fields, replace
from typing import Any

import numpy as np

from ..errors import InvalidValue, UnknownName

SEXES: Mapping[str, float] = {"female": 0.0, "male": 1.0}
SKIN_TONES: Mapping[str, float] = {
    "very_light": 0.0,
    "light": 0.2,
    "intermediate": 0.4,
    "tan": 0.6,
    "brown": 0.8,
    "dark": 1.0,
}
"""Six classes of skin by its individual typology angle (Chardon et al., 1991), evenly spaced."""
UNDERTONES: Mapping[str, float] = {"cool": -1.0, "neutral": 0.0, "warm": 1.0}
EYE_COLORS = ("blue", "gray", "green", "hazel", "amber", "brown", "dark_brown")
HAIR_COLORS = (
    "black",
    "dark_brown",
    "brown",
    "auburn",
    "red",
    "dark_blond",
    "blond",
    "gray",
    "white",
)
HAIR_STYLES = ("bald", "buzz", "crop", "short", "bob", "curly", "receding")

LIMITS: Mapping[str, tuple[float, float]] = {
    "sex": (0.0, 1.0),
    "age": (18.0, 90.0),
    **dict.fromkeys(
        (
            "face_width",
            "face_height",
            "head_width",
            "head_length",
            "head_height",
            "forehead_height",
            "forehead_width",
            "forehead_slope",
            "brow_ridge",
            "brow_height",
            "eye_spacing",
            "eye_size",
            "eye_opening",
            "eye_slant",
            "eye_depth",
            "lid_fold",
            "inner_fold",
            "nose_length",
            "nose_width",
            "nose_projection",
            "nose_bridge",
            "nose_hump",
            "nose_tip",
            "nose_tip_width",
            "mouth_width",
            "upper_lip",
            "lip_fullness",
            "lip_balance",
            "cupid_bow",
            "lip_projection",
            "mouth_corners",
            "cheekbones",
            "jaw_width",
            "jaw_angle",
            "chin_projection",
            "chin_width",
            "ear_size",
            "ear_angle",
            "neck_width",
            "weight",
        ),
        (-3.0, 3.0),
    ),
    "skin": (0.0, 1.0),
    "undertone": (-1.0, 1.0),
    "freckles": (0.0, 1.0),
    "stubble": (0.0, 1.0),
    "grayness": (0.0, 1.0),
    "asymmetry": (0.0, 2.0),
}
_WORDS: Mapping[str, Mapping[str, float]] = {
    "sex": SEXES,
    "skin": SKIN_TONES,
    "undertone": UNDERTONES,
}
_CHOICES: Mapping[str, tuple[str, ...]] = {
    "eye_color": EYE_COLORS,
    "hair_color": HAIR_COLORS,
    "hair_style": HAIR_STYLES,
}


@dataclass(frozen=True)
class Recipe:
    """One person's head. The defaults are the built-in standard head.

    Attributes:
        sex: 0 female to 1 male; also "female" or "male".
        age: Years, 18 to 90; changes shape, skin and tissue.
        face_width: Width over the cheekbones (zy-zy), standard deviations; so are all to `weight`.
        face_height: Root of the nose to chin (n-gn).
        head_width: Breadth of the braincase (eu-eu).
        head_length: Brow to the back of the head (g-op).
        head_height: How high the crown stands.
        forehead_height: Hairline to root of the nose (tr-n).
        forehead_width: Over the temples.
        forehead_slope: How far the forehead leans back.
        brow_ridge: How far glabella and brows stand out.
        brow_height: How high the brows stand.
        eye_spacing: Between the inner corners of the eyes (en-en).
        eye_size: Length of the eye fissure (en-ex).
        eye_opening: Height of the eye fissure (ps-pi): narrow to round.
        eye_slant: How high the outer corner stands over the inner one.
        eye_depth: How deep the eyes lie.
        lid_fold: How low the upper lid's fold hangs over its crease, and over the inner corner.
        inner_fold: How far a fold of the upper lid hangs over the inner corner (epicanthus).
        nose_length: n-sn.
        nose_width: al-al.
        nose_projection: sn-prn.
        nose_bridge: How high the bridge stands between the eyes.
        nose_hump: How far the back of the nose bows out.
        nose_tip: How far the tip turns up.
        nose_tip_width: Breadth of the tip, fine to bulbous.
        mouth_width: ch-ch.
        upper_lip: Height of the upper lip (sn-sto).
        lip_fullness: Height of the red of both lips (ls-sto, sto-li).
        lip_balance: How much fuller the lower lip is than the upper one.
        cupid_bow: How sharply the upper lip's border bows.
        lip_projection: How far the mouth stands out.
        mouth_corners: How high the corners of the mouth stand.
        cheekbones: How far the cheekbones stand out forward.
        jaw_width: Over the angles of the jaw (go-go).
        jaw_angle: How far down, out and back the angle of the jaw stands.
        chin_projection: How far the chin stands out.
        chin_width: Breadth of the chin.
        ear_size: Length of the ear (sa-sba).
        ear_angle: How far the ear stands off the head.
        neck_width: Breadth of the neck.
        weight: Fullness of cheek, jowl and neck.
        skin: Tone, 0 very light to 1 dark; also a name of `SKIN_TONES`.
        undertone: -1 cool (pink) to 1 warm (golden); also "cool", "neutral", "warm".
        freckles: 0 none to 1 many.
        stubble: Beard shadow, 0 shaven close to 1 three days' growth; goes with sex where it is
            not given.
        eye_color: One of `EYE_COLORS`.
        hair_color: One of `HAIR_COLORS`, before it greys.
        hair_style: One of `HAIR_STYLES`; goes with sex and skin where it is not given.
        grayness: Share of grey hair, 0 to 1; goes with age where it is not given.
        asymmetry: Natural difference of the two sides, seen only; 0 none, 1 usual.
        seed: Chooses the small things: freckles, pores, the sides' difference.
    """

    sex: float = 1.0
    age: float = 30.0
    face_width: float = 0.0
    face_height: float = 0.0
    head_width: float = 0.0
    head_length: float = 0.0
    head_height: float = 0.0
    forehead_height: float = 0.0
    forehead_width: float = 0.0
    forehead_slope: float = 0.0
    brow_ridge: float = 0.0
    brow_height: float = 0.0
    eye_spacing: float = 0.0
    eye_size: float = 0.0
    eye_opening: float = 0.0
    eye_slant: float = 0.0
    eye_depth: float = 0.0
    lid_fold: float = 0.0
    inner_fold: float = 0.0
    nose_length: float = 0.0
    nose_width: float = 0.0
    nose_projection: float = 0.0
    nose_bridge: float = 0.0
    nose_hump: float = 0.0
    nose_tip: float = 0.0
    nose_tip_width: float = 0.0
    mouth_width: float = 0.0
    upper_lip: float = 0.0
    lip_fullness: float = 0.0
    lip_balance: float = 0.0
    cupid_bow: float = 0.0
    lip_projection: float = 0.0
    mouth_corners: float = 0.0
    cheekbones: float = 0.0
    jaw_width: float = 0.0
    jaw_angle: float = 0.0
    chin_projection: float = 0.0
    chin_width: float = 0.0
    ear_size: float = 0.0
    ear_angle: float = 0.0
    neck_width: float = 0.0
    weight: float = 0.0
    skin: float = 0.25
    undertone: float = 0.1
    freckles: float = 0.15
    stubble: float = 0.35
    eye_color: str = "hazel"
    hair_color: str = "dark_brown"
    hair_style: str = "crop"
    grayness: float = 0.0
    asymmetry: float = 1.0
    seed: int = 0

    def __post_init__(self) -> None:
        for name, (low, high) in LIMITS.items():
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int | float):
                raise InvalidValue(f"recipe {name} is {value!r}; expected a number")
            if not (math.isfinite(value) and low <= value <= high):
                raise InvalidValue(
                    f"recipe {name} is {value:g}; it must lie between {low:g} and {high:g}"
                )
        for name, known in _CHOICES.items():
            if getattr(self, name) not in known:
                raise UnknownName(f"recipe {name}", str(getattr(self, name)), known)
        if isinstance(self.seed, bool) or not isinstance(self.seed, int):
            raise InvalidValue(f"recipe seed is {self.seed!r}; expected a whole number")
        if not 0 <= self.seed < 2**32:
            raise InvalidValue(f"recipe seed is {self.seed}; it must lie between 0 and 2^32 - 1")

    @classmethod
    def of(cls, values: Mapping[str, object], base: Recipe | None = None) -> Recipe:
        """Return the recipe that plain data gives; what is not named stays as it is in `base`.

        Args:
            values: By attribute; words are understood where an attribute has them. With "sample",
                a whole number (or true, for the seed), all attributes that are not named are
                drawn from people at large by that number, each by itself: to name one leaves
                the others as they were drawn.
            base: The built-in head if none is given.

        Raises:
            UnknownName: For an attribute or word that does not exist.
            InvalidValue: For a number outside its range.
        """
        known = [f.name for f in fields(cls)]
        given: dict[str, Any] = {}
        values, seed = _without_sample(values)
        for name, value in values.items():
            if name not in known:
                raise UnknownName("recipe attribute", name, [*known, SAMPLE])
            given[name] = _number(name, value)
        if seed is not None:
            given = {**_drawn(seed, given), **given}
        before = base or STANDARD
        recipe = replace(before, **given)
        # What was usual for the sex and the age before is what is usual now.
        usual: dict[str, Any] = {
            name: find(recipe)
            for name, find in USUAL.items()
            if name not in given and getattr(before, name) == find(before)
        }
        return replace(recipe, **usual)

    def to_json(self) -> dict[str, object]:
        """Return every attribute as plain data."""
        return asdict(self)


def _number(name: str, value: object) -> object:
    """Return the number that stands for a word; a number in one form, so that 60 is 60.0."""
    words = _WORDS.get(name)
    if words is not None and isinstance(value, str):
        if value not in words:
            raise UnknownName(f"recipe {name}", value, words)
        return words[value]
    if name in LIMITS and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    return value


SAMPLE = "sample"
"""Word of a recipe that asks for a person drawn by a number."""
_SPREAD = 0.85
"""Standard deviations of what is drawn: a face with every part extreme is nobody's."""
_MOST = 2.0


def _without_sample(values: Mapping[str, object]) -> tuple[Mapping[str, object], int | None]:
    """Return what is given without "sample", and the number to draw by, if that is asked for."""
    sample = values.get(SAMPLE)
    rest = {name: value for name, value in values.items() if name != SAMPLE}
    if sample is None or sample is False:
        return rest, None
    number = rest.get("seed", 0) if sample is True else sample
    if isinstance(number, bool) or not isinstance(number, int) or not 0 <= number < 2**32:
        raise InvalidValue(
            f"recipe {SAMPLE} is {sample!r}; expected a whole number from 0 to 2^32 - 1, or true"
        )
    return {"seed": number, **rest}, number


def _drawn(seed: int, given: Mapping[str, object]) -> dict[str, object]:
    """Return every attribute drawn by `seed`; hair and eyes go with the skin, given or drawn."""

    def draw(name: str) -> np.random.Generator:
        return np.random.default_rng((seed, *name.encode()))

    drawn: dict[str, object] = {}
    for name, (low, high) in LIMITS.items():
        if (low, high) == (-3.0, 3.0):
            value = float(np.clip(draw(name).normal(0.0, _SPREAD), -_MOST, _MOST))
            drawn[name] = round(value, 2)
    drawn["sex"] = float(draw("sex").integers(2))
    drawn["age"] = float(draw("age").integers(18, 81))
    drawn["skin"] = round(float(draw("skin").uniform()), 2)
    drawn["undertone"] = round(float(draw("undertone").uniform(-1.0, 1.0)), 2)
    skin = {**drawn, **given}["skin"]
    light = 1.0 - float(skin) if isinstance(skin, int | float) else 0.5
    drawn["freckles"] = round(float(draw("freckles").uniform() ** 2 * light), 2)
    # Fair hair and light eyes come with light skin, and not always.
    fair = light + float(draw("fair").normal(0.0, 0.15))
    eyes = EYE_COLORS[:4] if fair > 0.8 else EYE_COLORS[3:6] if fair > 0.5 else EYE_COLORS[5:]
    hair = HAIR_COLORS[2:7] if fair > 0.8 else HAIR_COLORS[1:4] if fair > 0.55 else HAIR_COLORS[:2]
    drawn["eye_color"] = str(draw("eye_color").choice(eyes))
    drawn["hair_color"] = str(draw("hair_color").choice(hair))
    women = {**drawn, **given}["sex"] in (0, 0.0)
    styles = ("short", "bob", "curly", "crop") if women else HAIR_STYLES
    drawn["hair_style"] = str(draw("hair_style").choice(styles))
    return drawn


STANDARD = Recipe()
"""The built-in head."""


def recipe_attributes() -> dict[str, dict[str, object]]:
    """Return what can be asked of a recipe, by attribute: `default`, and `range` or `choices`.

    An attribute that also takes words has them, with their numbers, as `words`.
    """
    described: dict[str, dict[str, object]] = {}
    for name, default in STANDARD.to_json().items():
        attribute: dict[str, object] = {"default": default}
        if name in LIMITS:
            attribute["range"] = list(LIMITS[name])
        if name in _CHOICES:
            attribute["choices"] = list(_CHOICES[name])
        if name in _WORDS:
            attribute["words"] = dict(_WORDS[name])
        described[name] = attribute
    return described


def usual_grayness(recipe: Recipe) -> float:
    """Return the share of grey hair usual at the recipe's age: half of it at 55 (Panhard 2012)."""
    risen = 1.0 / (1.0 + math.exp(-(recipe.age - 55.0) / 7.0)) - 0.03
    return round(max(0.0, risen), 3) if recipe.age > 30.0 else 0.0


def usual_stubble(recipe: Recipe) -> float:
    """Return the beard shadow usual for the recipe's sex."""
    return round(0.35 * recipe.sex, 3)


COILED_FROM = 0.9
"""Tone from which curls are the likelier guess, for hair coils most where skin is darkest (by
origin: Loussouarn et al. 2007, "Worldwide diversity of hair curliness")."""


def usual_hair_style(recipe: Recipe) -> str:
    """Return a common way to wear hair for the recipe's sex and skin: longer on women."""
    if recipe.sex >= 0.5:
        return "crop"
    return "curly" if recipe.skin >= COILED_FROM else "bob"


USUAL: Mapping[str, Callable[[Recipe], float | str]] = {
    "grayness": usual_grayness,
    "stubble": usual_stubble,
    "hair_style": usual_hair_style,
}
"""Attributes that go with sex, age and skin unless they are given."""
