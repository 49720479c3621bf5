"""Open a device for a program of one's own: show texts on it, and follow the hand."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from vbraille.devices.base import Device
from vbraille.devices.registry import check_actuators, check_travel
from vbraille.display import Display, check_rate
from vbraille.errors import DeviceError, InputError
from vbraille.reading.device import HAND, POLL_S, ReadingDevice
from vbraille.reading.frames import check_lines, read_as
from vbraille.reading.outputs import Cue, Output
from vbraille.reading.places import Places
from vbraille.reading.reader import Reader
from vbraille.render.braille.models import STRESS2, Model, check_shown
from vbraille.simulation.specs import refuse_hand
from vbraille.translate import Book, choose_table, text_source

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.devices.events import Event
    from vbraille.engine.clock import Clock
    from vbraille.layout import Line
    from vbraille.render.braille.style import BrailleStyle, StyleChanges


class _Said(Output):
    """An output that calls a function with each sentence."""

    def __init__(self, say: Callable[[str], None]) -> None:
        self._say = say

    def say(self, sentence: str, cue: Cue = Cue.NONE) -> None:  # noqa: ARG002 - sentences only
        if sentence:
            self._say(sentence)


class OpenDevice(ReadingDevice):
    """A device that texts are shown on. A context manager; on exit the actuators fade to rest.

    `vbraille.open` makes one.
    """

    def __init__(self, *how: Any, say: Callable[[str], None], **more: Any) -> None:
        super().__init__(*how, **more)
        self._outputs = [_Said(say)]
        self._reader: Reader | None = None
        self._closed = False

    @property
    def reader(self) -> Reader:
        """Reader of what is shown: `go_on` brings the next line.

        Raises
        ------
        DeviceError
            If nothing is shown.
        """
        if self._reader is None:
            raise DeviceError("nothing is shown; show a text first")
        return self._reader

    @property
    def style(self) -> BrailleStyle:
        """Style that lines are shown in; `tune` changes it."""
        return self.model.style if self._reader is None else self._reader.style

    @property
    def line(self) -> Line | None:
        """Line under the hand; None before the first."""
        return None if self._reader is None else self._reader.line

    @property
    def number(self) -> int:
        """Number of that line, from 1."""
        return self.reader.layout.number(self.reader.line)

    @property
    def done(self) -> bool:
        """Tell whether all that was shown has been read."""
        return self._reader is None or self._reader.done

    def show(
        self,
        text: str,
        *,
        language: str | None = None,
        grade: int | None = None,
        table: str | None = None,
        keep_lines: bool = False,
        first: int = 1,
        last: int | None = None,
        advance: bool = True,
    ) -> None:
        """Put the first line of a text under the hand; the others come as it is polled.

        Parameters
        ----------
        text
            Text that is read.
        language, grade, table
            Language, grade or table of the translation, as for `vbraille.render_text`.
        keep_lines
            Whether each line of the text stays a line; otherwise paragraphs are filled.
        first, last
            Numbers of the first and last line to read, from 1; None for the end.
        advance
            Whether the next line comes when the hand returns; otherwise `reader` is told to go on.

        Raises
        ------
        InputError
            If the text, or its table, cannot be used, or it has no such lines.
        DeviceError
            If the device is closed.
        """
        if self._closed:
            raise DeviceError("the device is closed; open it again")
        check_lines(first, last)
        source = text_source(text, keep_lines=keep_lines)
        book = Book(source, choose_table(language, grade, table))
        self._reader = None
        self._reader = Reader(
            book,
            self,
            self._outputs,
            Places(None, self._outputs[0].say).book("", Path(), ""),
            lines=(first, last),
            attended=False,
            by_hand=advance,
        )
        self._reader.begin()

    def read(self, text: str, **how: Any) -> Iterator[Line]:
        """Show a text, and give each line as it comes under the hand, until all are read.

        Parameters and errors are those of `show`, and errors also those of `poll`.
        """
        self.show(text, **how)
        given = None
        while not self.done:
            if self.line is not None and self.line != given:
                given = self.line
                yield given
            self.poll()

    def poll(self, wait_s: float = POLL_S) -> list[Event]:
        """Let a moment go by, and give the device's events; see `vbraille.devices.events`.

        Lines go on by this. A device that was given itself needs it: poll it again and again.

        Raises
        ------
        VbrailleError
            If the device is gone, or a line cannot be read to its end.
        """
        ticks, events, said = self.take(wait_s)
        for sentence in said:
            self._outputs[0].say(sentence)
        reader = self._reader
        if reader is not None and ticks.size:
            reader.follow(ticks)
            if reader.hopeless is not None:
                raise DeviceError(reader.hopeless)
        return events

    def tune(self, **turned: Unpack[StyleChanges]) -> None:
        """Show lines in another style from now on; see `BrailleStyle.replace`.

        Raises
        ------
        InputError
            If a value is out of range, or leaves no room for a cell.
        """
        if self._reader is not None:
            self._reader.tune(**turned)
        else:
            self._model = replace(self.model, style=self.style.replace(**turned))

    def close(self) -> None:
        """Bring the array to rest, then let the device go. Further calls do nothing."""
        self._closed = True
        super().close()


def open_to_read(
    device: str | Device,
    display: Model | Display | None = None,
    *,
    style: BrailleStyle | None = None,
    hand: str | None = None,
    seed: int | None = None,
    rate_hz: float = 1000.0,
    clock: Clock | None = None,
    say: Callable[[str], None] = lambda _: None,
) -> OpenDevice:
    """Open a device to be read on; use it in a ``with`` block, which brings it to rest at the end.

    Parameters
    ----------
    device
        Spec of the device: "sim" for a simulated one, "serial:/dev/ttyACM0", or a kind of a
        driver that is installed. A process of its own then drives it. Or a `Device` itself,
        which is driven by this process, as long as the program polls it.
    display
        Display that the device must have; None for whatever it has. A simulated device has this
        display, or a STReSS².
    style
        How braille is shown; None for how the display is read unless told otherwise.
    hand, seed
        Hand that moves the simulated device, "sweep:60" if not given, and seed of what is random
        in it.
    rate_hz
        Frames a second, 1 to 10,000.
    clock
        Clock for a `Device` that is given itself; None for the machine's. A clock of
        `vbraille.testing` is turned by hand, and lets a text be read as fast as the machine can.
    say
        Function that is called with each thing that the reader should hear.

    Raises
    ------
    InputError
        If an argument cannot be used.
    DeviceError
        If the device cannot be opened.

    Examples
    --------
    >>> import vbraille
    >>> from vbraille.testing import ManualClock, simulated_device
    >>> clock = ManualClock()
    >>> device = simulated_device(vbraille.STRESS2, hand="sweep:150", clock=clock)
    >>> with vbraille.open(device, clock=clock) as opened:
    ...     for line in opened.read("Two lines of braille, read by a hand that sweeps over them"):
    ...         print(opened.reader.named, line.text.strip())
    line 1 Two lines of braille, read by
    line 2 a hand that sweeps over them
    """
    if not isinstance(device, str | Device):
        if isinstance(device, type):
            name = device.__name__
            raise InputError(f"{name} is a class; give a device of it, as in open({name}())")
        raise InputError(f"device is {device!r}; give a spec such as 'sim', or a vbraille.Device")
    check_shown(STRESS2 if display is None else display, style)
    if isinstance(device, str):
        refuse_hand(device, hand=hand, seed=seed)
    check_rate(rate_hz)
    asked = display.display if isinstance(display, Model) else display
    opened = OpenDevice(
        device,
        replace(STRESS2.display if asked is None else asked, rate_hz=rate_hz),
        hand=HAND if hand is None else hand,
        seed=1 if seed is None else seed,
        clock=clock,
        say=say,
    )
    try:
        opened.start(_model_for(opened.find(), display, style))
    except BaseException:  # a signal's exception, too
        opened.close()
        raise
    return opened


def _model_for(
    found: Display, display: Model | Display | None, style: BrailleStyle | None
) -> Model:
    """Model that a device which was found is read as."""
    if display is not None:
        check_actuators(found, display.display if isinstance(display, Model) else display)
    if style is not None:
        check_travel(found, style.geometry.travel_mm)
    shown = replace(display, display=found) if isinstance(display, Model) else found
    return read_as(shown, style)
