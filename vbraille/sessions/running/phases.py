"""The phases that a session goes through."""

from enum import Enum, auto


class Phase(Enum):
    """Phase of a session, by what the session waits for."""

    BREAK = auto()  # a break, which Enter ends
    READY = auto()  # before a trial, until the slider is at the left; on paper, until Enter
    OPEN = auto()  # a trial, until its answer
    LAST = auto()  # all trials are done; Enter ends the session, an undo takes back an answer
    OVER = auto()  # the session waits for nothing any more
