"""One sitting of a session: its engine, and what goes on around it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

from vbraille.cli.stopping import EAR
from vbraille.cli.wanted import TRAVEL_TOLERANCE_MM, device_spec, say_if_compiling, steering_of
from vbraille.devices import open_device
from vbraille.engine.host import Host
from vbraille.errors import InputError
from vbraille.sessions.record import events
from vbraille.sessions.record.clocks import Moment, boot, gap, say_moved
from vbraille.sessions.record.folder import check_end
from vbraille.sessions.record.journal import NAME, Journal, sum_of
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.running.answers import seed_of

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable

    from vbraille.display import Display
    from vbraille.sessions.planning.plan import Plan, Stimulus
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.record.folder import Record
    from vbraille.sessions.running.answers import Answers
    from vbraille.sessions.running.showing import RunEngine
    from vbraille.sessions.running.sounds import Sound


class Sitting:
    """One run of a session: its engine, and what goes on around it. A context manager."""

    def __init__(
        self,
        arguments: argparse.Namespace,
        protocol: Protocol,
        plan: Plan,
        runs: int,
        rate_hz: float,
        *,
        say: Callable[[str], None],
    ) -> None:
        self._arguments = arguments
        self._protocol = protocol
        self._plan = plan
        self._say = say
        self._real = not arguments.fast
        self._engine: RunEngine | None = None
        self._opened = False
        # Another hand for each participant, and each time that the session is gone on with.
        drawn = f"{plan.protocol} {plan.participant} {plan.seed} hand {runs}"
        self._steering = steering_of(arguments.device)
        spec = device_spec(arguments.device, arguments.hand, seed_of(drawn), self._steering)
        if arguments.fast and not spec.startswith("sim:"):
            raise InputError("--fast is for the simulated device; leave out --device")
        if protocol.medium == "device":
            wanted = protocol.model.on(protocol.geometry, rate_hz)
            if arguments.fast:
                from vbraille.engine.batch import BatchEngine

                self._engine = BatchEngine(open_device(spec, wanted), wanted.rate_hz)
            else:
                most = max(len(protocol.line(stimulus.masks)) for stimulus in _stimuli(plan))
                inherited = () if self._steering is None else (self._steering.descriptor,)
                room = protocol.model.style.room(wanted, most)
                self._engine = Host(spec, wanted, room, pass_fds=inherited)

    def check(self, answers: Answers) -> None:
        """Raise InputError if these answers cannot be had in this way."""
        if self._arguments.fast and answers.typed:
            raise InputError("--fast is for answers that are not typed; give --answers simulated")

    def open(self) -> None:
        """Wait until the engine runs, unless it does."""
        if self._engine is not None and not self._opened:
            say_if_compiling()
            self._engine.start()
            self._opened = True
            check_room(self._engine.display, self._protocol, self._plan)

    def run(self, record: Record, answers: Answers, *, why: str) -> int:
        """Conduct the session until its end, or until it is stopped."""
        # Here and not above: numba takes long to load, and the host starts meanwhile.
        from vbraille.sessions.running.console import Console
        from vbraille.sessions.running.course import Course
        from vbraille.sessions.running.showing import OnDevice

        with Journal(record.folder) as book:
            check_end(record.folder, book.told)
            torn_bytes = book.set_torn_aside()
            self.open()
            progress = Progress(record.plan, book.told.events)
            display = None
            if self._engine is not None:
                # A session of format 1 is gone on with in that, whose traces are not tied.
                tie = None if book.told.format == 1 else lambda: book.durable
                display = OnDevice(
                    self._engine,
                    record.protocol,
                    record.folder,
                    keeps=answers.felt,
                    tie=tie,
                    steering=self._steering,
                    centred=record.centred,
                )
            sound = self._sound(answers)
            course = Course(
                record.protocol,
                record.plan,
                book,
                progress,
                display,
                waits=answers.typed,
                corrects=not answers.felt,
                say=self._say,
                play=sound.play,
                real=self._real,
            )
            told: dict[str, Any] = {"why": why, "torn_bytes": torn_bytes, "sound": sound.name}
            if book.told.format > 1:
                told["boot"] = boot()
            if torn := book.torn_file():
                told["torn_file"] = torn
            if progress.runs:
                told |= gap(Moment.of(book.told.events[-1], progress.runs[-1]), Moment.now())
                if (moved := say_moved(told)) is not None:
                    self._say(moved)
                self._say(
                    f"resume: {progress.done} of {len(record.plan.trials)} trials have answers"
                )
            if torn_bytes:
                self._say(f"torn: {torn_bytes} bytes at the end of the journal are in journal.torn")
            if not answers.typed and not progress.begun:
                told["practice"] = "left out"
            try:
                arguments = self._arguments
                course.start(
                    **told,
                    spec=arguments.device,
                    hand=arguments.hand,
                    answers=arguments.answers,
                    clock="machine" if self._real else "manual",
                )
                if "practice" in told:
                    self._say("practice: left out, since answers are not typed")
                    course.book.log(events.Begin)
                Console(course, answers, say=self._say, real=self._real).run()
            finally:
                EAR.close()  # so that the array goes to rest
                if display is not None:
                    display.close()
            if display is not None:
                counts = {name: count for name, count in display.engine.counts.items() if count}
                lost = display.engine.lost
                course.book.log(events.Closed, lost=lost, counts=counts, **display.close_trace())
            self._say(f"record: {sum_of((record.folder / NAME).read_bytes())}")
        return 0

    def _sound(self, answers: Answers) -> Sound:
        from vbraille.sessions.running.sounds import Bell, Silence, Tones

        wanted = self._arguments.sound
        if wanted == "none" or (wanted == "auto" and not answers.typed):
            return Silence()
        if wanted != "bell":
            try:
                return Tones()
            except OSError as error:
                if wanted == "tones":
                    raise InputError(f"{error}; give --sound bell, or none") from None
            self._say("sound: the terminal's bell, since there is no audio output")
        return Bell()

    def __enter__(self) -> Self:
        if isinstance(self._engine, Host):
            self._engine.launch()
        return self

    def __exit__(self, *_: object) -> None:
        if self._engine is not None:
            EAR.close()
            self._engine.close()


def check_room(info: Display, protocol: Protocol, plan: Plan) -> None:
    """Raise InputError if a device's carriage does not take its whole array over every stimulus."""
    extent_mm = max(
        stimulus.geometry.extent_mm(len(protocol.line(stimulus.masks)))
        for stimulus in _stimuli(plan)
    )
    needed_mm = extent_mm + info.span_mm
    if needed_mm > info.travel_mm + TRAVEL_TOLERANCE_MM:
        raise InputError(
            f"the carriage of {info.name} goes {info.travel_mm:g} mm and the longest string of "
            f"{protocol.name} needs {needed_mm:.1f} mm; choose another --device or shorter strings"
        )


def _stimuli(plan: Plan) -> list[Stimulus]:
    return [stimulus for trial in (*plan.practice, *plan.trials) for stimulus in trial.stimuli]
