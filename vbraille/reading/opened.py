"""A device that is open to be read on: what is shown on it, where the hand is, what happens."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Self, Unpack

from vbraille.devices.base import Device, Placing
from vbraille.devices.events import Button, Knob, NotInTime
from vbraille.devices.registry import find_driver
from vbraille.devices.saying import told
from vbraille.engine.engine import placing_of
from vbraille.engine.host import Host
from vbraille.engine.record import Flag
from vbraille.errors import DeviceError
from vbraille.layout.texts import cells_per_line, choose_table, lay_out_text
from vbraille.reading.asked import check_lines
from vbraille.reading.commands.table import press_button
from vbraille.reading.echo import Echo
from vbraille.reading.inuse import DeviceInUse
from vbraille.reading.knobturns import KnobTurns
from vbraille.reading.openhand import OpenHand
from vbraille.reading.reader import Reader
from vbraille.reading.surface import MOST_LINES
from vbraille.reading.underhand import MOST_CELLS
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.simulation.specs import (
    device_spec,
    has_hand,
    is_simulated,
    parse_hand,
    steering_of,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.display import Display
    from vbraille.engine.clock import Clock
    from vbraille.engine.shared import Extent
    from vbraille.engine.spawning import Spawned
    from vbraille.layout.pages import Layout, Line
    from vbraille.reading.beside import Beside
    from vbraille.render.braille.models import Model
    from vbraille.render.braille.style import StyleChanges
    from vbraille.simulation.pointing import Pointer
    from vbraille.simulation.steering import Steering

HAND = "sweep:60"
_POLL_S = 0.02
_HELD = int(Flag.HELD)  # a plain number, as in `vbraille.reading.reader`


class OpenDevice(DeviceInUse):
    """A device that somebody reads on. A context manager; on exit the actuators fade to rest.

    `vbraille.open` makes one that is ready to `show`. A program with an order of its own makes
    it of its parts: `find` the device, `start` it with a model, `show`.

    Parameters
    ----------
    device
        Spec of the device, which a process of its own then drives; or a device itself, which is
        driven here, as long as it is polled.
    wanted
        Display and rate that are asked for: a simulated device is made like this, a real device is
        what it is.
    often
        Whether a device of a spec must take frames at the rate that is asked for; otherwise it is
        sent them at its own rate where that is lower.
    hand, seed
        Hand that moves the simulated device, and seed of what is random in it.
    clock
        Clock for a device that was given itself; None for the machine's.
    say
        Function that is called with each thing that the reader should hear.
    attended
        Whether somebody is at a keyboard, who can end a line that no hand ends.
    begun
        Host process that was begun for the device, and the steering of a simulated hand that it
        inherited, with the pointer if there is one; None to begin it now.
    pointer
        Where somebody may hold the hand of a simulated device; None if nobody can.
    on_share
        Function that is called with the memory that a host process shares; see `Host`.

    Attributes
    ----------
    placing : Placing
        What the device waits for before it knows where its carriage is; see `set_zero`.
    """

    def __init__(
        self,
        device: str | Device,
        wanted: Display,
        *,
        often: bool = True,
        hand: str = HAND,
        seed: int = 1,
        clock: Clock | None = None,
        say: Callable[[str], None] = lambda _: None,
        attended: bool = False,
        begun: tuple[Spawned, Steering] | None = None,
        pointer: Pointer | None = None,
        on_share: Callable[[int, Extent], None] | None = None,
    ) -> None:
        self.placing = Placing.DONE
        self._wanted = wanted
        self._say = say
        self._attended = attended
        self._knobs = KnobTurns()
        self._device = device if isinstance(device, Device) else None
        self._closed = False
        self._simulated = isinstance(device, str) and is_simulated(device)
        moved = parse_hand(hand, seed, pointed=pointer is not None)
        if isinstance(device, Device):
            # Imported here, since it loads compiled code, which a host process loads by itself.
            from vbraille.engine.clock import RealClock
            from vbraille.engine.local import LocalEngine

            rate_hz = min(wanted.rate_hz, device.display.rate_hz)
            if isinstance(device, SimulatedDevice):
                self._hand = OpenHand(device.hand, device.steering, device.pointer)
            else:
                self._hand = OpenHand(None, None, None)
            self._engine = LocalEngine(
                device,
                RealClock() if clock is None else clock,
                rate_hz=rate_hz,
                poll_ticks=max(1, round(_POLL_S * rate_hz)),
            )
        else:
            find_driver(device)  # before a process is begun for what is not there
            spawned, steering = begun or (None, steering_of(device))
            if has_hand(device):
                self._hand = OpenHand(moved, steering, pointer)
            else:
                self._hand = OpenHand(None, None, None)  # a person moves the device
            self._engine = Host(
                device_spec(device, hand, seed, self._hand.steering, self._hand.pointer),
                wanted,
                often=often,
                pass_fds=self._hand.descriptors,
                spawned=spawned,
            )
            self._engine.on_share = on_share
            if self._simulated:
                self._engine.launch()  # it loads while the text is laid out

    def find(self) -> Display:
        """Find out what the device is; a device other than the simulated one is opened for that.

        Raises
        ------
        VbrailleError
            If the device cannot be opened.
        """
        if self._simulated:
            return self._wanted
        return self._engine.open() if isinstance(self._engine, Host) else self._engine.display

    def start(self, model: Model, room: int | None = None) -> None:
        """Drive the device, for lines that are shown in the style of a model.

        Parameters
        ----------
        model
            Display and style.
        room
            Bytes of the largest picture that is no braille; None if there is none.

        Raises
        ------
        VbrailleError
            If the device cannot be opened.
        """
        self._model = model
        if isinstance(self._engine, Host):
            # Cells may come closer while somebody reads.
            lines = MOST_LINES if model.display.height_mm else 1
            braille = model.style.room(model.display, MOST_CELLS, lines)
            self._engine.fit(model.display, max(room or 0, braille))
        self._engine.start()

    def start_again(self) -> None:
        """Drive the device again, after a `vbraille.engine.host.HostDiedError`."""
        self.placing = Placing.DONE
        self._closed = False
        self._engine.start()
        if self._reader is not None:
            self._reader.under.steer()

    def show(
        self,
        text: str | Layout,
        *,
        language: str | None = None,
        grade: int | None = None,
        table: str | None = None,
        keep_lines: bool = False,
        first: int = 1,
        last: int | None = None,
        at: int | None = None,
        advance: bool = True,
        echo: Echo = Echo.NONE,
        beside: Beside | None = None,
    ) -> None:
        """Put the first line of a text under the hand; the others come as it is polled.

        Parameters
        ----------
        text
            Text that is read, or a layout of it for this display.
        language, grade, table
            Language, grade or table of the translation, as for `vbraille.render_text`.
        keep_lines
            Whether each line of the text stays a line; otherwise paragraphs are filled.
        first, last
            Numbers of the first and last line to read, from 1; None for the end.
        at
            Place of the source at which to begin; None for the first line.
        advance
            Whether the next line comes when the hand returns; otherwise `reader` is told to go on.
        echo
            How much is said of each line.
        beside
            What works beside the reader, such as search in the whole book.

        Raises
        ------
        InputError
            If the text, or its table, cannot be used, or it has no such lines.
        DeviceError
            If the device is closed.
        """
        if self._closed:
            raise DeviceError("the device is closed; open it again")
        model = self.model
        if isinstance(text, str):
            width = cells_per_line(model.style.geometry, model.display)
            chosen = choose_table(language, grade, table)
            text = lay_out_text(text, width, chosen, keep_lines=keep_lines)
        if at is None:
            check_lines(text, first, last)
        self._reader = Reader(
            text,
            self._engine,
            model=model,
            say=self._say,
            first=first,
            last=last,
            at=at,
            advance=advance,
            stay=self._attended,
            echo=echo,
            steering=self._hand.steering,
            beside=beside,
        )
        self._reader.start()

    def read(self, text: str | Layout, **how: Any) -> Iterator[Line]:
        """Show a text, and give each line as it comes under the hand, until all are read.

        Parameters and errors are those of `show`, and errors also those of `poll`.
        """
        self.show(text, **how)
        given = 0
        while not self.done:
            line = self.line
            if line is not None and line.number != given:
                given = line.number
                yield line
            self.poll()

    def poll(self, wait_s: float = _POLL_S) -> list[Event]:
        """Let a moment go by, and give the device's events; see `vbraille.devices.events`.

        Lines go on by this. A device that was given itself needs it: poll it again and again.

        Parameters
        ----------
        wait_s
            Length of the moment; a device that was given itself has its own.

        Raises
        ------
        VbrailleError
            If the device is gone, or a line cannot be read to its end and nobody can help.
        """
        if wait_s and isinstance(self._engine, Host):
            time.sleep(wait_s)
        ticks = self._engine.poll()
        events = list(self._engine.take_events())
        # That its ticks may come late does not matter to a device that is not there.
        heard = [e for e in events if not (self.has_hand and isinstance(e, NotInTime))]
        for sentence in told(heard):
            self._say(sentence)
        if ticks.size:
            self._newest = ticks[-1]
            self.placing = placing_of(ticks[-1])
            if self._reader is not None:
                self._step(self._reader, ticks)
        self._take(events)
        return events

    def _take(self, events: list[Event]) -> None:
        """Have buttons and knobs of the device do what keys do."""
        for event in () if self._reader is None else events:
            if isinstance(event, Button) and event.pressed and self.placing is not Placing.STOP:
                press_button(self.reader.under.alone or self.reader, event.number)
            elif isinstance(event, Knob):
                self._knobs.turn(self.reader, event.number, event.value, time.monotonic())
        if self._reader is not None:
            self._knobs.settle(self.reader, time.monotonic())

    def _step(self, reader: Reader, ticks: NDArray[np.void]) -> None:
        """Have the reader look at ticks, and help a simulated hand that cannot go on by itself."""
        shown = reader.under.shown
        reader.under.patient = self._hand.patient(int(ticks["time_ns"][-1]))
        reader.step(ticks)
        if self._attended:
            return
        felt = not int(ticks["flags"][-1]) & _HELD
        done = felt and reader.under.steered_till(ticks[-1])
        if done and reader.under.shown == shown and not reader.done:
            # The hand was at the end of the line between two ticks, or its recording is over.
            if self._hand.once:
                reader.quit()
            elif ticks["line"][-1] == reader.under.number:
                reader.go_on()
        if reader.under.hopeless is not None:
            raise DeviceError(reader.under.hopeless)

    def tune(self, **turned: Unpack[StyleChanges]) -> None:
        """Show lines in a style of which some values differ from now on; see `Reader.tune`.

        Raises
        ------
        InputError
            If a value is out of range, or leaves no room for a cell.
        """
        if self._reader is not None:
            self._reader.tune(**turned)
        else:
            self._model = replace(self.model, style=self.style.replace(**turned))

    def set_zero(self) -> None:
        """Say that the carriage is at its left stop now, which `placing` may wait for."""
        self._engine.set_zero()

    def close(self) -> None:
        """Bring the array to rest, then let the device go. Further calls do nothing."""
        self._closed = True
        if isinstance(self._engine, Host):
            self._engine.close()
        elif self._device is not None:
            device, self._device = self._device, None
            try:
                self._engine.close()
            finally:
                device.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
