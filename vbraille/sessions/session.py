"""A session from its plan to its table: it is created, run, resumed, and read as rows."""

from __future__ import annotations

import secrets
from collections.abc import Callable, Mapping
from contextlib import ExitStack, closing
from datetime import UTC, datetime
from difflib import get_close_matches
from importlib.metadata import version
from pathlib import Path
from platform import python_version
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from msgspec import Meta, Struct, ValidationError, convert, structs

from vbraille.errors import InputError
from vbraille.names import likeness
from vbraille.sessions.planning.loading import load_protocol
from vbraille.sessions.planning.plan import Plan, make_plan
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.values import Look
from vbraille.sessions.record import record
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.record import Content, Record
from vbraille.simulation.specs import is_simulated
from vbraille.wording import setting

if TYPE_CHECKING:
    from vbraille.sessions.running.answers import Answers

Say = Callable[[str], None]
MOST_SESSIONS = 10_000  # of a participant with a protocol, in a folder
_MOST_DRAWN = 1_000_000  # a seed that is drawn is short enough to be written down by hand


def _nothing(*_: object) -> None:
    """Do nothing."""


class Conditions(Struct, frozen=True, kw_only=True):
    """Conditions of a run; the record keeps them, and the next run has the same.

    Parameters
    ----------
    device, hand
        Spec of the device, such as "serial:/dev/ttyACM0", and the hand of a simulated one.
    answers
        Source of the answers: "typed", "simulated:NOISE" or the name of a file.
    rate_hz
        Frames per second.
    fast
        Whether a simulated device runs as fast as the machine can.
    sound
        How the participant hears signals.
    markers
        Recorder that is sent markers: "lsl", "lsl:NAME", "serial:PORT" or "serial:PORT:BAUD".
    also
        Conventional display, such as "brlapi".
    """

    device: str = "sim"
    hand: str = "slow"
    answers: str = "typed"
    rate_hz: Annotated[float, Meta(ge=1, le=10_000)] = 1000.0
    fast: bool = False
    sound: Literal["auto", "tones", "bell", "none"] = "auto"
    markers: str = ""
    also: str = "brlapi"

    def changed(self, changes: Mapping[str, Any]) -> Conditions:
        """Return conditions with other values.

        Raises
        ------
        InputError
            If a value is out of range, or there is no such condition.
        """
        if changes.get("answers", self.answers) != self.answers:
            changes = {"fast": False, **changes}
        if unknown := set(changes) - set(self.__struct_fields__):
            raise InputError(f"unknown condition {min(unknown)!r}")
        try:
            return convert(structs.asdict(self) | dict(changes), Conditions)
        except ValidationError as error:
            raise InputError(f"conditions: {error}") from None


