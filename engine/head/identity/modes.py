"""The ways in which faces differ: each a smooth field of about a millimetre, named by what it does.

`MEASURED` is fitted to measurements, `LIDS` moves the lids over the eyeball, `FORMS` tells people
and the sexes apart, `SOFT` comes with age and weight. Places are named points of the built-in head.
Sizes of what is not measured by Farkas were chosen by eye, within what is seen in adults.
"""

from __future__ import annotations

from collections.abc import Mapping

from .fields import NEVER, Bump, Lip, Ramp, Term


def _in_front(start: str, end: str, ease: float) -> Ramp:
    """Return what pushes down all that lies below a stretch of the face, and not the back."""
    return Ramp(
        start,
        end,
        "y",
        (0, -1, 0),
        ease,
        anchor="sn",
        reach=(NEVER, NEVER, 26.0),
        plateau=(0.0, 0.0, 92.0),
    )


"""The face, fading out behind the ears: window of what moves everything below a height."""

MEASURED: Mapping[str, tuple[Term, ...]] = {
    "nose_length": (_in_front("n", "sn", 5.0),),
    "upper_lip": (_in_front("sn", "M0_0", 3.0),),
    "lower_face": (_in_front("M0_10", "gn", 5.0),),
    "forehead": (Bump("tr", (70, 26, 60), (0, 1, -0.25)),),
    "face_width": (Bump("W9_2", (34, 36, 42), (0.5, 0, 0)),),
    "jaw_width": (Bump("W15_3", (30, 26, 34), (0.5, 0, 0)),),
    "head_width": (Bump("eu", (45, 45, 55), (0.5, 0, 0)),),
    "head_length": (Bump("op", (70, 70, 60), (0, 0, -1)),),
    "nose_width": (Bump("sn", (20, 10, 15), stretch=(0.040, 0, 0), offset=(0, 9, -6)),),
    "nose_projection": (Bump("prn", (11, 13, 17), (0, 0, 1)),),
    "mouth_width": (Bump("M0_0", (34, 14, 34), stretch=(0.026, 0, 0)),),
    "upper_red": (Lip(1, "M2_0", (0, 1, 0.35)),),
    "lower_red": (Lip(-1, "M2_10", (0, 1, 0.35)),),
    "eye_spacing": (Bump("eye", (26, 24, 36), (0.5, 0, 0)),),
}  # fmt: skip
LIDS: Mapping[str, tuple[Term, ...]] = {
    "fissure": (Bump("eye", (21, 12, 26), stretch=(0.036, 0, 0)),),
    "opening": (Bump("eye", (14, 9, 24), stretch=(0, 0.07, 0)),),
    "slant": (Bump("eye", (18, 15, 26), shear=(("x", "y", 0.05),)),),
    "fold": (
        Bump("E3_4", (16, 4.5, 8), (0, -1, 0.3)),
        Bump("E3_6", (9, 4.5, 8), (0, -0.4, 0.2)),
    ),
    "hood": (Bump("E3_6", (9, 5, 9), (0, -1, 0.25)), Bump("E4_6", (12, 7, 12), (0, -0.5, 0))),
    "crease": (Bump("E2_4", (15, 3.4, 6), (0, 0.2, 1)),),
    "epicanthus": (
        Bump("E3_1", (4.5, 6, 6), (0.5, -0.7, 0.5), offset=(0.5, -3, -1)),
        Bump("E1_0", (4.2, 5, 6), (0.7, -0.35, 0.6), offset=(-2.2, 2.0, 3)),
    ),
    "upper_lid": (Bump("E1_4", (13, 5, 9), (0, -1, 0), offset=(1, 1, 0)),),
    "lower_lid": (Bump("E1_11", (12, 4, 9), (0, -1, 0), offset=(1, -1, 0)),),
}
"""What moves the lids over the eyeball; applied after everything else has moved the eye whole."""

