"""Facial tissue: three layers of mass points joined by biphasic springs (paper section 5)."""

from .contact import Lids
from .fields import check_fields
from .model import TissueModel, assemble, no_pull, rest_skull
from .parameters import LAYERS, PAPER_PARAMETERS, Layered, TissueParameters

__all__ = [
    "LAYERS",
    "PAPER_PARAMETERS",
    "Layered",
    "Lids",
    "TissueModel",
    "TissueParameters",
    "assemble",
    "check_fields",
    "no_pull",
    "rest_skull",
]
