"""A device that is open to be read on: what is shown on it, where the hand is, what happens."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Self, Unpack

from vbraille.cli.old.reading.commands.table import BOUND
from vbraille.cli.old.reading.keys import TURNED, Context
from vbraille.cli.old.reading.lineviews import MOST_CELLS
from vbraille.cli.old.reading.outputs import Echo
from vbraille.cli.old.reading.reader import Reader
from vbraille.cli.old.reading.viewport import MOST_LINES
from vbraille.devices.base import Device, Placing
from vbraille.devices.events import Button, Knob, NotInTime, told
from vbraille.devices.registry import check_actuators, check_travel, find_driver
from vbraille.display import Pose, check_rate
from vbraille.engine.engine import placing_of
from vbraille.engine.host import Host
from vbraille.engine.record import Flag
from vbraille.errors import DeviceError, InputError
from vbraille.layout import cells_per_line, lay_out_text
from vbraille.render.braille.models import STRESS2, Model, check_shown, model_of
from vbraille.simulation.hand import Still
from vbraille.simulation.specs import (
    device_spec,
    has_hand,
    is_simulated,
    parse_hand,
    refuse_hand,
    steering_of,
)
from vbraille.translate import choose_table

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.cli.old.reading.view import View
    from vbraille.devices.events import Event
    from vbraille.display import Display
    from vbraille.engine.clock import Clock
    from vbraille.engine.record import Tally
    from vbraille.layout import Layout, Line
    from vbraille.render.braille.style import BrailleStyle, StyleChanges
    from vbraille.simulation.steering import Pointer, Steering

HAND = "sweep:60"
_POLL_S = 0.02
_AFTER_HOLD_NS = 500_000_000  # as long as speeds are smoothed, and longer
# A knob that no hand has turned for so long is left where it stands. Long enough for a hand that
# takes a new hold of it, and short enough to be an answer.
SETTLED_S = 0.3
_HELD = int(Flag.HELD)  # a plain number, as in `vbraille.cli.old.reading.reader`


class KnobTurns:
    """Changes by knobs of a device that were not said yet.

    A knob that is being turned tells its place fifty times a second. Each is shown at once; only
    the one at which the knob is left is said.
    """

    def __init__(self) -> None:
        self._unsaid: dict[int, tuple[float, str]] = {}

    def turn(self, reader: Reader, number: int, share: float, now_s: float) -> None:
        """Give the value of the tuning that a knob turns its place in the knob's range.

        Parameters
        ----------
        number
            Number of the knob, counted from 1.
        share
            Place of the knob, 0 to 1.
        now_s
            Time by a clock that does not go back.
        """
        name = reader.bound.knobs.get(number)
        said = ""
        if reader.context is Context.LEARNING:
            said = f"knob {number}: {'no value' if name is None else TURNED[name]}"
        elif name is not None:
            field, value = TURNED[name], round(share, 2)
            if getattr(reader.style.tuning, field) != value:
                reader.tune(**{field: value})
                said = f"{field}: {value:g}"
        if said:
            self._unsaid[number] = now_s + SETTLED_S, said

    def settle(self, reader: Reader, now_s: float) -> None:
        """Say what knobs have changed that were turned, and are not turned any more."""
        for number, (due_s, said) in tuple(self._unsaid.items()):
            if now_s >= due_s:
                del self._unsaid[number]
                reader.say(said)


class OpenDevice:
    """A device that a person reads on. A context manager; on exit the actuators fade to rest.

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
        Whether a person is at a keyboard, who can end a line that no hand ends.
    begun
        Host process that was begun for the device, and the steering of a simulated hand that it
        inherited, with the pointer if there is one; None to begin it now.
    pointer
        Where a person may hold the hand of a simulated device; None if no person can.
    on_share
        Function that is called with the memory that a host process shares; see `Host`.

    Attributes
    ----------
    attended : bool
        Whether a person is at a keyboard.
    engine : Host or LocalEngine
        Engine that drives the device, for callers that show pictures and not lines.
    placing : Placing
        What the device waits for before it knows where its carriage is; see `set_zero`.
    steering : Steering or None
        Channel of orders to the simulated hand; None if a person moves the device.
    pointer : Pointer or None
        Where a person may hold the simulated hand; None also if a person moves the device.
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
        begun: Any = None,
        pointer: Pointer | None = None,
        on_share: Any = None,
    ) -> None:
        self.placing = Placing.DONE
        self._wanted = wanted
        self._say = say
        self.attended = attended
        self._knobs = KnobTurns()
        self._device = device if isinstance(device, Device) else None
        self._closed = False
        self._simulated = isinstance(device, str) and is_simulated(device)
        # A hand that waits to be moved is right where a person moves the device itself.
        moves = isinstance(device, str) and has_hand(device)
        moved = parse_hand(hand, seed, pointed=pointer is not None or not moves)
        once = hand.startswith("recorded:")
        self.steering: Steering | None = None
        self.pointer: Pointer | None = None
        self._reader: Reader | None = None
        self._view: View | None = None  # the reader, or something else that is explored
        self._model: Model | None = None
        self._newest: np.void | None = None
        self._held_ns: int | None = None  # when a person held the simulated hand last
        if isinstance(device, Device):
            # Imported here, since it loads compiled code, which a host process loads by itself.
            from vbraille.engine.clock import RealClock
            from vbraille.engine.loop import LocalEngine
            from vbraille.simulation.recorded import Recorded
            from vbraille.simulation.simulated import SimulatedDevice

            rate_hz = min(wanted.rate_hz, device.display.rate_hz)
            if isinstance(device, SimulatedDevice):
                moved, self.steering, self.pointer = device.hand, device.steering, device.pointer
                once = isinstance(moved, Recorded)
            self.engine: Host | LocalEngine = LocalEngine(
                device,
                RealClock() if clock is None else clock,
                rate_hz=rate_hz,
                poll_ticks=max(1, round(_POLL_S * rate_hz)),
            )
        else:
            find_driver(device)  # before a process is begun for what is not there
            spawned, steering = begun or (None, steering_of(device))
            if has_hand(device):  # otherwise a person moves the device
                self.steering, self.pointer = steering, pointer
            channels = (self.steering, self.pointer)
            self.engine = Host(
                device_spec(device, hand, seed, self.steering, self.pointer),
                wanted,
                often=often,
                pass_fds=[each.descriptor for each in channels if each is not None],
                spawned=spawned,
            )
            self.engine.on_share = on_share
            if self._simulated:
                self.engine.launch()  # it loads while the text is laid out
        moved = moved if self.steering is not None else None
        self._once = once and moved is not None  # it reads no more than it has recorded
        self._still = isinstance(moved, Still)

    @property
    def held(self) -> bool:
        """Tell whether a person holds the simulated hand."""
        return self.pointer is not None and self.pointer.held

    @property
    def display(self) -> Display:
        """Display of the device."""
        return self.model.display

    @property
    def model(self) -> Model:
        """Display and style that lines are shown in."""
        if self._model is None:
            raise DeviceError("the device is not open; start it first")
        return self._model if self._reader is None else replace(self._model, style=self.style)

    @property
    def style(self) -> BrailleStyle:
        """Style that lines are shown in; `tune` changes it."""
        if self._reader is not None:
            return self._reader.style
        return self.model.style

    @property
    def reader(self) -> Reader:
        """Reader of what is shown, who takes the commands of `vbraille read`."""
        if self._reader is None:
            raise DeviceError("nothing is shown; show a text first")
        return self._reader

    @property
    def line(self) -> Line | None:
        """Line under the hand; None before the first."""
        return None if self._reader is None else self._reader.line

    @property
    def done(self) -> bool:
        """Tell whether all that was shown has been read."""
        return self._reader is None or self._reader.done

    @property
    def x_mm(self) -> float | None:
        """Place of the array's centre along the line at the last poll; None if not known."""
        return self.engine.x_mm

    @property
    def pose(self) -> Pose | None:
        """Pose of the array at the last poll, by the device's clock; None if not known."""
        tick = self._newest
        if tick is None or self.engine.x_mm is None:
            return None
        x_mm, y_mm, theta_rad = (float(tick[name]) for name in ("x_mm", "y_mm", "theta_rad"))
        return Pose(int(tick["device_ns"]), x_mm, y_mm, theta_rad)

    @property
    def frame(self) -> NDArray[np.float32] | None:
        """Frame sent last, float32[rows, columns], 0 to 1; None before the first poll."""
        return None if self._newest is None else self._newest["frame"].copy()

    @property
    def paused(self) -> bool:
        """Tell whether the array rests; setting it has the array rest at once, or go on."""
        return self.engine.paused

    @paused.setter
    def paused(self, paused: bool) -> None:
        self.engine.paused = paused

    @property
    def tally(self) -> Tally:
        """Counts of what the loop has done so far, such as ticks and late ticks."""
        return self.engine.tally

    @property
    def counts(self) -> Mapping[str, int]:
        """Counts of what went wrong with the device, by name; known after `close`."""
        return self.engine.counts

    def find(self) -> Display:
        """Find out what the device is; a device other than the simulated one is opened for that.

        Raises
        ------
        VbrailleError
            If the device cannot be opened.
        """
        if self._simulated:
            return self._wanted
        return self.engine.open() if isinstance(self.engine, Host) else self.engine.display

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
        if isinstance(self.engine, Host):
            # Cells may come closer during reading.
            lines = MOST_LINES if model.display.height_mm else 1
            braille = model.style.room(model.display, MOST_CELLS, lines)
            self.engine.fit(model.display, max(room or 0, braille))
        self.engine.start()

    def start_again(self) -> None:
        """Drive the device again, after a `vbraille.engine.host.HostDiedError`."""
        self.placing = Placing.DONE
        self._closed = False
        self.engine.start()
        if self._view is not None:
            self._view.steer()

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
        **services: Any,
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
        services
            What works for the reader, such as search in the whole book, by the names that `Reader`
            has for it.

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
        services.setdefault("bound", BOUND)
        reader = Reader(
            text,
            self.engine,
            model=model,
            say=self._say,
            first=first,
            last=last,
            at=at,
            advance=advance,
            stay=self.attended,
            echo=echo,
            steering=self.steering,
            **services,
        )
        reader.start()
        self._view = self._reader = reader

    def explore(self, view: View) -> None:
        """Have a view under the hand that is no text; what keys and buttons mean is the view's."""
        self._view, self._reader = view, None

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
            If the device is gone, or a line cannot be read to its end and no person can help.
        """
        if wait_s and isinstance(self.engine, Host):
            time.sleep(wait_s)
        ticks = self.engine.poll()
        events = list(self.engine.take_events())
        # That its ticks may come late does not matter to a device that is not there.
        heard = [e for e in events if not (self.steering is not None and isinstance(e, NotInTime))]
        for sentence in told(heard):
            self._say(sentence)
        if ticks.size:
            self._newest = ticks[-1]
            self.placing = placing_of(ticks[-1])
            if self._reader is not None:
                self._step(self._reader, ticks)
            elif self._view is not None:
                self._view.step(ticks)
        self._take(events)
        return events

    def _take(self, events: list[Event]) -> None:
        """Have buttons and knobs of the device do what keys do."""
        view = self._view
        if view is None:
            return
        for event in events:
            if isinstance(event, Button) and event.pressed and self.placing is not Placing.STOP:
                view.listener().press_button(event.number)
            elif isinstance(event, Knob) and self._reader is not None:
                self._knobs.turn(self._reader, event.number, event.value, time.monotonic())
        if self._reader is not None:
            self._knobs.settle(self.reader, time.monotonic())

    def _step(self, reader: Reader, ticks: NDArray[np.void]) -> None:
        """Have the reader look at ticks, and help a simulated hand that cannot go on by itself."""
        shown = reader.under.shown
        reader.under.patient = self._is_patient(int(ticks["time_ns"][-1]))
        reader.step(ticks)
        if self.attended:
            return
        felt = not int(ticks["flags"][-1]) & _HELD
        done = felt and reader.under.steered_till(ticks[-1])
        if done and reader.under.shown == shown and not reader.done:
            # The hand was at the end of the line between two ticks, or its recording is over.
            if self._once:
                reader.quit()
            elif ticks["line"][-1] == reader.under.surface.number:
                reader.go_on()
        if reader.under.hopeless is not None:
            raise DeviceError(reader.under.hopeless)

    def _is_patient(self, now_ns: int) -> bool:
        """Tell whether a person decides what the hand does at a time.

        A still hand waits for a person, and one that was let go just now has not moved by itself.
        """
        if self.held:
            self._held_ns = now_ns
        held_of_late = self._held_ns is not None and now_ns - self._held_ns < _AFTER_HOLD_NS
        return self._still or held_of_late

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
        self.engine.set_zero()

    def close(self) -> None:
        """Bring the array to rest, then let the device go. Further calls do nothing."""
        self._closed = True
        if isinstance(self.engine, Host):
            self.engine.close()
        elif self._device is not None:
            device, self._device = self._device, None
            try:
                self.engine.close()
            finally:
                device.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


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
    ...         print(line.number, line.text.strip())
    1 Two lines of braille, read by
    2 a hand that sweeps over them
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
        found = opened.find()
        if asked is not None:
            check_actuators(found, asked)
        model = replace(display, display=found) if isinstance(display, Model) else model_of(found)
        if style is not None:
            check_travel(found, style.geometry.travel_mm)
            model = replace(model, style=style)
        else:
            geometry = replace(model.style.geometry, travel_mm=found.travel_mm)
            model = replace(model, style=model.style.replace(geometry=geometry))
        opened.start(model)
    except BaseException:  # a signal's exception, too
        opened.close()
        raise
    return opened
