"""The inverse: from where landmarks are wanted to the muscles that bring them there."""

from .answer import Inverse, Question, Reached, invert, question_of, search_for
from .response import Response, response_of

__all__ = [
    "Inverse",
    "Question",
    "Reached",
    "Response",
    "invert",
    "question_of",
    "response_of",
    "search_for",
]
