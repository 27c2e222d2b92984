"""The facial muscles: where each pulls the skin, and which way (paper sections 4.1 to 4.4)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, TypeAlias

import numpy as np

from .arrays import FloatArray
from .errors import InvalidValue

Point: TypeAlias = tuple[float, float, float]

MIDLINE_BLEND_MM = 5.0
"""Half width of the strip in which a left and a right muscle share the skin.

Without it both act in full on the midline column and pull it twice; found on the built-in head.
"""
SHEET_TAPER = 0.35
"""Outer share of a sheet's half width over which its force fades; the paper has a hard edge."""
BELLY_PLACE = 0.4
"""Middle of a linear muscle's belly, as a share of its length from the attachment."""
BELLY_REACH = 0.5
"""Distance from there, as a share of the length, at which the belly lifts no more."""
RING_PEAK = 0.6
"""Radius, as a share of the ellipse, at which the ring profile of a sphincter is greatest."""
MAX_GAIN = 2.0
"""Greatest share of its own force that a muscle may have."""
SPHINCTER_REACH_MM = 30.0
"""Greatest distance from a sphincter's plane at which it acts; spares the back of the head."""


@dataclass(frozen=True)
class LinearMuscle:
    """Fibres that leave one point of bone and pull the skin towards it (Eqs. 1-8).

    Attributes:
        name: "zygomatic_major.L"; the part after the dot is the side.
        attachment: Bone end m_A, head frame, mm.
        insertion: Skin end m_I, head frame, mm.
        radius: Reach R from the attachment, mm; greater than the muscle's length.
        angle: Greatest angle φ between fibre and skin point, degrees, under 90.
        strength: η, the micro control: a smaller value spreads the pull along the muscle.
        force_scale: α, the macro control, paper stiffness units times mm per reference area.
        acts_on: "skin", or one side of the lip slit: "upper_lip" or "lower_lip".
        extension: True for a muscle that the paper's 23 do not have.
        gain: Share of the force that acts in the left and in the right half of the face, 0..2:
            under 1 for a palsy or a relaxed muscle.
        bulge: Force with which the belly, thicker as it shortens, lifts what lies over it, as a
            share of the muscle's own (after Kähler, Haber, Seidel 2001; the paper has none).
        source: Where geometry and values come from.
    """

    name: str
    attachment: Point
    insertion: Point
    radius: float
    angle: float
    strength: float
    force_scale: float
    acts_on: str = "skin"
    extension: bool = False
    gain: tuple[float, float] = (1.0, 1.0)
    bulge: float = 0.0
    source: str = ""
    kind: str = "linear"

    def __post_init__(self) -> None:
        _check_positive(self, "strength", "radius")
        _check_gain(self)
        _check_range(self, "angle", 1.0, 89.0)
        length = math.dist(self.attachment, self.insertion)
        if self.radius <= length:
            raise InvalidValue(
                f"muscle {self.name}: radius is {self.radius:g} mm; it must be greater than the "
                f"distance from attachment to insertion, {length:.1f} mm"
            )

    def weights(self, points: FloatArray) -> FloatArray:
        """Return Θ1(λ) Θ2(γ) at skin `points`, shape (k, 3), mm → shape (k,)."""
        attachment, insertion = np.array(self.attachment), np.array(self.insertion)
        fibre = insertion - attachment
        length = math.sqrt(fibre @ fibre)
        offset = points - attachment
        distance = np.linalg.norm(offset, axis=1)  # Eq. 1
        along = distance / length  # Eq. 2
        cosine = (offset @ fibre) / (np.maximum(distance, 1e-9) * length)
        across = np.arccos(np.clip(cosine, -1.0, 1.0)) / math.radians(self.angle)  # Eq. 3
        reach = self.radius / length  # Eq. 6
        return longitudinal_profile(along, reach, self.strength) * angular_profile(
            across, math.radians(self.angle)
        )

    def directions(self, points: FloatArray) -> FloatArray:
        """Return unit vectors from skin `points`, shape (k, 3), to the attachment (Eq. 5)."""
        return _unit(np.array(self.attachment) - points)

    def belly(self, points: FloatArray) -> FloatArray:
        """Return how much the belly lifts skin `points`, shape (k, 3), mm → shape (k,), 0..1."""
        attachment, insertion = np.array(self.attachment), np.array(self.insertion)
        middle = attachment + BELLY_PLACE * (insertion - attachment)
        reach = BELLY_REACH * math.dist(self.attachment, self.insertion)
        within = np.clip(1.0 - ((points - middle) ** 2).sum(axis=1) / reach**2, 0.0, 1.0)
        return np.asarray(within**2)