FORMS: Mapping[str, tuple[Term, ...]] = {
    "brow_ridge": (
        Bump("E4_3", (20, 7.5, 15), (0, 0, 1)),
        Bump("g", (13, 9, 15), (0, 0, 0.55)),
    ),
    "brow_height": (Bump("E4_4", (24, 9, 18), (0, 1, 0)),),
    "brow_arch": (Bump("E4_5", (10, 7, 16), (0, 1, 0), offset=(3, 0, 0)),),
    "forehead_slope": (
        Ramp(
            "g", "tr", "y", (0, 0, -1), 12.0, anchor="tr", reach=(NEVER, NEVER, 34.0),
            plateau=(0, 0, 35.0),
        ),
    ),
    "forehead_dome": (Bump("G2_0", (34, 19, 34), (0, 0, 1), offset=(0, 8, 0)),),
    "eye_depth": (Bump("eye", (24, 20, 34), (0, 0, -1)),),
    "nose_bridge": (Bump("b3_0", (8, 13, 15), (0, 0, 1), offset=(0, -2, 0)),),
    "nose_root_width": (Bump("b3_0", (12, 12, 16), stretch=(0.06, 0, 0), offset=(0, 0, -4)),),
    "nose_hump": (Bump("b4_0", (6.5, 7, 9), (0, 0, 1), offset=(0, -3, 0)),),
    "nose_tip": (
        Bump("prn", (11, 9, 13), (0, 1, 0.15)),
    ),
    "head_height": (Bump("v", (95, 42, 95), (0, 1, 0)),),
    "size": (Bump("n", (NEVER, NEVER, NEVER), stretch=(0.01, 0.01, 0.01), offset=(0, 0, -60)),),
    "forehead_width": (Bump("G2_7", (26, 26, 40), (0.55, 0, 0), offset=(4, 0, -14)),),
    "mouth_corners": (Bump("M1_5", (7, 6, 12), (0, 1, 0), offset=(1, 0, 0)),),
    "nose_tip_width": (Bump("prn", (13, 10, 12), stretch=(0.07, 0, 0), offset=(0, 0, -4)),),
    "nostril_flare": (Bump("A7", (6, 6, 8), (0.8, 0.2, 0.4)),),
    "cheekbones": (Bump("C6_1", (15, 11, 20), (0.5, 0.1, 0.85), offset=(8, 1, -4)),),
    "lip_projection": (Bump("M0_0", (27, 15, 30), (0, 0, 1)),),
    "cupid": (Bump("M2_1", (4.5, 3.5, 8), (0, 0.7, 0.2)), Bump("M2_0", (3, 3, 8), (0, -0.5, 0))),
    "chin_projection": (Bump("pg", (20, 15, 24), (0, 0, 1)),),
    "chin_width": (Bump("C4_8", (11, 12, 18), (0.7, 0, 0.25), offset=(0, -2, 0)),),
    "jaw_angle": (Bump("W15_3", (18, 16, 20), (0.35, -0.75, -0.45), offset=(0, -2, 4)),),
    "jaw_line": (Bump("C8_6", (20, 13, 26), (0.6, -0.35, 0), offset=(-4, -4, 10)),),
    "neck_width": (
        Bump("C8_10", (80, 40, 80), stretch=(0.018, 0, 0.010), offset=(0, -42, -35)),
    ),
    "lower_cheek": (Bump("C6_4", (20, 17, 30), (0.8, 0, 0.15), offset=(2, -15, -10)),),
    "larynx": (Bump("C8_10", (9, 12, 16), (0, 0, 1), offset=(0, -24, -2)),),
    "ear_length": (Bump("pa", (16, 34, 30), stretch=(0, 0.019, 0.010), offset=(-6, -1, 12)),),
    "ear_out": (Bump("pa", (12, 30, 16), (1, 0, 0), offset=(2, 0, -3)),),
}  # fmt: skip
SOFT: Mapping[str, tuple[Term, ...]] = {
    "cheek": (Bump("C6_4", (17, 17, 26), (0.62, 0, 0.75), offset=(-2, 3, 0)),),
    "mid_cheek": (Bump("C5_2", (13, 10, 18), (0.25, -0.1, 0.95), offset=(2, 3, 0)),),
    "jowl": (Bump("C7_6", (15, 12, 22), (0.4, -0.7, 0.4), offset=(-12, -10, 18)),),
    "submental": (Bump("C6_10", (32, 15, 28), (0, -1, 0.25), offset=(0, -2, -14)),),
    "neck_soft": (Bump("C8_10", (48, 40, 50), stretch=(0.022, 0, 0.02), offset=(0, -30, -30)),),
    "temple": (Bump("G2_7", (11, 17, 20), (1, 0, 0.2), offset=(3, -9, -9)),),
    "tear_trough": (
        Bump("E4_14", (7, 4.5, 9), (0, 0, -0.8)),
        Bump("E4_13", (7, 4.5, 9), (0, 0, -0.7), offset=(2, 0, 0)),
    ),
    "eye_bag": (Bump("E3_12", (10, 4, 8), (0, -0.25, 1)),),
    "nasolabial": (
        Bump("M4_4", (4.5, 9, 10), (0, 0, -1), offset=(1, 3, 0)),
        Bump("C5_3", (8, 10, 14), (0.1, -0.25, 0.8), offset=(1, -3, 0)),
    ),
    "marionette": (
        Bump("M4_6", (5, 8, 10), (0, 0, -0.8), offset=(0, -2, 0)),
        Bump("M1_5", (6, 5, 10), (0, -0.15, 0), offset=(2, -2, 0)),
    ),
    "maxilla": (Bump("sn", (24, 16, 28), (0, 0, -1), offset=(0, -3, -8)),),
    "brow_ptosis": (Bump("E4_5", (22, 9, 18), (0, -1, 0), offset=(2, 0, 0)),),
    "neck_bands": (Bump("C8_10", (5, 26, 20), (0, 0, 1), offset=(11, -26, -2)),),
    "prejowl": (Bump("C5_8", (10, 9, 15), (-0.15, 0.3, -0.7)),),
    "lobule": (Bump("sba", (11, 9, 12), (0, -1, 0.1)),),
}

MODES: Mapping[str, tuple[Term, ...]] = {**MEASURED, **LIDS, **FORMS, **SOFT}
"""Every mode by name."""
