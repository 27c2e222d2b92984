"""The inverse: from where landmarks are wanted to the muscles that bring them there."""

from .answer import Inverse, Reached, invert
from .response import response_of

__all__ = ["Inverse", "Reached", "invert", "response_of"]