@dataclass(frozen=True)
class SphincterMuscle:
    """Fibres that ring an opening and draw it towards a virtual centre (Eqs. 9-12).

    Attributes:
        name: "orbicularis_oris", or with a side.
        center: Epicentre o of the pull, mm. In front of the lips it makes them pout.
        plane: A point of the ellipse's plane, mm; the ellipse is centred on it.
        normal: Normal of that plane.
        semi_major: a, along the x axis projected into the plane, mm.
        semi_minor: b, mm.
        hoop: Share of the force that follows the ring's curvature, 0..1 (a hoop under tension
            presses where it bends most); 0 is the paper's.
        sector: "whole", or "lower_lateral": the part of the orbital ring that lifts the cheek.
        tangential: True where the ring lies on bone and can only slide the skin along it.
        force_scale: α.
        extension: True for a muscle that the paper's 23 do not have.
        gain: Share of the force that acts in the left and in the right half of the face, 0..2:
            under 1 for a palsy or a relaxed muscle.
        bulge: As a linear muscle's; the ring lifts what it pulls on, where it pulls.
        source: Where geometry and values come from.
    """

    name: str
    center: Point
    plane: Point
    normal: Point
    semi_major: float
    semi_minor: float
    force_scale: float
    hoop: float = 0.0
    sector: str = "whole"
    tangential: bool = False
    acts_on: str = "skin"
    extension: bool = False
    gain: tuple[float, float] = (1.0, 1.0)
    bulge: float = 0.0
    source: str = ""
    kind: str = "sphincter"

    def __post_init__(self) -> None:
        _check_positive(self, "semi_major", "semi_minor")
        _check_gain(self)
        _check_range(self, "hoop", 0.0, 1.0)

    def weights(self, points: FloatArray, *, profile: str = "ring") -> FloatArray:
        """Return Θ(r) at skin `points`, shape (k, 3), mm → shape (k,).

        Args:
            points: Skin points, mm.
            profile: "ring" (default, falls to 0 on the rim) or "literal" (Eq. 11, greatest there).
        """
        across, up, out = self._local(points)
        radius = self.radius_at(points)
        weight = ring_profile(radius) if profile == "ring" else literal_ring_profile(radius)
        if self.hoop:
            weight = weight * self._hoop_factor(across, up, radius)
        return np.where(np.abs(out) < SPHINCTER_REACH_MM, weight, 0.0)

    def directions(self, points: FloatArray) -> FloatArray:
        """Return unit vectors from skin `points`, shape (k, 3), to the epicentre (Eq. 10)."""
        return _unit(np.array(self.center) - points)

    def belly(self, points: FloatArray) -> FloatArray:
        """Return how much the ring lifts skin `points`, shape (k, 3), mm → shape (k,), 0..1."""
        return self.weights(points)

    def radius_at(self, points: FloatArray) -> FloatArray:
        """Return r of Eq. 12 at `points`, shape (k, 3): 0 in the middle, 1 on the rim → (k,)."""
        across, up, _ = self._local(points)
        a, b = self.semi_major, self.semi_minor
        return np.asarray(np.sqrt((up * a) ** 2 + (across * b) ** 2) / (a * b))

    def _local(self, points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        normal = np.array(self.normal) / math.sqrt(sum(c * c for c in self.normal))
        e_x = np.array([1.0, 0.0, 0.0]) - normal * normal[0]
        e_x /= math.sqrt(e_x @ e_x)
        e_y = np.cross(normal, e_x)
        offset = points - np.array(self.plane)
        return offset @ e_x, offset @ e_y, offset @ normal

    def _hoop_factor(self, across: FloatArray, up: FloatArray, radius: FloatArray) -> FloatArray:
        a, b = self.semi_major, self.semi_minor
        safe = np.maximum(radius, 1e-9)
        cos_t, sin_t = across / a / safe, up / b / safe
        # In the very middle no angle is defined, and the bend is taken as on the tighter axis.
        bend = np.maximum(a * a * sin_t**2 + b * b * cos_t**2, min(a, b) ** 2)
        curvature = (b * b / bend) ** 1.5
        return np.asarray((1.0 - self.hoop) + self.hoop * curvature)


@dataclass(frozen=True)
class SheetMuscle:
    """Almost parallel fibres over a rectangle, all pulling one way (Eqs. 13-17).

    Attributes:
        name: "frontalis_medial.L".
        attachment: The two ends m_A1, m_A2 of the attachment line, mm.
        insertion: The two ends m_I1, m_I2 of the insertion line, mm.
        radius: Length L of the zone of influence from the attachment line, mm.
        strength: η.
        force_scale: α.
        extension: True for a muscle that the paper's 23 do not have.
        gain: Share of the force that acts in the left and in the right half of the face, 0..2:
            under 1 for a palsy or a relaxed muscle.
        source: Where geometry and values come from.
    """

    name: str
    attachment: tuple[Point, Point]
    insertion: tuple[Point, Point]
    radius: float
    strength: float
    force_scale: float
    acts_on: str = "skin"
    extension: bool = False
    gain: tuple[float, float] = (1.0, 1.0)
    source: str = ""
    kind: str = "sheet"

    def __post_init__(self) -> None:
        _check_positive(self, "strength", "radius")
        _check_gain(self)

    def weights(self, points: FloatArray) -> FloatArray:
        """Return Θ(λ), tapered to the sides, at skin `points`, shape (k, 3), mm → shape (k,)."""
        middle, pull, length, line, width = self.frame()
        offset = points - middle
        along = -(offset @ pull) / length  # Eq. 16: distance from the attachment line
        reach = self.radius / length  # Eq. 17
        weight = longitudinal_profile(along, reach, self.strength)  # Eq. 15
        across = offset @ line
        lateral = np.abs(across) / (width / 2.0)
        if self.open_inwards:
            lateral = np.where(across < 0.0, 0.0, lateral)
        fade = np.clip((lateral - (1.0 - SHEET_TAPER)) / (2.0 * SHEET_TAPER), 0.0, 1.0)
        return np.asarray(weight * np.cos(fade * math.pi / 2.0) ** 2)

    def directions(self, points: FloatArray) -> FloatArray:
        """Return the sheet's one direction of pull (Eq. 14) for each of `points`, shape (k, 3)."""
        _, pull, _, _, _ = self.frame()
        return np.tile(pull, (len(points), 1))

    @property
    def open_inwards(self) -> bool:
        """Whether it starts at the midline, meets its twin there, and has no edge to fade at."""
        return abs(self.attachment[0][0]) < 1.0

    def frame(self) -> tuple[FloatArray, FloatArray, float, FloatArray, float]:
        """Return m_Ac, the unit n of Eq. 14, |m_Ac - m_Ic|, the unit across the fibres, W.

        The unit across runs from the first end of the attachment line to the second.
        """
        a1, a2 = np.array(self.attachment[0]), np.array(self.attachment[1])
        i1, i2 = np.array(self.insertion[0]), np.array(self.insertion[1])
        middle = (a1 + a2) / 2.0
        pull = middle - (i1 + i2) / 2.0
        length = math.sqrt(pull @ pull)
        pull = pull / length
        line = a2 - a1
        line = line - pull * (line @ pull)
        width = math.sqrt(line @ line)
        line = line / width
        return (
            middle,
            pull,
            length,
            line,
            max(width, math.dist(self.insertion[0], self.insertion[1])),
        )


@dataclass(frozen=True)
class LidMuscle:
    """A muscle that turns the tarsal plates of one eye's lids about the eyeball.

    The lids' margins are stiff plates of cartilage: here their angle is set, and the tissue around
    follows. The paper has no lid muscles; AU5, AU7 and AU43 need them.

    Attributes:
        name: "levator_palpebrae.L".
        upper: Turn of the upper lid at activation 1, degrees; positive closes.
        lower: Turn of the lower lid at activation 1, degrees; positive raises.
        gain: Share of the turn that acts in the left and in the right half of the face, 0..2:
            under 1 for a palsy or a relaxed muscle.
        source: Where the values come from.
    """

    name: str
    upper: float
    lower: float
    extension: bool = True
    gain: tuple[float, float] = (1.0, 1.0)
    source: str = ""
    kind: str = "lid"

    def __post_init__(self) -> None:
        _check_gain(self)


@dataclass(frozen=True)
class AirPressure:
    """Air in the mouth that presses a patch of cheek or lip out, or sucks it in: not a muscle.

    It fills the same row of a command as a muscle does. Positive activation is pressure above
    that of the room, negative below it. The force is along the skin's own normal, as that of a
    fluid at rest is; the paper has nothing like it, and AU33, AU34 and AU35 need it.

    Attributes:
        name: "cheek_air.L".
        center: Middle of the patch, mm.
        extent: Half axes of the ellipsoid whose skin is the patch, mm.
        force_scale: α, as a muscle's.
        gain: Share of the pressure that acts in the left and in the right half of the face, 0..2.
        acts_on: As a linear muscle's.
        source: Where geometry and values come from.
    """

    name: str
    center: Point
    extent: Point
    force_scale: float
    gain: tuple[float, float] = (1.0, 1.0)
    acts_on: str = "skin"
    extension: bool = True
    source: str = ""
    kind: str = "air"

    def __post_init__(self) -> None:
        _check_gain(self)
        if not all(math.isfinite(half) and half > 0.0 for half in self.extent):
            raise InvalidValue(
                f"air {self.name}: extent is {self.extent!r}; its half axes must be above 0"
            )

    def weights(self, points: FloatArray) -> FloatArray:
        """Return the share of the pressure at skin `points`, shape (k, 3), mm → shape (k,).

        It is 1 in the middle and falls smoothly to 0 where the cheek is bound to bone and gum.
        """
        offset = (points - np.array(self.center)) / np.array(self.extent)
        within = np.clip(1.0 - (offset * offset).sum(axis=1), 0.0, 1.0)
        return np.asarray(within**2)


Muscle: TypeAlias = LinearMuscle | SphincterMuscle | SheetMuscle | LidMuscle | AirPressure

KINDS: Mapping[str, type[Muscle]] = {
    "linear": LinearMuscle,
    "sphincter": SphincterMuscle,
    "sheet": SheetMuscle,
    "lid": LidMuscle,
    "air": AirPressure,
}


def longitudinal_profile(along: FloatArray, reach: float, strength: float) -> FloatArray:
    """Return Θ1, Eq. 7 (and Eq. 15): 0 at the attachment, 1 at the insertion, 0 at the reach.

    Args:
        along: λ, distance over muscle length, any shape.
        reach: δ, greater than 1.
        strength: η.
    """
    power = np.clip(along, 0.0, reach) ** strength
    rising = np.cos((1.0 - power) * (math.pi / 2.0))
    falling = np.cos((power - 1.0) / (reach**strength - 1.0) * (math.pi / 2.0))
    inside = (along >= 0.0) & (along <= reach)
    return np.where(inside, np.where(along <= 1.0, rising, falling), 0.0)


def angular_profile(across: FloatArray, angle: float) -> FloatArray:
    """Return Θ2, Eq. 8: 1 on the fibre, 0 at the muscle's greatest `angle` (radians)."""
    inside = across <= 1.0
    across = np.minimum(across, 1.0)
    return np.where(inside, np.cos(angle * across) * np.cos(across * (math.pi / 2.0)), 0.0)


def literal_ring_profile(radius: FloatArray) -> FloatArray:
    """Return Θ as Eq. 11 prints it: greatest on the rim r = 1, and 0 just outside."""
    return np.where(radius <= 1.0, np.cos((1.0 - np.minimum(radius, 1.0)) * (math.pi / 2.0)), 0.0)


def ring_profile(radius: FloatArray) -> FloatArray:
    """Return a continuous Θ in place of Eq. 11: rises to RING_PEAK, falls to 0 on the rim.

    As printed, neighbours across the rim differ by the muscle's whole force and the skin tears.
    """
    rising = np.sin(np.clip(radius / RING_PEAK, 0.0, 1.0) * (math.pi / 2.0))
    falling = np.cos(np.clip((radius - RING_PEAK) / (1.0 - RING_PEAK), 0.0, 1.0) * (math.pi / 2.0))
    return np.where(radius <= RING_PEAK, rising, np.where(radius <= 1.0, falling, 0.0))


def mirrored(muscle: Muscle) -> Muscle:
    """Return the muscle of the other side: x negated, and the side in its name exchanged."""
    stem, _, side = muscle.name.rpartition(".")
    name = f"{stem}.{'R' if side == 'L' else 'L'}"
    points = ("attachment", "insertion", "center", "plane", "normal")
    changes: dict[str, Any] = {
        field.name: _flip(getattr(muscle, field.name))
        for field in fields(muscle)
        if field.name in points
    }
    left, right = muscle.gain
    return replace(muscle, name=name, gain=(right, left), **changes)


def gain_at(muscle: Muscle, x: FloatArray) -> FloatArray:
    """Return the share of `muscle`'s force that acts at points of abscissa `x`, mm, same shape.

    A paired muscle has the gain of its side; across the midline a single one blends its two.
    """
    left, right = muscle.gain
    if muscle.name.endswith((".L", ".R")):
        return np.full(np.shape(x), right if muscle.name.endswith(".R") else left)
    share = np.clip(0.5 + 0.5 * x / MIDLINE_BLEND_MM, 0.0, 1.0)
    return np.asarray(right + (left - right) * share)


def _flip(value: Any) -> Any:
    if isinstance(value, tuple) and value and isinstance(value[0], tuple):
        return tuple(_flip(point) for point in value)
    x, y, z = value
    return (0.0 if x == 0 else -x, y, z)


def _unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=1), 1e-9)[:, None])


def _check_positive(muscle: Muscle, *names: str) -> None:
    for name in names:
        value = getattr(muscle, name)
        if not (math.isfinite(value) and value > 0.0):
            raise InvalidValue(f"muscle {muscle.name}: {name} is {value!r}; it must be above 0")


def _check_gain(muscle: Muscle) -> None:
    for value in muscle.gain:
        if not 0.0 <= value <= MAX_GAIN:
            raise InvalidValue(
                f"muscle {muscle.name}: gain is {value!r}; it must lie between 0 and {MAX_GAIN:g}"
            )


def _check_range(muscle: Muscle, name: str, low: float, high: float) -> None:
    value = getattr(muscle, name)
    if not low <= value <= high:
        raise InvalidValue(
            f"muscle {muscle.name}: {name} is {value!r}; it must lie between {low:g} and {high:g}"
        )
