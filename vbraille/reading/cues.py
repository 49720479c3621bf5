"""Short signals of what is easily missed, such as the end of a line."""

from enum import Enum


class Cue(Enum):
    """Something that a signal stands for, beside the sentence that says it."""

    LINE_END = "line end"
    PAGE_END = "page end"
    NOT_FOUND = "not found"
    LIMIT = "limit reached"
