"""The device of a session: lines are put under the hand, and what the hand does is told."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vbraille.devices.registry import open_device
from vbraille.display import Display
from vbraille.engine.batch import BatchEngine
from vbraille.engine.engine import HOME_MM, EndOfLine
from vbraille.engine.host import Host
from vbraille.engine.record import Flag
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.shown import Shown
from vbraille.sessions.simulated.skin import FeltFrames
from vbraille.simulation.specs import device_spec, steering_of
from vbraille.simulation.steering import ReadLine

UNFELT = {
    Flag.SILENT: "the device is silent",
    Flag.MARK: "the device does not know where its carriage is",
    Flag.STOP: "the device does not know where its carriage is",
    Flag.HELD: "the array went to rest by itself",
    Flag.TURNED: "the array was turned too far",
}
_UNFELT = sum(map(int, UNFELT))


class Happening(NamedTuple):
    """Something that the hand or the device did: a kind of event, when, and its data."""

    kind: str
    time_s: float
    data: dict[str, Any]


class SessionDevice:
    """A device that a session runs on.

    Parameters
    ----------
    protocol
        Protocol of the session, which is for a certain display.
    spec, hand
        Spec of the device, and of the hand that moves a simulated one.
    seed
        Seed of the simulated hand.
    fast
        Whether a simulated device runs as fast as the machine can, and not in real time.
    line
        Number of the last showing in earlier runs.

    Attributes
    ----------
    felt : list of list of arrays
        Ticks of each stimulus of the open trial.
    ready : bool
        Whether a trial may begin: the device works, and the array is at the left.
    read : bool
        Whether the hand was at the end of the line and back.
    now_s : float
        Time of the newest tick.
    """

    by_key = False

    def __init__(
        self, protocol: Protocol, spec: str, hand: str, *, seed: int, fast: bool, line: int
    ) -> None:
        model = protocol.display_model
        self.wanted = model.on(model.style.geometry)
        self._steering = steering_of(spec)
        spec = device_spec(spec, hand, seed, self._steering)
        if fast:
            self.engine = BatchEngine(open_device(spec, self.wanted), self.wanted.rate_hz)
        else:
            inherited = [self._steering.descriptor] if self._steering else []
            room = model.style.room(self.wanted, 64)
            self.engine = Host(spec, self.wanted, room, pass_fds=inherited)
        self.line = line
        self.felt: list[list[NDArray[np.void]]] = []
        self.ready = self.read = False
        self.now_s = 0.0
        self._first_line = line + 1
        self._shown: Shown | None = None
        self._end: EndOfLine | None = None
        self._touched = self._faulty = False

    def start(self) -> None:
        """Open the device."""
        self.engine.start()
        self.engine.paused = True

    def close(self) -> None:
        """Bring the array to rest, and close the device."""
        self.engine.close()

    @property
    def display(self) -> Display:
        """Display that the device turned out to be."""
        return self.engine.display

    @property
    def span_mm(self) -> float:
        """Distance from the array's left column to its right one."""
        return self.wanted.span_mm

    def show(self, line: Shown, *, first: bool) -> None:
        """Put a line under the hand, as the next showing; the first of a trial, or another."""
        if first:
            self.felt = []
        self.felt.append([])
        self.line += 1
        self._shown, self._end = line, EndOfLine(self.span_mm, line.end_mm)
        self._touched = self._faulty = self.read = False
        self.engine.show(line.program, self.line)
        self.engine.paused = False
        if self._steering is not None:
            self._steering.give(ReadLine(line.end_mm))

    def rest(self) -> None:
        """Bring the array to rest at once."""
        self.engine.paused = True

    def go(self) -> None:
        """Let the line be felt again."""
        self.engine.paused = self._shown is None

    def withdraw(self) -> None:
        """Take the line away."""
        self.rest()
        self._shown = None

    def press(self) -> None:
        """Take Enter as the sign that the carriage is at its left stop, if that is awaited."""
        self.engine.set_zero()

    def explorations(self) -> list[FeltFrames]:
        """Return frames, places and times of each stimulus of the open trial."""
        together = (np.concatenate(parts) for parts in self.felt)
        return [FeltFrames(t["frame"], t["x_mm"], t["time_ns"] / 1e9) for t in together]

    def poll(self) -> tuple[NDArray[np.void], list[Happening]]:
        """Return the ticks since the last call, and what happened in them."""
        ticks = self.engine.poll()
        self.engine.take_events()
        if not ticks.size:
            return ticks, []
        self.now_s = int(ticks["time_ns"][-1]) / 1e9
        well = ticks["flags"] & _UNFELT == 0
        at_left = ticks["x_mm"] <= HOME_MM - self.span_mm / 2
        self.ready = bool(well[-1] and (well & at_left).any())
        if self._shown is None:
            return ticks, []
        own = (ticks["line"] == self.line) & (ticks["flags"] & int(Flag.PAUSED) == 0)
        return ticks, self._follow(ticks[own], self._shown)

    def _follow(self, ticks: NDArray[np.void], shown: Shown) -> list[Happening]:
        """Return contact, end of reading and fault, if they are in these ticks of the line."""
        if not ticks.size:
            return []
        self.felt[-1].append(ticks)
        found = []
        unfelt = np.flatnonzero(ticks["flags"] & _UNFELT)
        if unfelt.size and not self._faulty:
            self._faulty = True
            flags = int(ticks["flags"][unfelt[0]])
            why = next(words for flag, words in UNFELT.items() if flags & flag)
            found.append(_at("fault", ticks[unfelt[0]], what=why))
        if not self._touched and shown.edges_mm:
            on = np.flatnonzero(ticks["x_mm"] + self.span_mm / 2 >= shown.edges_mm[0])
            if on.size:
                self._touched = True
                found.append(_at("contact", ticks[on[0]]))
        assert self._end is not None, "a line is shown"
        if not self.read and self._is_done(ticks, self._end):
            self.read = True
            found.append(_at("read", ticks[-1]))
        return found

    def _is_done(self, ticks: NDArray[np.void], end: EndOfLine) -> bool:
        back = end.find(ticks["x_mm"]) is not None
        newest_ns = int(ticks["device_ns"][-1])
        return back or (self._steering is not None and self._steering.done_at(newest_ns))


def _at(kind: str, tick: np.void, **data: Any) -> Happening:
    return Happening(kind, int(tick["time_ns"]) / 1e9, {"tick": int(tick["tick"]), **data})
