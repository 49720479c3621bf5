"""The device of a session: stimuli are put under the hand, and what the hand does is told.

All that a session calls of engines and devices stands here.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import asdict, replace
from operator import add
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vbraille.devices import events
from vbraille.devices.events import Button, Knob, Placing
from vbraille.devices.registry import TRAVEL_TOLERANCE_MM, find_driver, open_device
from vbraille.display import Display
from vbraille.engine.batch import BatchEngine
from vbraille.engine.engine import placing_of
from vbraille.engine.host import Host
from vbraille.engine.record import Flag, RingReader
from vbraille.errors import InputError
from vbraille.sessions.planning.shown import Shown, make_shown, width_mm
from vbraille.sessions.planning.trial import Stimulus
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.running.answers import Answers
from vbraille.sessions.running.conditions import Conditions
from vbraille.sessions.running.presenter import Happening, Presenter
from vbraille.sessions.running.reader import random_of
from vbraille.sessions.simulated.observer import FeltFrames
from vbraille.simulation import steering
from vbraille.simulation.specs import device_spec, is_simulated
from vbraille.wording import setting

# A plain number: numpy, when it reads an enumeration, can swallow an exception of a signal.
_PAUSED = int(Flag.PAUSED)
_TOLD_S = 1.0  # from one fault that is told of a trial to the next
_SCAN_MM = 10.0  # between the lines that a simulated hand goes along over a picture


class SessionDevice(Presenter):
    """A device that a session runs on.

    Parameters
    ----------
    progress, conditions
        How far the session has come, with what it shows; and the conditions of the run.
    answers
        Source of the answers, for which frames may have to be kept. Where a person types, a key of
        the protocol ends reading, if it has one, and not the hand's way to the end and back.
    watched
        Function that is given a reader of the ticks at each start, for a live view, whose pages may
        be the hand of a simulated device.
    """

    by_key = False

    def __init__(
        self,
        progress: Progress,
        conditions: Conditions,
        answers: Answers,
        watched: Callable[[RingReader], None] | None,
    ) -> None:
        super().__init__()
        self._protocol, self._plan = protocol, plan = progress.protocol, progress.plan
        self.line = progress.line
        self._wanted = replace(protocol.wanted, rate_hz=conditions.rate_hz)
        self._real, self._keeps = not conditions.fast, answers.felt
        self._by_hand = not answers.typed or protocol.trial.end is None
        self._watched = watched
        self._is_simulated = is_simulated(conditions.device)
        # The simulated hand differs between participants and runs.
        drawn = f"{protocol.name} {plan.participant} {plan.seed} hand {progress.runs}"
        seed = int(random_of(drawn).integers(2**63))
        spec = device_spec(conditions.device, conditions.hand, seed)
        self.engine: BatchEngine | Host
        if conditions.fast:
            self.engine = BatchEngine(open_device(spec, self._wanted), conditions.rate_hz)
        else:
            find_driver(spec)
            self.engine = Host(spec, self._wanted)
        self._felt: list[list[NDArray[np.void]]] = []
        self._under: Shown | None = None  # the hand
        self._first_line = self.line + 1
        self._shown_s = self._told_s = 0.0
        self._touched = self._at_end = self._is_away = False
        self._placing = Placing.DONE
        self._controls: list[Button | Knob] = []

    @property
    def display(self) -> Display:
        """Display that the device turned out to be."""
        return self.engine.display

    @property
    def told(self) -> dict[str, Any]:
        """Description of it for the event of a run."""
        return {
            "display": asdict(self.display),
            "calibration": self.engine.calibration,
            "simulated": self._is_simulated,
        }

    @property
    def now_s(self) -> float:
        """Time of the session's clock: the machine's, or that of a device that runs fast."""
        if self._real:
            return time.monotonic()
        newest = self.engine.newest
        return 0.0 if newest is None else int(newest["time_ns"]) / 1e9

    @property
    def ready(self) -> bool:
        """True if the device works, and the array is at the left."""
        return self.engine.ready

    @property
    def reached(self) -> bool:
        """True if the hand has been at the end of the stimulus; a picture has none."""
        no_end = self._under is None or self._under.end_mm is None
        return self.read or no_end or self._at_end

    def start(self) -> None:
        """Open the device; again after the engine died.

        Raises
        ------
        InputError
            If its carriage is too short for what is shown, or goes along a line where pictures are.
        """
        self.engine.start()
        self.engine.paused = True
        self._under = None
        self._check_room()
        if self._watched is not None and isinstance(self.engine, Host):
            self._watched(self.engine.reader())

    def close(self) -> dict[str, Any]:
        """Bring the array to rest, and close the device."""
        self.engine.close()
        counts = {name: number for name, number in self.engine.counts.items() if number}
        return {"lost": self.engine.lost, "counts": counts}

    def prepare(self, stimulus: Stimulus) -> dict[str, Any]:
        """Compile a stimulus, and return the number of the next showing."""
        self._under = make_shown(self._protocol, stimulus)
        return {"line": self.line + 1}

    def show(self, *, first: bool, turned: bool) -> None:
        """Put what was prepared under the hand, as the next showing."""
        assert self._under is not None, "it is prepared"
        super().show(first=first, turned=turned)
        if first:
            self._felt = []
            self._told_s = -_TOLD_S
        self._felt.append([])
        self.line += 1
        if not turned:
            self._first_line = self.line
        self._shown_s = self.now_s
        self._touched = self._at_end = self._is_away = False
        end_mm, canvas_mm = self._under.end_mm, self._under.canvas_mm
        self.engine.show(self._under.program, self.line, end_mm)
        self.engine.paused = False
        if canvas_mm is not None:
            width_mm, height_mm = canvas_mm
            lines = max(1, round(height_mm / _SCAN_MM))
            self.engine.give(steering.ReadPage(lines, height_mm / lines, width_mm))
        elif end_mm is not None:
            self.engine.give(steering.ReadLine(end_mm))

    def rest(self) -> None:
        """Bring the array to rest."""
        self.engine.paused = True

    def go(self) -> None:
        """Let the stimulus be felt again after a rest, unless its reading was ended."""
        self.engine.paused = self._under is None or self.ended

    def withdraw(self) -> None:
        """Take the stimulus away."""
        self.rest()
        self._under = None

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
        ticks, given = self.engine.poll(), self.engine.take_events()
        told = events.told(given)
        placing = placing_of(ticks[-1]) if ticks.size else self._placing
        if placing is not self._placing:
            self._placing = placing
            told = [*told, events.placing_sentence(placing, self.display, press="press Enter")]
        found = [Happening("device", self.now_s, {"what": said}, said) for said in told]
        if ticks.size and self._under is not None:
            found += self._follow(ticks, self._under)
        for event in given:
            found += self._heard(event)
        return ticks, sorted(found, key=lambda each: each.time_s)

    def _check_room(self) -> None:
        protocol, display = self._protocol, self.display
        stimuli = {s for trial in self._plan.trials for s in trial.stimuli if s.on == "device"}
        if protocol.shows_pictures and not display.height_mm:
            raise InputError(
                f"{protocol.name} shows pictures, and the carriage of {display.name} goes along x "
                f"only; choose another {setting('device')}"
            )
        spans_mm = (0.0 if stimulus.picture else display.span_mm for stimulus in stimuli)
        widths_mm = (width_mm(protocol, stimulus) for stimulus in stimuli)
        needed_mm = max(map(add, widths_mm, spans_mm), default=0.0)
        if needed_mm > display.travel_mm + TRAVEL_TOLERANCE_MM:
            raise InputError(
                f"the carriage of {display.name} travels {display.travel_mm:g} mm, and "
                f"{protocol.name} needs {needed_mm:.1f} mm; choose another {setting('device')}"
            )

    def _follow(self, ticks: NDArray[np.void], shown: Shown) -> list[Happening]:
        """Keep what was felt, and return the first touch if it is in these ticks."""
        ticks = ticks[(ticks["flags"] & _PAUSED == 0) & (ticks["line"] >= self._first_line)]
        if not ticks.size:
            return []
        if self._keeps:
            self._felt[-1].append(ticks)
        if shown.end_mm is not None:
            self._at_end = self._at_end or bool((ticks["x_mm"] >= shown.end_mm).any())
        if self._touched or not shown.edges_mm:
            return []
        on = ticks[ticks["x_mm"] + self._wanted.span_mm / 2 >= shown.edges_mm[0]][:1]
        self._touched = bool(on.size)
        return [_at("contact", tick["tick"], tick["time_ns"]) for tick in on]

    def _heard(self, event: events.Event) -> list[Happening]:
        """Return what an event of the device or the engine is to the session."""
        if isinstance(event, events.HandHeld):
            return [Happening("hand", self.now_s, {"held": event.held})]
        if self._under is None:
            return []
        match event:
            case events.LineRead() if event.line == self.line and self._may_read:
                self.read = True
                return [_at("read", event.tick, event.time_ns)]
            case events.HandDone() if event.at_ns / 1e9 > self._shown_s and self._may_read:
                self.read = True
                return [Happening("read", event.at_ns / 1e9, {})]
            case events.Unfelt() if not self._is_away:
                fault = _at("fault", event.tick, event.time_ns, what=event.why)
                if fault.time_s - self._told_s >= _TOLD_S:
                    self._is_away, self._told_s = True, fault.time_s
                    return [fault]
            case events.FeltAgain() if self._is_away:
                self._is_away = False
                return [_at("well", event.tick, event.time_ns)]
            case Knob():
                self._controls.append(event)
            case Button(pressed=True) if event.number != self._protocol.trial.button:
                self._controls.append(event)
            case Button(pressed=True) if not self.ended:
                at_s = self.now_s if event.at_ns is None else event.at_ns / 1e9
                at_s = max(at_s, self._shown_s)  # of a press that is told late
                return [Happening("ended", at_s, {"by": f"button:{event.number}"})]
        return []

    @property
    def _may_read(self) -> bool:
        """Tell whether the hand's way to the end and back ends reading now."""
        return self._by_hand and not self.read


def _at(kind: str, tick: int, time_ns: int, **data: Any) -> Happening:
    return Happening(kind, int(time_ns) / 1e9, {"tick": int(tick), **data})