class Session:
    r"""A session, which is one file.

    Parameters
    ----------
    path
        File of the session.

    Examples
    --------
    Two trials, felt by a simulated reader on a simulated device as fast as the machine can:

    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> from vbraille import Session
    >>> folder = Path(mkdtemp())
    >>> _ = Path(folder, "two.toml").write_text(
    ...     'name = "two"\ntitle = "Two"\nmodel = "vbd"\n'
    ...     '[design]\nkind = "combinations"\ncharacters = ["a", "c"]\nlength = 1\n'
    ... )
    >>> session = Session.create(folder / "two.toml", "P01", path=folder / "P01.session", seed=1)
    >>> _ = session.run("simulated", fast=True, hand="sweep:150")
    >>> [row["answered"] == row["presented"] for row in session.trials]
    [True, True]
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)

    @classmethod
    def create(
        cls,
        protocol: str | Path,
        participant: str,
        *,
        path: str | Path | None = None,
        seed: int | None = None,
        order: int | None = None,
        group: str | None = None,
        session: int | None = None,
        best_from: str | Path | None = None,
        fields: Mapping[str, str] | None = None,
    ) -> Self:
        """Plan a session, and write its file.

        Parameters
        ----------
        protocol
            Name of a protocol that comes with the program, or a TOML file.
        participant
            Pseudonym of the participant.
        path
            New file; PARTICIPANT-PROTOCOL.session, with a number if that is there, by default.
        seed
            Number that all random choices follow from; drawn by default.
        order, group, session
            These are described at `make_plan`; the number of the session is found by default.
        best_from
            Session of the participant that tells the best texture.
        fields
            Answers to the protocol's questions about the participant, by their names.

        Raises
        ------
        InputError
            If an argument cannot be used.
        RecordError
            If the file is there already, or cannot be written.
        """
        loaded = load_protocol(str(protocol))
        path = free_path(participant, loaded.name) if path is None else Path(path)
        number = session or next_number(path, participant)
        chosen = {"order": order, "group": group}
        loaded, plan = plan_session(loaded, participant, seed, number, best_from, **chosen)
        head = {
            "protocol": loaded.name,
            "participant": participant,
            "seed": plan.seed,
            "order": plan.order,
            "group": plan.group,
            "session": plan.session,
            "fields": check_fields(loaded, fields or {}),
            "made": f"{datetime.now(UTC):%Y-%m-%dT%H:%M:%SZ}",
        }
        record.create(path, head, loaded.files, plan)
        return cls(path)

    @property
    def content(self) -> Content:
        """Content of the file: its head, plan and events."""
        return record.read(self.path)

    @property
    def last_conditions(self) -> Conditions:
        """Conditions of the last run."""
        return _conditions_now(self.content, {})

    @property
    def trials(self) -> list[dict[str, Any]]:
        """A row for each planned trial, as `vbraille session export` writes them."""
        from vbraille.sessions.record.trials import rows  # loads compiled code

        return rows(self.path)

    def run(
        self,
        answers: Any = None,
        *,
        say: Say = _nothing,
        monitor: tuple[str | None, int | None] | None = None,
        before_rest: Callable[[], None] = _nothing,
        **changed: Any,
    ) -> Self:
        """Run the session from where it is: from its start, or from where it was stopped or killed.

        Parameters
        ----------
        answers
            Source of the answers: a spec as in `Conditions`, a source, the lines themselves, or a
            function that returns the line for a trial; by default that of the last run.
        say
            Function that is called with each sentence for the experimenter.
        monitor
            Host and port of a live view; None for no live view.
        before_rest
            Function that is called before the device is closed, which nothing may interrupt.
        changed
            Fields of the `Conditions` that differ from those of the last run.

        Raises
        ------
        InputError
            If the session has ended, or an argument cannot be used.
        VbrailleError
            If the device or the disk fails.
        """
        if isinstance(answers, str):
            changed["answers"] = answers
        from vbraille.sessions.record.trials import protocol_of  # loads compiled code

        with closing(Record(self.path)) as opened:
            content = opened.read()
            protocol = protocol_of(content)
            progress = Progress(protocol, content.plan, content.events)
            if progress.ended:
                raise InputError(f"{self.path} has ended; session export makes a table of it")
            conditions = _conditions_now(content, changed)
            source = _open_answers(answers, conditions, progress)
            conditions = structs.replace(conditions, answers=source.name)
            if progress.runs:
                known = f"device {conditions.device}, answers {conditions.answers}"
                say(f"resume: {known}; {progress.done} trials have answers")
                if datetime.fromisoformat(content.events[-1].wall) > datetime.now(UTC):
                    back = "times of day go back in the record, t_s does not"
                    say(f"clock: set back since the last run; {back}")
            with ExitStack() as stack:
                _run(stack, opened, progress, conditions, source, say, monitor, before_rest)
            say(f"record: {opened.sum.hex()}")
        return self


def plan_session(
    protocol: str | Path | Protocol,
    participant: str,
    seed: int | None = None,
    session: int | None = None,
    best_from: str | Path | None = None,
    **chosen: Any,
) -> tuple[Protocol, Plan]:
    """Plan a session; the arguments are those of `Session.create`.

    Returns
    -------
    Protocol, Plan
        The protocol as the participant's group has it, and the plan.
    """
    loaded = protocol if isinstance(protocol, Protocol) else load_protocol(str(protocol))
    seed = secrets.randbelow(_MOST_DRAWN) if seed is None else seed
    if best_from is not None:
        from vbraille.sessions.record.trials import best_level  # loads compiled code

        chosen["look"] = Look(texture=best_level(Path(best_from), "texture"))
    plan = make_plan(loaded, participant, seed, session=session or 1, **chosen)
    return loaded.of_group(plan.group), plan


def nearly_same(folder: Path, participant: str) -> str | None:
    """Return a pseudonym with sessions in a folder that differs in case, zeros or signs alone.

    None if there is no such pseudonym, or the participant has sessions there.
    """
    known = {record.participant_of(path) for path in folder.glob("*.session")} - {""}
    own = likeness(participant, person=True)
    alike = [each for each in sorted(known) if likeness(each, person=True) == own]
    return None if participant in known or not alike else alike[0]


def next_number(path: Path, participant: str) -> int:
    """Return the number of a participant's next session in the folder of a new file."""
    known = path.absolute().parent.glob("*.session")
    return 1 + sum(record.participant_of(each) == participant for each in known)


