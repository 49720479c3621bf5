"""The device of a session: stimuli are put under the hand, and what the hand does is told.

All that a session calls of engines and devices stands here.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import replace
from mmap import mmap
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vbraille.devices.events import Button, Event, HandHeld, Knob, Placing, placing_sentence, told
from vbraille.devices.registry import TRAVEL_TOLERANCE_MM, find_driver, open_device
from vbraille.display import Display
from vbraille.engine.batch import BatchEngine
from vbraille.engine.engine import HOME_MM, EndOfLine, Upright, placing_of
from vbraille.engine.host import Host
from vbraille.engine.mailbox import watch
from vbraille.engine.record import Flag, RingReader
from vbraille.errors import InputError
from vbraille.live.messages import LetGo, Point
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.shown import Shown, make_shown
from vbraille.sessions.simulated.skin import FeltFrames
from vbraille.simulation.specs import device_spec, steering_of
from vbraille.simulation.steering import BeAt, Pointer, ReadLine, ReadPage

# Makes the engine that drives a device, from the device's spec and the display that is wanted.
MakeEngine = Callable[[str, Display], Any]

UNFELT = {
    Flag.SILENT: "the device is silent",
    Flag.MARK: "the device does not know where its carriage is",
    Flag.STOP: "the device does not know where its carriage is",
    Flag.HELD: "the array went to rest by itself",
    Flag.RESTED: "the array went to rest by itself",
    Flag.TURNED: "the array was turned too far",
}
# Plain numbers: numpy, when it reads an enumeration, can swallow an exception of a signal.
_UNFELT = sum(map(int, UNFELT))
_AWAY = _UNFELT & ~int(Flag.RESTED)
_WHY_HELD = int(Flag.HELD | Flag.RESTED | Flag.SILENT)
_PAUSED, _RESTING, _HELD = int(Flag.PAUSED), int(Flag.RESTING), int(Flag.HELD)
_WAKING_NS = 100_000_000  # a device that rested with the hand may take so long to take frames again
_TOLD_S = 1.0  # from one fault that is told of a trial to the next
_SCAN_MM = 10.0  # between the lines that a simulated hand goes along over a picture


class Happening(NamedTuple):
    """Something that the hand or the device did.

    Parameters
    ----------
    kind, time_s, data
        Kind of the event, when it was by the session's clock, and what else the record has.
    said
        Sentence for the experimenter; empty for none.
    """

    kind: str
    time_s: float
    data: dict[str, Any]
    said: str = ""


class SessionDevice:
    """A device that a session runs on.

    Parameters
    ----------
    protocol, plan
        What is shown.
    spec, hand
        Spec of the device, and of the hand that moves a simulated one.
    seed
        Seed of the simulated hand.
    fast
        Whether a simulated device runs as fast as the machine can, and not in real time.
    rate_hz
        Frames per second.
    line
        Number of the last showing in earlier runs.
    keeps
        Whether frames are kept for a simulated reader.
    by_hand
        Whether the hand's way to the end and back ends reading, and not a key alone.
    make_engine
        Function that makes another engine than the usual one.
    watched
        Function that is given a reader of the ticks at each start, for a live view, whose pages may
        be the hand of a simulated device; None without one.

    Attributes
    ----------
    ready : bool
        Whether a trial may begin: the device works, and the array is at the left.
    read, ended, reached : bool
        Whether the stimulus was read; whether a key or the time ended that; whether the hand has
        been at its end.
    newest : record or None
        The newest tick.
    """

    by_key = False
    why = ""

    def __init__(
        self,
        protocol: Protocol,
        plan: Plan,
        spec: str,
        hand: str,
        *,
        seed: int,
        fast: bool,
        rate_hz: float,
        line: int,
        keeps: bool,
        by_hand: bool,
        make_engine: MakeEngine | None = None,
        watched: Callable[[RingReader], None] | None = None,
    ) -> None:
        self.wanted = replace(protocol.wanted, rate_hz=rate_hz)
        self.span_mm = self.wanted.span_mm
        self.line = line
        self.ready = self.read = self.ended = False
        self.newest: np.void | None = None
        self._real = not fast
        self._keeps, self._by_hand = keeps, by_hand
        self._button = protocol.trial.button
        self._steering = steering_of(spec)
        self._pointer = Pointer() if watched is not None and self._steering is not None else None
        spec = device_spec(spec, hand, seed, self._steering, self._pointer)
        if make_engine is not None:
            self.engine = make_engine(spec, self.wanted)
        elif fast:
            self.engine = BatchEngine(open_device(spec, self.wanted), self.wanted.rate_hz)
        else:
            find_driver(spec)
            channels = [each for each in (self._steering, self._pointer) if each is not None]
            descriptors = [each.descriptor for each in channels]
            self.engine = Host(spec, self.wanted, _room(protocol, plan), pass_fds=descriptors)
            if watched is not None:
                self.engine.on_share = lambda descriptor, extent: watched(
                    watch(memoryview(mmap(descriptor, extent.total_bytes)), extent)[1]
                )
        self._felt: list[list[NDArray[np.void]]] = []
        self._shown: Shown | None = None
        self._first_line = self._trial_line = line + 1
        self._shown_s = 0.0
        self._end: EndOfLine | None = None
        self._touched = False
        self._watch = FaultWatch()
        self._placing = Placing.DONE
        self._upright = Upright()
        self._controls: list[Button | Knob] = []

    def start(self) -> None:
        """Open the device, and wait for its first tick; again after the engine died."""
        self.engine.start()
        self.engine.paused = True
        self.newest = self._shown = None
        self._watch = FaultWatch()

    def close(self) -> None:
        """Bring the array to rest, and close the device."""
        self.engine.close()

    @property
    def display(self) -> Display:
        """Display that the device turned out to be."""
        return self.engine.display

    @property
    def steered(self) -> bool:
        """Tell whether a page of the live view may be the hand."""
        return self._pointer is not None

    def lead(self, asked: Point | LetGo) -> None:
        """Hold the simulated hand at a place, or let it go."""
        if self._pointer is None:
            return
        if isinstance(asked, Point):
            self._pointer.hold(BeAt(asked.x_mm, asked.y_mm, asked.theta_rad))
        else:
            self._pointer.let_go()

    @property
    def now_s(self) -> float:
        """Time of the session's clock: the machine's, or that of a device that runs fast."""
        if self._real:
            return time.monotonic()
        return 0.0 if self.newest is None else int(self.newest["time_ns"]) / 1e9

    @property
    def reached(self) -> bool:
        """True if the hand has been at the end of the stimulus; a picture has none."""
        return self.read or self._end is None or self._end.reached

    def show(self, shown: Shown, *, first: bool = True, turned: bool = False) -> None:
        """Put a stimulus under the hand as the next showing.

        Parameters
        ----------
        shown
            The stimulus.
        first
            Whether it is the first of a trial.
        turned
            Whether it takes the place of the last one, at another value.
        """
        if first:
            self._felt = []
            self._watch = FaultWatch()
            self._trial_line = self.line + 1
        self._felt.append([])
        self.line += 1
        self._first_line, self._shown_s = self.line, self.now_s
        self._shown = shown
        self._end = None if shown.end_mm is None else EndOfLine(self.span_mm, shown.end_mm)
        self._touched = self.read = self.ended = False
        self.engine.show(shown.program, self.line)
        self.engine.paused = False
        if self._steering is None:
            return
        if shown.canvas_mm is not None:
            width_mm, height_mm = shown.canvas_mm
            lines = max(1, round(height_mm / _SCAN_MM))
            self._steering.give(ReadPage(lines, height_mm / lines, width_mm))
        elif shown.end_mm is not None:
            self._steering.give(ReadLine(shown.end_mm))

    def rest(self) -> None:
        """Bring the array to rest."""
        self.engine.paused = True

    def go(self) -> None:
        """Let the stimulus be felt again after a rest, unless its reading was ended."""
        self.engine.paused = self._shown is None or self.ended

    def end_reading(self) -> None:
        """Bring the array to rest, since a key or the time has ended reading."""
        self.read = self.ended = True
        self.rest()

    def withdraw(self) -> None:
        """Take the stimulus away."""
        self.rest()
        self._shown = None

    def confirm(self) -> bool:
        """Take Enter as the sign that the carriage is at its left stop; False if it is not that."""
        if self._placing is not Placing.STOP:
            return False
        self.engine.set_zero()
        return True

    def explorations(self) -> list[FeltFrames]:
        """Return frames, places and times of each stimulus of the open trial."""
        together = (np.concatenate(parts) for parts in self._felt)
        return [
            FeltFrames(t["frame"], t["x_mm"], t["time_ns"] / 1e9, t["y_mm"], t["theta_rad"])
            for t in together
        ]

    def take_controls(self) -> list[Button | Knob]:
        """Return presses and turns since the last call, while a stimulus was shown."""
        controls, self._controls = self._controls, []
        return controls

    def poll(self) -> tuple[NDArray[np.void], list[Happening]]:
        """Return the ticks since the last call, and what happened in them.

        Raises
        ------
        HostDiedError
            If the engine has ended; `start` begins it again.
        DeviceError
            If the device has failed.
        """
        ticks, events = self.engine.poll(), self.engine.take_events()
        found = [self._reported(sentence) for sentence in told(events)]
        found += [
            Happening("hand", self.now_s, {"held": event.held})
            for event in events
            if isinstance(event, HandHeld)
        ]
        if ticks.size:
            before = ticks["tick"][0] - 1 if self.newest is None else self.newest["tick"]
            lost = np.diff(ticks["tick"], prepend=before) != 1
            self.newest = ticks[-1]
            found += map(self._reported, self._say_place(ticks[-1]))
            well = ticks["flags"] & _AWAY == 0
            at_left = ticks["x_mm"] <= HOME_MM - self.span_mm / 2
            anywhere = self._shown is not None and self._shown.canvas_mm is not None
            self.ready = bool(well[-1] and (anywhere | (at_left & well)).any())
            if self._shown is not None:
                found += self._follow(ticks, lost, self._shown)
        return ticks, found + self._pressed(events)

    def _reported(self, sentence: str) -> Happening:
        return Happening("device", self.now_s, {"what": sentence}, sentence)

    def _say_place(self, tick: np.void) -> Iterable[str]:
        placing = placing_of(tick)
        if placing is not self._placing:
            self._placing = placing
            yield placing_sentence(placing, self.display, press="press Enter")
        yield from self._upright.watch(tick)

    def _follow(
        self, ticks: NDArray[np.void], lost: NDArray[np.bool_], shown: Shown
    ) -> list[Happening]:
        """Return contact, end of reading and faults, if they are in these ticks."""
        felt = ticks["flags"] & _PAUSED == 0
        of_trial = felt & (ticks["line"] >= self._trial_line)
        found = self._watch.look(ticks[of_trial], lost[of_trial])
        ticks = ticks[felt & (ticks["line"] >= self._first_line)]
        if not ticks.size:
            return found
        if self._keeps:
            self._felt[-1].append(ticks)
        if not self._touched and shown.edges_mm:
            on = np.flatnonzero(ticks["x_mm"] + self.span_mm / 2 >= shown.edges_mm[0])
            if on.size:
                self._touched = True
                found.append(_at("contact", ticks[on[0]]))
        if not self.read and self._by_hand and self._is_back(ticks):
            self.read = True
            found.append(_at("read", ticks[-1]))
        return sorted(found, key=lambda each: each.time_s)

    def _is_back(self, ticks: NDArray[np.void]) -> bool:
        """Tell whether the hand was at the end and back, or a simulated hand has done its way."""
        back = self._end is not None and self._end.find(ticks["x_mm"]) is not None
        newest_ns = int(ticks["device_ns"][-1])
        return back or (self._steering is not None and self._steering.done_at(newest_ns))

    def _pressed(self, events: Iterable[Event]) -> list[Happening]:
        """Return the press of the button that ends reading, and keep what else was pressed."""
        found = []
        for event in events if self._shown is not None else ():
            if isinstance(event, Knob):
                self._controls.append(event)
            elif isinstance(event, Button) and event.pressed:
                if event.number != self._button:
                    self._controls.append(event)
                elif not self.ended:
                    at_s = self.now_s if event.at_ns is None else event.at_ns / 1e9
                    # A press from before the stimulus came is told now, and counts from now on.
                    at_s = at_s if at_s > self._shown_s else self.now_s
                    found.append(Happening("ended", at_s, {"by": f"button:{event.number}"}))
        return found


class FaultWatch:
    """Watches the ticks of a trial for those in which it could not be felt.

    A tick is faulty if the device was silent, did not know its place, had gone to rest by itself or
    took no frames, if its array was turned too far, or if ticks before it were lost. It is no fault
    that the array rests while the hand stands still, nor that the device then takes a moment to
    wake.
    """

    def __init__(self) -> None:
        self._away = self._still = False
        self._waking_ns = -_WAKING_NS
        self._told_s = -_TOLD_S

    def look(self, ticks: NDArray[np.void], lost: NDArray[np.bool_]) -> list[Happening]:
        """Return the fault that begins in these ticks, and its end."""
        if not ticks.size:
            return []
        unfelt = (ticks["flags"] & _UNFELT != 0) & ~self._wakes(ticks) | lost
        at = np.flatnonzero(unfelt)
        found = []
        if at.size and not self._away:
            tick = ticks[at[0]]
            flags = int(tick["flags"])
            why = next((words for flag, words in UNFELT.items() if flags & flag), "ticks were lost")
            fault = _at("fault", tick, what=why)
            if fault.time_s - self._told_s < _TOLD_S:
                return []
            self._away, self._told_s = True, fault.time_s
            found.append(fault)
        if self._away and not unfelt[-1]:
            self._away = False
            found.append(_at("well", ticks[at[-1] + 1 if at.size else 0]))
        return found

    def _wakes(self, ticks: NDArray[np.void]) -> NDArray[np.bool_]:
        """Mark ticks at which the device still wakes after the hand stood still."""
        wakes = np.zeros(ticks.size, np.bool_)
        if not (ticks["flags"] & _HELD).any():
            self._still = bool(ticks["flags"][-1] & _RESTING)
            return wakes
        for n, flags in enumerate(ticks["flags"].tolist()):
            held = flags & _WHY_HELD == _HELD
            if held:
                time_ns = int(ticks["time_ns"][n])
                if self._still:
                    self._waking_ns = time_ns
                wakes[n] = time_ns - self._waking_ns < _WAKING_NS
            self._still = bool(flags & _RESTING) and not held
        return wakes


def check_room(protocol: Protocol, plan: Plan, display: Display) -> None:
    """Check that the carriage is long enough for all that a plan shows.

    Raises
    ------
    InputError
        If it is too short, or goes along a line where pictures are shown.
    """
    for shown in _all_shown(protocol, plan):
        if shown.canvas_mm is not None and not display.height_mm:
            raise InputError(
                f"{protocol.name} shows pictures, and the carriage of {display.name} goes along x "
                f"only; choose another --device"
            )
        if shown.canvas_mm is not None:
            needed_mm = shown.canvas_mm[0]
        else:
            needed_mm = (shown.end_mm or 0.0) + display.span_mm
        if needed_mm > display.travel_mm + TRAVEL_TOLERANCE_MM:
            raise InputError(
                f"the carriage of {display.name} travels {display.travel_mm:g} mm, and "
                f"{protocol.name} needs {needed_mm:.1f} mm; choose another --device"
            )


def _room(protocol: Protocol, plan: Plan) -> int:
    """Return the bytes of the largest program of a plan."""
    return max(shown.program.nbytes for shown in _all_shown(protocol, plan))


def _all_shown(protocol: Protocol, plan: Plan) -> Iterable[Shown]:
    """Return the longest line and each picture of a plan, compiled."""
    stimuli = [s for trial in plan.trials for s in trial.stimuli if s.on == "device"]
    pictures = {(s.look.scene, s.picture): s for s in stimuli if s.picture}
    lead = protocol.display.lead_cells
    lines = [s for s in stimuli if not s.picture]
    longest = {repr(s.look): s for s in sorted(lines, key=lambda s: len(s.masks(lead)))}
    return [make_shown(protocol, s) for s in (*pictures.values(), *longest.values())]


def _at(kind: str, tick: np.void, **data: Any) -> Happening:
    return Happening(kind, int(tick["time_ns"]) / 1e9, {"tick": int(tick["tick"]), **data})
