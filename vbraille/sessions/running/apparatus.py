"""The apparatus of a run: engine, displays, responses and sounds, from the device to the record."""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vbraille.caching import compiling_note
from vbraille.devices.registry import TRAVEL_TOLERANCE_MM
from vbraille.engine.host import HostDiedError
from vbraille.errors import DeviceError, InputError
from vbraille.sessions.record import events
from vbraille.sessions.record.folder import Record, check_end
from vbraille.sessions.record.journal import NAME, Journal, sum_of, up_s
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.running.console import Console
from vbraille.sessions.running.presenters import OnDevice, RunEngine
from vbraille.sessions.running.runner import Runner
from vbraille.sounds import Bell, Silence, Tones
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.display import Display
    from vbraille.errors import VbrailleError
    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.record.events import JournalEvent
    from vbraille.sessions.running.conventional import OnConventional
    from vbraille.sessions.running.liveview import SessionView
    from vbraille.sessions.running.markers import Markers
    from vbraille.sessions.running.responses import Responses
    from vbraille.simulation.steering import Steering
    from vbraille.sounds import Sound


def _nothing() -> None:
    """Do nothing, where there is no live view."""


@dataclass(slots=True)
class Apparatus:
    """Apparatus of a run: the engine, the responses and the signals.

    Parameters
    ----------
    engine
        Engine that drives the device; None on paper. Its maker closes it after a fault.
    responses
        Source of the lines.
    steering
        Channel that tells the simulated hand what to read; None if a person's hand reads.
    sound
        Function that gives the sound device; it is called once the device is open.
    real
        Whether the session runs by the clock of the machine; else by that of the device.
    say, warn
        Functions that are called with sentences for the experimenter, and with sentences that
        should be kept apart from those.
    before_rest
        Function that is called just before the array is brought to rest.
    view
        Live view of the session; None without one.
    markers
        Sender of markers to another recorder; None without one.
    conventional
        Conventional display of the session; None without one.
    """

    engine: RunEngine | None
    responses: Responses
    steering: Steering | None
    sound: Callable[[], Sound]
    real: bool
    say: Callable[[str], None]
    warn: Callable[[str], None]
    before_rest: Callable[[], None]
    view: SessionView | None = None
    markers: Markers | None = None
    conventional: OnConventional | None = None
    _opened: bool = field(default=False, init=False)

    def open(self, protocol: Protocol, plan: Plan) -> None:
        """Start the engine, and wait until it and the displays are there, unless they are."""
        if self._opened:
            return
        self._opened = True
        if self.engine is not None:
            self._start(self.engine, protocol, plan)
        if self.conventional is not None:
            self.conventional.begin()

    def _start(self, engine: RunEngine, protocol: Protocol, plan: Plan) -> None:
        if (note := compiling_note()) is not None:
            self.warn(note)
        engine.start()
        check_room(engine.display, protocol, plan)

    def run(
        self, record: Record, known: Progress | None = None, *, why: str, spec: str, hand: str
    ) -> Progress:
        """Conduct the session until it ends or is stopped, and return how far it has come.

        Parameters
        ----------
        record
            Content of the session's directory.
        known
            Progress after the events of this record; None if it has to be found.
        why, spec, hand
            Fields of the run's event: why it began, spec of the device, and simulated hand.
        """
        with Journal(record.folder) as book:
            check_end(record.folder, book.contents)
            torn_bytes = book.set_torn_aside()
            self.open(record.protocol, record.plan)
            # Another console may have gone on with the session before its journal was locked.
            progress = known if book.contents.crcs == record.journal.crcs else None
            if progress is None:
                progress = Progress(record.plan, book.contents.events, record.procedure)
            device = self._device(record, book)
            sound = self.sound()
            runner = Runner(
                record.protocol,
                record.plan,
                book,
                progress,
                self.responses,
                device,
                say=self.say,
                play=sound.play,
                real=self.real,
                conventional=self.conventional,
            )
            if self.markers is not None:
                self.markers.begin(record.folder)
                runner.mark = self.markers.mark
            told = {"why": why, "torn_bytes": torn_bytes, "sound": sound.name}
            told |= self._since(book, progress)
            told |= {"spec": spec, "hand": hand, "answers": self.responses.name}
            if (view := self.view) is not None:
                told["monitor"] = view.described()
            practises = self.responses.typed or progress.begun
            fault: VbrailleError | None = None
            try:
                if not practises:
                    told["practice"] = "left out"
                runner.start(**told, clock="machine" if self.real else "manual")
                if not practises:
                    self.say("practice: left out, since answers are not typed")
                    runner.log(events.Begin)
                look = _nothing if view is None else partial(view.look, runner)
                runner.run(Console(runner, self.say).take, look)
            finally:
                self.before_rest()
                if device is not None:
                    try:
                        device.close()
                    except (DeviceError, HostDiedError) as error:
                        fault = error  # of a device that could not be let go
            if device is not None:
                counts = {name: count for name, count in device.engine.counts.items() if count}
                lost = device.engine.lost
                trace = device.close_trace()
                runner.log(events.Closed, lost=lost, counts=counts, **trace)
            self.say(f"record: {sum_of((record.folder / NAME).read_bytes())}")
        if fault is not None:
            raise fault
        return progress

    def _device(self, record: Record, book: Journal) -> OnDevice | None:
        """Make the presenter on the device; None on paper."""
        if self.engine is None:
            return None
        protocol = record.protocol
        return OnDevice(
            self.engine,
            protocol.model.display.span_mm,
            record.folder,
            button=protocol.trial.button,
            keeps=self.responses.felt,
            tie=lambda: book.durable,
            steering=self.steering,
            by_hand=not self.responses.typed or protocol.trial.end is None,
            anywhere=protocol.pictures,
        )

    def _since(self, book: Journal, progress: Progress) -> dict[str, Any]:
        """Fields of a run's event about the time since the last run, and a torn line it left."""
        told: dict[str, Any] = {"boot": _boot()}
        if torn := book.torn_file():
            told["torn_file"] = torn
        if progress.runs:
            same_start = bool(told["boot"]) and told["boot"] == progress.runs[-1].boot
            told |= _gap(book.contents.events[-1], same_start=same_start)
            self.say(f"resume: {progress.of_all(progress.done)} trials have answers")
        if book.contents.torn:
            self.say(
                f"torn: {len(book.contents.torn)} bytes at the end of the journal are in "
                f"journal.torn"
            )
        return told


