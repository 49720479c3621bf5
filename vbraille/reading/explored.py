"""Base of books, pictures, games and tuning, all of which are explored under a hand."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.reading.commands import Where
from vbraille.reading.outputs import Cue
from vbraille.reading.prompt import Prompt

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.reading.device import ReadingDevice
    from vbraille.reading.outputs import Output


class Explored:
    """Object that commands work on.

    Parameters
    ----------
    device
        Device that it is shown on.
    outputs
        Where sentences go, and what is under the hand is shown.
    key_set
        Set of keys, "usual" or "nvda".

    Attributes
    ----------
    where : Where
        Which commands there are.
    doing : str
        What is done while the array does not rest, such as "reading".
    prompt : Prompt or None
        Question that is being answered by typing.
    learning, done : bool
        Whether keys only say what they do, and whether exploring is over.
    inside : Explored or None
        What is felt in its place, such as a figure of a book.
    """

    where = Where.ANYWHERE
    doing = "reading"

    def __init__(
        self, device: ReadingDevice, outputs: Sequence[Output], key_set: str = "usual"
    ) -> None:
        self.device, self.outputs, self.key_set = device, outputs, key_set
        self.learning = self.done = False
        self.prompt: Prompt | None = None
        self.inside: Explored | None = None

    def say(self, sentence: str, cue: Cue = Cue.NONE) -> None:
        """Say a sentence on every output."""
        for output in self.outputs:
            output.say(sentence, cue)

    def refuse(self, sentence: str) -> None:
        """Say that something cannot be done, or there is no more of it."""
        self.say(sentence, Cue.LIMIT)

    def ask(
        self, question: str, answer: Callable[[str], None], earlier: Sequence[str] = ()
    ) -> None:
        """Ask for a line that is typed; Escape leaves the question."""
        self.prompt = Prompt(question, answer, earlier)
        self.say(question)

    # What outputs show of it

    @property
    def text(self) -> str:
        """Text under the hand, as it is spoken; empty if there is none."""
        return ""

    @property
    def line_masks(self) -> NDArray[np.uint8] | None:
        """Dot masks of the line under the hand, uint8[cells]; None if it has none."""
        return None

    @property
    def cell(self) -> int | None:
        """Cell of that line under the finger; None if there is none."""
        return None

    def echoed(self, echo: str) -> Iterable[str]:  # noqa: ARG002 - of a line, if it has one
        """Lines that are printed of what has come under the hand; see `Console`."""
        return ()

    # What the loop calls

    @property
    def hopeless(self) -> str | None:
        """Reason why exploring will not come to its end without help; None without one."""
        return None

    def come_back(self) -> None:
        """Put this under the hand again, after something was felt in its place."""

    def steer(self) -> None:
        """Have a simulated hand begin again with what is under it."""

    def follow(self, ticks: NDArray[np.void]) -> None:
        """Look where the hand went."""

    def idle(self, now_s: float) -> None:
        """Do what is done by time; called at each step of the loop."""

    def route(self, cell: int) -> None:
        """Say what is at a cell of the line, and go there."""

    def turn(self, knob: str, value: float) -> str:  # noqa: ARG002 - of a style, if it has one
        """Give a knob of the style a value; a sentence on it, or empty if it had it before."""
        return ""