def free_path(participant: str, protocol: str) -> Path:
    """Return the name of a new session in this folder: P01-letters.session, or P01-letters-2."""
    endings = ("", *(f"-{number}" for number in range(2, MOST_SESSIONS)))
    paths = (Path(f"{participant}-{protocol}{ending}.session") for ending in endings)
    return next(path for path in paths if not path.exists())


def check_fields(protocol: Protocol, given: Mapping[str, str]) -> dict[str, str]:
    """Return the answers to the protocol's fields; those that were not given are empty.

    Raises
    ------
    InputError
        If there is no such field, or an answer is none of its choices.
    """
    known = {field.name: field for field in protocol.fields}
    for name, value in given.items():
        if name not in known:
            names = ", ".join(known) or "none"
            raise InputError(f"{protocol.name} has no field {name!r}; known: {names}")
        choices = known[name].choices
        if choices and value not in choices:
            raise InputError(f"{name} is {value!r}; give {' or '.join(choices)}")
        if not value.isprintable():
            raise InputError(f"{name} is {value!r}; give one line of text")
    return {name: given.get(name, "") for name in known}


def _conditions_now(content: Content, changed: Mapping[str, Any]) -> Conditions:
    """Return the conditions of the last run, with changes."""
    runs = [e.data["conditions"] for e in content.events if "conditions" in e.data]
    return (convert(runs[-1], Conditions) if runs else Conditions()).changed(changed)


def _open_answers(given: Any, conditions: Conditions, progress: Progress) -> Answers:
    """Return the source of the answers: that of a spec, lines, a function, or a source itself.

    Raises
    ------
    InputError
        If there is no such source, or it cannot be used with this session.
    """
    from vbraille.sessions.running.answers import Programmed, Scripted, Typed

    spec = conditions.answers if given is None or isinstance(given, str) else given
    kind, _, habits = spec.partition(":") if isinstance(spec, str) else ("", "", "")
    source: Answers
    if not isinstance(spec, str):
        source = spec if hasattr(spec, "line") else Programmed(spec)
    elif spec == "typed":
        source = Typed()
    elif spec == "program":
        raise InputError(f"the answers came from a program; give {setting('answers')} typed")
    elif kind == "simulated":
        from vbraille.sessions.running.reader import simulated_answers

        source = simulated_answers(progress.protocol, progress.plan, habits)
    elif Path(spec).exists():
        source = Scripted(Path(spec), progress.script_line)
    else:
        near = get_close_matches(kind, ("typed", "simulated"), 1)
        hint = f"did you mean {near[0]}?" if near else "give typed, simulated:NOISE or a file"
        raise InputError(f"there is no file {spec}; {hint}")
    if conditions.fast and isinstance(source, Typed):
        said = f"{setting('fast')} is for answers that are not typed"
        raise InputError(f"{said}; give {setting('answers')} simulated")
    if conditions.fast and not is_simulated(conditions.device):
        said = f"{setting('fast')} is for the simulated device"
        raise InputError(f"{said}; leave {setting('device')} out")
    return source


