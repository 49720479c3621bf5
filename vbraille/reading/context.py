"""What the keys of a reader mean at the moment."""

from enum import Enum


class Context(Enum):
    """What a reader is doing, which decides what each key stands for."""

    READING = "reading"
    """A line is under the hand."""
    PLACING = "placing"
    """The device waits to be told that its carriage is at the left stop."""
    PROMPT = "typing"
    """A text is being typed, such as what to look for."""
    LEARNING = "learning"
    """A key says what it does, and does nothing."""
