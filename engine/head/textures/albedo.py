"""The albedo: pigments of zone, mottling, freckles, lips and stubble, texel by texel."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ...arrays import Float32Array, FloatArray
from ...compiling import kept
from ..hair_color import brow_color, scalp_color
from ..noise import spot_noise, value_noise
from ..recipe import Recipe
from .pigment import BLOOD, CAROTENE, MELANIN, blood_visibility, tone
from .texels import Texels
from .zones import Zones


@dataclass(frozen=True)
class Complexion:
    """A recipe as the numbers that the texels need.

    Attributes:
        base: Linear colour of the forehead.
        hair: Linear colours of the roots of scalp and of brows and beard, shape (2, 3).
        dark: Recipe.skin.
        visible: How much of a blush shows.
        stubble: Beard shadow, 0..1.
        freckles: Their chance.
        age: 0 young to 1 old.
        shaven: Whether the scalp's roots lie under the skin, as a beard's.
        female: Share of painted-by-nature contrast of lips.
        seed: Of all noise.
    """

    base: FloatArray
    hair: FloatArray
    dark: float
    visible: float
    stubble: float
    freckles: float
    age: float
    shaven: bool
    seed: int

    @classmethod
    def of(cls, recipe: Recipe) -> Complexion:
        """Return the complexion that a recipe describes."""
        # A woman's shaven-like down is left out; so is a child's.
        beard = recipe.sex**2 * (0.25 + 0.75 * recipe.stubble)
        return cls(
            base=tone(recipe),
            hair=np.stack([scalp_color(recipe), brow_color(recipe)]),
            dark=recipe.skin,
            visible=blood_visibility(recipe),
            stubble=beard,
            freckles=recipe.freckles * (1 - 0.7 * recipe.skin),
            age=float(np.clip((recipe.age - 25) / 55, 0, 1)),
            shaven=recipe.hair_style == "bald",
            seed=recipe.seed % 2**20,
        )


def albedo(texels: Texels, zones: Zones, places: FloatArray, recipe: Recipe) -> Float32Array:
    """Return the linear colours of texels, shape (n, 3).

    Args:
        texels: Where they lie.
        zones: Fields over the skin.
        places: Positions of the vertices on the built-in head [mm], shape (d, 3).
        recipe: The person.
    """
    return colors_at(texels.carried(places), texels.carried(zones.table()), recipe)


def vertex_colors(zones: Zones, places: FloatArray, recipe: Recipe) -> FloatArray:
    """Return the same colours at the vertices: what is drawn until the texture is there, (d, 3)."""
    table = zones.table().astype(np.float32)
    return colors_at(places.astype(np.float32), table, recipe).astype(np.float64)


def colors_at(places: Float32Array, table: Float32Array, recipe: Recipe) -> Float32Array:
    """Return linear colours (n, 3) at places (n, 3) where the zones are `table` (n, k)."""
    look = Complexion.of(recipe)
    numbers = np.array([
        look.dark, look.visible, look.stubble, look.freckles, look.age, look.shaven, recipe.sex,
    ])  # fmt: skip
    pigments = np.stack([MELANIN, BLOOD, CAROTENE])
    names = [field.name for field in fields(Zones)]
    columns = np.array([names.index(name) for name in _KERNEL_ZONES])
    moles = _moles(places, table[:, names.index("front")], look)
    found = np.empty((len(places), 3), dtype=np.float32)
    _colored(
        places, np.ascontiguousarray(table[:, columns]), numbers, look.base, look.hair, pigments,
        moles, look.seed, found,
    )  # fmt: skip
    return found


_KERNEL_ZONES = (
    "blood", "melanin", "yellow", "violet", "lip", "upper", "mouth", "nostril", "lid", "lashes",
    "beard", "scalp", "brow", "freckles", "pores", "front",
)  # fmt: skip


def _moles(places: Float32Array, front: Float32Array, look: Complexion) -> FloatArray:
    """Return a few moles: place and radius [mm], shape (m, 4), the same for every resolution."""
    random = np.random.default_rng(look.seed + 17)
    count = random.poisson(5 + 4 * look.age)
    # Directions from the middle of the head, so that they do not depend on vertices or texels.
    angle = random.uniform(-1.25, 1.25, count)
    height = random.uniform(-112, 68, count)
    radius = 0.45 + 0.75 * random.random(count) ** 2
    return np.column_stack([np.sin(angle), height, np.cos(angle), radius])


@kept(nogil=True)
def _step(low: float, high: float, value: float) -> float:
    share = min(max((value - low) / (high - low), 0.0), 1.0)
    return share * share * (3 - 2 * share)


@kept(nogil=True)
def _colored(
    places: Float32Array,
    table: Float32Array,
    numbers: FloatArray,
    base: FloatArray,
    hair: FloatArray,
    pigments: FloatArray,
    moles: FloatArray,
    seed: int,
    found: Float32Array,
) -> None:
    dark, visible, stubble, freckling = numbers[0], numbers[1], numbers[2], numbers[3]
    age, shaven, sex = numbers[4], numbers[5], numbers[6]
    for n in range(len(places)):
        x, y, z = float(places[n, 0]), float(places[n, 1]), float(places[n, 2])
        blood, melanin, yellow, violet = table[n, 0], table[n, 1], table[n, 2], table[n, 3]
        lip_depth, upper, mouth, nostril = table[n, 4], table[n, 5], table[n, 6], table[n, 7]
        lid, lashes, beard, scalp = table[n, 8], table[n, 9], table[n, 10], table[n, 11]
        brow, freckled, pored, front = table[n, 12], table[n, 13], table[n, 14], table[n, 15]

        # Mottling: blood pools in patches, melanin in finer ones; each octave on its own.
        n14 = value_noise(x / 15, y / 15, z / 15, seed + 1)
        n6 = value_noise(x / 6.2, y / 6.2, z / 6.2, seed + 2)
        n3 = value_noise(x / 2.7, y / 2.7, z / 2.7, seed + 3)
        n1 = value_noise(x / 1.15, y / 1.15, z / 1.15, seed + 4)
        nf = value_noise(x / 0.42, y / 0.42, z / 0.42, seed + 5)
        m9 = value_noise(x / 9.5, y / 9.5, z / 9.5, seed + 6)
        m4 = value_noise(x / 3.9, y / 3.9, z / 3.9, seed + 7)
        m1 = value_noise(x / 1.7, y / 1.7, z / 1.7, seed + 8)
        patches = 0.075 * n14 + 0.10 * n6 + 0.10 * n3 + 0.085 * n1
        flush = max(blood, 0.0)
        red = blood * (1 + 0.5 * n6 + 0.45 * n3) + patches * (0.65 + 1.8 * flush) + 0.05 * nf
        brown = melanin * (1 + 0.5 * dark) + (0.022 + 0.028 * dark + 0.02 * age) * m9
        brown += (0.024 + 0.02 * dark) * m4 + 0.03 * m1 + 0.026 * nf
        gold = yellow * (1 - 0.6 * dark) + 0.02 * m9

        # Broken little vessels on cheeks and wings of the nose, with age and light skin.
        if flush > 0.08 and visible > 0.6:
            wander = 1.6 * n3
            ridge = abs(value_noise((x + wander) / 2.2, (y + wander) / 2.2, z / 2.2, seed + 9))
            red += 0.25 * (0.15 + 0.85 * age) * _step(0.07, 0.0, ridge) * _step(0.1, 0.3, flush)

        # Under the eyes the skin is thin: blood shows violet, and a vein or two.
        if violet > 0.01:
            thin = violet * (0.75 + 0.35 * age) * (1 + 0.35 * n3)
            brown += thin * (0.10 + 0.22 * dark)
            red += thin * 0.15
            gold -= thin * 0.10
        # A vein at the temple.
        if x * x > 2500 and y > 5 and front > 0.1:
            run = value_noise(x / 16, y / 16, z / 16, seed + 10) + 0.25 * n6
            vein = _step(0.07, 0.0, abs(run)) * (1 - dark) * 0.035
            red -= vein
            gold -= 1.6 * vein
            brown += 0.6 * vein

        # Freckles and age spots.
        if freckling * freckled > 0.01:
            chance = freckling * freckled
            big = spot_noise(x / 3.1, y / 3.1, z / 3.1, 0.55 * chance, 0.10, 0.42, seed + 11)
            small = spot_noise(x / 1.7, y / 1.7, z / 1.7, 0.62 * chance, 0.12, 0.40, seed + 16)
            edge = 0.75 + 0.25 * n1
            brown += (0.50 * _step(0.0, 0.75, big) + 0.34 * _step(0.0, 0.8, small)) * edge
        if age > 0.35 and front > 0.05:
            chance = (age - 0.35) * 0.28 * (1 - 0.5 * dark)
            spot = spot_noise(x / 9, y / 9, z / 9, chance, 0.10, 0.46, seed + 21)
            brown += 0.26 * _step(0.0, 0.35, spot + 0.12 * n1 * (spot > 0))
        for m in range(len(moles)):
            out = np.sqrt(x * x + z * z) + 1e-6
            dx, dy, dz = (
                (x / out - moles[m, 0]) * out,
                y - moles[m, 1],
                (z / out - moles[m, 2]) * out,
            )
            gap = np.sqrt(dx * dx + dy * dy + dz * dz) / moles[m, 3]
            if gap < 1.6 and front > 0.3 and lip_depth < -2:
                brown += 0.95 * _step(1.25 + 0.2 * n1, 0.55, gap)

        # Pores: a dark dot each, a little ruddy round it.
        if pored > 0.05:
            pore = spot_noise(x / 1.02, y / 1.02, z / 1.02, 0.6, 0.13, 0.30, seed + 26)
            brown += 0.25 * pored * _step(0.0, 0.9, pore)

        # Lips: a soft, slightly ragged border, fine upright lines, darker outside corners.
        lip = _step(-1.9, 2.3, lip_depth + 0.5 * n1 + 0.25 * nf + 0.4 * n3)
        if lip > 0.0:
            # Lines run from the mouth's opening outwards: noise stretched along y and z.
            bend = 0.5 * n3
            line = value_noise((x + bend) / 0.85, y / 5.5, z / 5.5, seed + 31)
            fine = value_noise((x + bend) / 0.4, y / 3.2, z / 3.2, seed + 32)
            lines = 0.13 * line + 0.10 * fine
            rim = _step(2.6, 0.2, lip_depth)
            lip_red = 0.53 + 0.05 * (1 - upper) + lines + 0.10 * n3 - 0.12 * rim + 0.07 * (1 - sex)
            lip_brown = 0.23 + 0.07 * upper + 0.5 * lines + 0.06 * n6 + 0.05 * age
            # On dark skin the upper lip and the rim are browner, the lower lip rosy within.
            lip_red *= 1 - dark * (0.22 + 0.2 * upper)
            lip_brown += dark * (0.24 * upper + 0.24 * rim - 0.12 * (1 - upper) * (1 - rim))
            lip_red *= 1 - 0.18 * age
            red += lip * (lip_red - 0.8 * red)
            brown += lip * (lip_brown - 0.8 * brown)
            # Mucosa has no thick horny layer, whose yellow would make its pink salmon.
            gold -= lip * (0.42 + 0.5 * gold)

        red = red * (visible + (1 - visible) * 0.6 * lip)
        # Stubble's shadow: hair under the skin, seen through it bluish, then each hair's tip.
        cover = 0.0
        shorn = max(beard * stubble, shaven * 1.4 * scalp)
        if shorn > 0.005:
            shade = min(max(shorn * (1 + 0.25 * n3 + 0.18 * n6), 0.0), 1.0)
            brown += 0.34 * shade * (1 - 0.3 * dark)
            gold -= 0.30 * shade * (1 - dark)
            red -= 0.07 * shade
            tip = spot_noise(
                x / 0.95, y / 0.95, z / 0.95, 0.95 * min(shade * 2.2, 1.0), 0.12, 0.25, seed + 41
            )
            cover = 0.72 * _step(0.0, 0.7, tip) * min(1.0, 0.35 + max(stubble, 0.6 * shaven))

        # Where hair begins, its roots stand apart; farther in they hide the scalp.
        root = 0.0
        if shaven < 0.5 and scalp > 0.01:
            dot = spot_noise(
                x / 1.15, y / 1.15, z / 1.15, min(1.6 * scalp, 1.0), 0.16, 0.34, seed + 46
            )
            full = _step(0.05, 1.0, scalp) * scalp
            root = min(1.05 * full + (1 - full) * 0.6 * _step(0.0, 0.8, dot), 0.97)
        strand = min(max(0.8 * brow * (1 + 0.4 * nf), 0.0), 0.9)

        for c in range(3):
            density = brown * pigments[0, c] + red * pigments[1, c] + gold * pigments[2, c]
            light = base[c] * np.exp(-density)
            light += cover * (0.25 * light + 0.6 * hair[1, c] - light)
            # Roots of scalp and brows; single hairs are drawn over them.
            light += root * (hair[0, c] * (1 + 0.25 * nf) - light)
            light += strand * (0.3 * light + 0.5 * hair[1, c] - light)
            found[n, c] = light

        # Wet and hidden skin.
        deep = (0.34, 0.095, 0.088)
        hole = (0.055, 0.015, 0.012)
        # The edge of a lid is rosy where skin is light, and as brown as the lid where it is dark.
        edge_of_lid = (0.50 - 0.22 * dark, 0.20 - 0.10 * dark, 0.165 - 0.085 * dark)
        lash = (0.035, 0.018, 0.013)
        for c in range(3):
            light = float(found[n, c])
            own = base[c] ** 0.45
            light += 0.85 * mouth * (deep[c] * (0.5 + 0.6 * own) - light)
            light += 0.75 * lid * (edge_of_lid[c] * (0.35 + 0.85 * own) - light)
            light += 0.7 * lashes * (lash[c] - light)
            light += 0.95 * nostril * (hole[c] * (0.3 + own) - light)
            found[n, c] = min(max(light, 0.002), 0.98)
