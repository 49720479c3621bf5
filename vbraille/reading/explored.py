"""Base of books, pictures, games and tuning, all of which are explored under a hand."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vbraille.braille.spelling import to_braille
from vbraille.knobs import KNOBS
from vbraille.reading.commands import Where, command, keys_of, spoken, table
from vbraille.reading.outputs import Cue
from vbraille.reading.prompt import Prompt

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.reading.device import ReadingDevice
    from vbraille.reading.outputs import Output

_PAUSE = "pause: rest the array at once, or go on", "space"


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
    display : Display
        The actuators and the carriage.
    doing : str
        What is done while the array does not rest, such as "reading".
    prompt : Prompt or None
        Question that is being answered by typing.
    learning, done : bool
        Whether keys only say what they do, and whether exploring is over.
    inside : Explored or None
        What is felt in its place, such as a figure of a book.
    style : BrailleStyle or None
        Style of its braille; None if it has none.
    hopeless : str or None
        Reason why exploring will not come to its end without help; None without one.
    """

    where = Where.ANYWHERE
    doing = "reading"
    hopeless: str | None = None
    style: Any = None

    def __init__(
        self, device: ReadingDevice, outputs: Sequence[Output], key_set: str = "usual"
    ) -> None:
        self.device, self.outputs, self.key_set = device, outputs, key_set
        self.display = device.display
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

    def refuse_beyond(self, said: str, *, up: bool) -> None:
        """Say that a value is the largest there is, or the smallest."""
        self.refuse(f"{said} is the {'maximum' if up else 'minimum'}")

    def refuse_step(self, step: int, thing: str) -> None:
        """Say that there is no next thing, or no previous one where the step is -1."""
        self.refuse(f"no {'next' if step > 0 else 'previous'} {thing}")

    def ask(
        self,
        question: str,
        answer: Callable[[str], None],
        earlier: Sequence[str] = (),
        *,
        may_be_empty: bool = False,
    ) -> None:
        """Ask for a line that is typed; Escape leaves the question, as does an empty line."""

        def answered(typed: str) -> None:
            if typed.strip() or may_be_empty:
                answer(typed.strip())
            else:
                self.say("cancelled")

        self.prompt = Prompt(question, answered, earlier)
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

    def echoed(self, echo: str) -> Iterator[str]:
        """Lines that are printed of what has come under the hand; see `Console`."""
        masks = self.line_masks
        if masks is not None and echo in ("cells", "both"):
            yield f"cells: {to_braille(masks.tolist())}"
        if masks is not None and echo in ("text", "both"):
            yield f"text: {self.text}"

    # What the loop calls

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

    def turn(self, knob: str, value: float) -> str:
        """Give a knob of the style a value; a sentence on it, or empty if it had it before."""
        turned = KNOBS[knob]
        value = turned.nearest(value)
        if self.style is None or turned.value(self.style) == value:
            return ""
        self.tune(**{turned.field: value})
        return turned.said(value)

    def tune(self, **changes: Any) -> None:
        """Show braille in another style from now on."""

    # Commands of all

    @command(*_PAUSE, where=Where.ANYWHERE & ~(Where.TUNING | Where.GAME), first=True, steers=True,
             also="button:3 pins:PAUSE")  # fmt: skip
    @command(*_PAUSE, where=Where.GAME, steers=True, also="pins:PAUSE")
    def pause(self) -> None:
        """Rest the array, or go on."""
        self.device.paused = not self.device.paused
        self.say("paused" if self.device.paused else self.doing)

    @command("help", "h f1", "f1", where=Where.ANYWHERE, also="pins:HELP")
    def help(self) -> None:
        """Say the keys that people use most."""
        for each in table(self.where):
            if each.first and keys_of(each, self.key_set):
                self.say(f"{spoken(keys_of(each, self.key_set)[0])}: {each.help}")
        self.say("question mark, then any key: what that key does; vbraille keys lists all")

    @command("learn the keys: each says what it does", "? f2", where=Where.ANYWHERE,
             also="pins:LEARN")  # fmt: skip
    def learn(self) -> None:
        """Have keys say what they do, or work again."""
        self.learning = not self.learning
        said = "press a key to hear what it does; q leaves" if self.learning else "keys work again"
        self.say(said)

    @command("quit", "q", "ctrl-d", where=Where.ANYWHERE, first=True)
    def quit(self) -> None:
        """Leave learning, or end."""
        if self.learning:
            self.learn()
        else:
            self.done = True
