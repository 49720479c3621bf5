"""What a reader asks of a whole book, answered by a process of its own."""

from vbraille.reading.seeking.opening import BookOpening
from vbraille.reading.seeking.seeker import Seeker

__all__ = ["BookOpening", "Seeker"]