def _boot() -> str:
    """Identifier of this machine's last start; empty if the system does not tell it."""
    try:
        return Path("/proc/sys/kernel/random/boot_id").read_text().strip()
    except OSError:
        return ""


def _gap(last: JournalEvent, *, same_start: bool) -> dict[str, Any]:
    """Fields of a run's event for the time since the last event, by the clock that can tell it."""
    if same_start and last.up_s is not None:
        return {"gap_s": round(up_s() - last.up_s, 3), "gap_by": "machine"}
    gap_s = (datetime.now(UTC) - datetime.fromisoformat(last.wall)).total_seconds()
    return {"gap_by": "wall"} if gap_s < 0 else {"gap_s": round(gap_s, 3), "gap_by": "wall"}


def make_sound(wanted: str, responses: Responses, say: Callable[[str], None]) -> Sound:
    """Make the sound device for "auto", "tones", "bell" or "none".

    Raises
    ------
    InputError
        If tones are asked for and there is no audio output.
    """
    if wanted == "none" or (wanted == "auto" and not responses.typed):
        return Silence()
    if wanted != "bell":
        try:
            return Tones()
        except OSError as error:
            if wanted == "tones":
                raise InputError(f"{error}; give {setting('sound')} bell, or none") from None
        say("sound: the terminal's bell, since there is no audio output")
    return Bell()


def check_room(info: Display, protocol: Protocol, plan: Plan) -> None:
    """Raise InputError if the device's carriage is too short for a stimulus of the plan."""
    for stimulus in plan.stimuli() if protocol.pictures else ():
        assert stimulus.picture is not None
        protocol.scene_of(stimulus).check(stimulus.picture, info)
        if not info.height_mm:
            raise InputError(
                f"{protocol.name} shows pictures, and the carriage of {info.name} goes along x "
                f"only; choose another {setting('device')}"
            )
    if protocol.pictures:
        return
    extent_mm = max(
        (
            stimulus.geometry.extent_mm(len(protocol.line(stimulus.masks)))
            for stimulus in plan.stimuli()
            if not stimulus.conventional
        ),
        default=0.0,
    )
    needed_mm = extent_mm + info.span_mm
    if needed_mm > info.travel_mm + TRAVEL_TOLERANCE_MM:
        raise InputError(
            f"the carriage of {info.name} goes {info.travel_mm:g} mm and the longest string of "
            f"{protocol.name} needs {needed_mm:.1f} mm; choose another {setting('device')} or "
            f"shorter strings"
        )
