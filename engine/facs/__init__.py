"""Action units of the Facial Action Coding System, their notation and their rules (section 3)."""

from .codes import Code, facs_codes
from .lips import LIPS, PARTED, lip_part, part_name, whole_of
from .notation import (
    NEUTRAL,
    Term,
    format_facs,
    parse_facs,
    print_facs,
    split_side,
    term_of,
)
from .rules import Exclusion, Need, broken_rules, exclusions, needs
from .scales import BANDED, LETTERS, SCALES, UNSCORED, letter_of, nearest_letter, scale_named
from .unit import REGIONS, ActionUnit
from .warning import FacsWarning

__all__ = [
    "BANDED",
    "LETTERS",
    "LIPS",
    "NEUTRAL",
    "PARTED",
    "REGIONS",
    "SCALES",
    "UNSCORED",
    "ActionUnit",
    "Code",
    "Exclusion",
    "FacsWarning",
    "Need",
    "Term",
    "broken_rules",
    "exclusions",
    "facs_codes",
    "format_facs",
    "letter_of",
    "lip_part",
    "nearest_letter",
    "needs",
    "parse_facs",
    "part_name",
    "print_facs",
    "scale_named",
    "split_side",
    "term_of",
    "whole_of",
]