def _run(
    stack: ExitStack,
    opened: Record,
    progress: Progress,
    conditions: Conditions,
    source: Answers,
    say: Say,
    monitor: tuple[str | None, int | None] | None,
    before_rest: Callable[[], None],
) -> None:
    """Open the device and all that stands beside it, run a session, and close the device."""
    # Imported here: compiled code takes long to load, and not every use of a session needs it.
    from vbraille.sessions.running.device import SessionDevice, check_room
    from vbraille.sessions.running.markers import Markers
    from vbraille.sessions.running.pins import Pins
    from vbraille.sessions.running.presenter import Presenter
    from vbraille.sessions.running.reader import random_of
    from vbraille.sessions.running.runner import Runner

    protocol, plan = progress.protocol, progress.plan
    markers = Markers(conditions.markers, protocol.marker_codes, say)
    stack.callback(markers.close)
    told: dict[str, Any] = {"conditions": structs.asdict(conditions), "versions": _versions()}
    view = pins = None
    if monitor is not None:
        from vbraille.sessions.running.liveview import SessionView

        view = stack.enter_context(SessionView(protocol, *monitor, fast=conditions.fast, say=say))
        say, told["monitor"] = view.say, view.described
    if protocol.needs_pins and not source.felt and not conditions.fast:
        pins = Pins(protocol, plan, conditions.also)
        stack.callback(pins.close)
    device = Presenter()
    if protocol.medium == "device":
        # The simulated hand differs between participants and runs.
        drawn = f"{protocol.name} {plan.participant} {plan.seed} hand {progress.runs}"
        device = SessionDevice(
            protocol,
            conditions.device,
            conditions.hand,
            seed=int(random_of(drawn).integers(2**63)),
            fast=conditions.fast,
            rate_hz=conditions.rate_hz,
            line=progress.line,
            keeps=source.felt,
            by_hand=not source.typed or protocol.trial.end is None,
            watched=None if view is None else view.watch,
        )
    stack.callback(device.close)
    stack.callback(before_rest)
    device.start()
    if isinstance(device, SessionDevice):
        check_room(protocol, plan, device.display)
    if pins is not None:
        pins.start()
    if source.felt and protocol.shows_pictures and conditions.hand == "slow":
        hint = f"{setting('hand')} sweep:150 does"
        say(f"hand: a slow one comes to few pictures in their time; {hint}")
    runner = Runner(
        opened,
        progress,
        source,
        device,
        pins,
        real=not conditions.fast,
        say=say,
        play=_open_sound(conditions.sound, source, say),
        mark=markers.mark,
        look=_nothing if view is None else view.look,
    )
    over = runner.run(**told)
    before_rest()
    if closed := device.close():
        runner.log("closed", **closed)
    runner.finish(over)


def _open_sound(wanted: str, source: Answers, say: Say) -> Callable[[Any], None]:
    """Return what plays the participant's signals.

    Raises
    ------
    InputError
        If tones are asked for and there is no audio output.
    """
    from vbraille.sounds import Bell, Tones

    if wanted == "none" or (wanted == "auto" and not source.typed):
        return _nothing
    if wanted != "bell":
        try:
            return Tones().play
        except OSError as error:
            if wanted == "tones":
                raise InputError(f"{error}; give {setting('cues')} bell or none") from None
        say("sound: the terminal's bell, since there is no audio output")
    return Bell().play


def _versions() -> dict[str, str]:
    return {"vbraille": version("vbraille"), "python": python_version(), "numpy": version("numpy")}
