"""A session from its plan to its record: it is created, run, resumed, and read as rows."""

from __future__ import annotations

import secrets
from dataclasses import asdict, replace
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from vbraille.devices import open_device
from vbraille.devices.registry import find_driver
from vbraille.engine.host import Host
from vbraille.errors import InputError, VbrailleError
from vbraille.files import check_free
from vbraille.sessions.conditions import USUAL, Conditions
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.nexttrial import procedure_of
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.protocolfiles import load_protocol
from vbraille.sessions.planning.spellings import made_by
from vbraille.sessions.planning.style import CONVENTIONAL
from vbraille.sessions.record import journal
from vbraille.sessions.record.folder import FORMAT, Record, create, load, versions
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.running.markers import Markers, parse_markers
from vbraille.sessions.running.reader import seed_of
from vbraille.sessions.running.sources import responses_of
from vbraille.simulation.specs import device_spec, has_hand, refuse_hand, steering_of
from vbraille.simulation.steering import Pointer
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from vbraille.display import Display
    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.running.conventional import OnConventional
    from vbraille.sessions.running.liveview import SessionView
    from vbraille.sessions.running.presenters import RunEngine
    from vbraille.sessions.running.responses import Responses
    from vbraille.sessions.running.sources import Source
    from vbraille.simulation.steering import Steering
    from vbraille.sounds import Sound

    Say = Callable[[str], None]
    # Makes the engine that drives a device, from the device's spec and the display that the
    # protocol is written for.
    MakeEngine = Callable[[str, Display], RunEngine]

_MOST_DRAWN = 1_000_000  # so that a seed that is drawn is short enough to be written down by hand


def plan_session(
    protocol: str | Path | Protocol,
    participant: str,
    seed: int | None = None,
    order: int | None = None,
    texture: float | None = None,
    contrast: float | None = None,
    group: str | None = None,
) -> tuple[Protocol, Plan]:
    """Make the protocol and the plan of a session; a seed is drawn if none is given.

    `Session.create` describes the arguments.
    """
    if not isinstance(protocol, Protocol):
        protocol = load_protocol(str(protocol))
    if seed is None:
        seed = secrets.randbelow(_MOST_DRAWN)
    plan = make_plan(
        protocol, participant, seed, order, group=group, texture=texture, contrast=contrast
    )
    return protocol.assigned(plan.group), plan


def told_fields(protocol: Protocol, given: Mapping[str, str]) -> dict[str, str]:
    """Answers to all of the protocol's questions about the participant; empty where none is given.

    Raises
    ------
    InputError
        If the protocol has no such question, or the answer is none of the question's choices.
    """
    names = [field.name for field in protocol.fields]
    for name in given:
        if name not in names:
            raise InputError(
                f"{protocol.name} does not ask for {name!r}; "
                f"it asks for {', '.join(names) or 'nothing'}"
            )
    for field in protocol.fields:
        value = given.get(field.name)
        if value is None:
            continue
        if field.choices and value not in field.choices:
            raise InputError(f"{field.name} is {value!r}; it must be {' or '.join(field.choices)}")
        if not value.isprintable():
            raise InputError(f"{field.name} is {value!r}; it must be one line of text")
    return {name: given.get(name, "") for name in names}


def head_of(
    protocol: Protocol,
    plan: Plan,
    fields: Mapping[str, str],
    conditions: Conditions,
) -> dict[str, Any]:
    """Content of session.json: who takes part, what is shown, and with which equipment.

    Parameters
    ----------
    protocol, plan, conditions
        What the session shows, in which order, and with which equipment.
    fields
        Answers to the protocol's questions about the participant.
    """
    display = protocol.model.display
    group = {"group": plan.group} if plan.group else {}
    also = {} if conditions.also is None else {"also": conditions.also}
    return {
        "format": FORMAT,
        "protocol": protocol.name,
        "participant": plan.participant,
        "seed": plan.seed,
        "order": plan.order,
        **group,
        "model": protocol.model.name,
        "array": {
            name: getattr(display, name)
            for name in ("rows", "columns", "column_pitch_mm", "row_pitch_mm")
        },
        "mapping": protocol.mapping.name,
        "geometry": asdict(protocol.geometry),
        "fields": dict(fields),
        "device": conditions.device,
        "hand": conditions.hand,
        "answers": conditions.answers,
        "fast": conditions.fast,
        "rate_hz": conditions.rate_hz,
        **also,
        "versions": versions() | (made_by() if protocol.written else {}),
    }


def _ignore(_sentence: str) -> None:
    """Ignore a sentence."""


def _nothing() -> None:
    """Do nothing, where no call was asked for before the array comes to rest."""


class Session:
    r"""A legibility session: `create` or `resume` it, `run` it, read its `trials`.

    Parameters
    ----------
    folder
        Directory that the session is kept in.
    protocol, plan
        What the session shows, and in which order.
    conditions
        What the session is run with, such as its device.
    progress
        How far the session has come.
    engine
        Function that makes the engine which drives the device; None for the engine that the
        conditions ask for.
    begun
        Host process of the usual engine that was begun beforehand, and the channel by which its
        simulated hand is moved; None to begin one when it is needed.

    Examples
    --------
    Two trials, felt by a simulated reader on a simulated device as fast as the machine can:

    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> from vbraille import Conditions, Session
    >>> folder = Path(mkdtemp())
    >>> _ = Path(folder, "two.toml").write_text(
    ...     'format = 1\nname = "two"\ntitle = "Two"\nsource = "ours"\nmodel = "vbd"\n'
    ...     '[design]\nkind = "combinations"\ncharacters = ["a", "c"]\nlength = 1\n'
    ... )
    >>> fast = Conditions(fast=True, hand="sweep:150")
    >>> session = Session.create(
    ...     folder / "two.toml", "P01", folder=folder / "P01", seed=1, conditions=fast
    ... )
    >>> _ = session.run("simulated")
    >>> [row["answered"] == row["presented"] for row in session.trials]
    [True, True]
    """

    def __init__(
        self,
        folder: Path,
        protocol: Protocol,
        plan: Plan,
        conditions: Conditions,
        progress: Progress,
        engine: MakeEngine | None = None,
        begun: Any = None,
    ) -> None:
        self.folder = folder
        self.protocol = protocol
        self.plan = plan
        self.conditions = conditions
        self.progress = progress
        self.fields = told_fields(protocol, {})
        self._begun = False  # whether the session is on the disk
        self._resumed: Record | None = None  # as it was read to be resumed
        self._drawn = False  # whether the seed was drawn, since none was given
        # The simulated hand differs between participants, and each time that a session is resumed.
        drawn = f"{plan.protocol} {plan.participant} {plan.seed} hand {len(progress.runs)}"
        spawned, steering = begun or (None, steering_of(conditions.device))
        self._steering = steering if has_hand(conditions.device) else None
        self._pointer: Pointer | None = None
        if conditions.live is not None:
            check_live(protocol, conditions, usual=engine is None)
            self._pointer = Pointer() if has_hand(conditions.device) else None
        if conditions.markers is not None:
            parse_markers(conditions.markers)
        check_conventional(protocol, conditions)
        spec = device_spec(
            conditions.device, conditions.hand, seed_of(drawn), self._steering, self._pointer
        )
        if conditions.fast and not spec.startswith("sim:"):
            raise InputError(
                f"{setting('fast')} is for the simulated device; leave out {setting('device')}"
            )
        self._engine: RunEngine | None = None
        if protocol.medium == "device":
            wanted = protocol.model.on(protocol.geometry, conditions.rate_hz)
            if engine is None:
                channels = [channel for channel in (self._steering, self._pointer) if channel]
                self._engine = usual_engine(
                    spec, wanted, protocol, plan, channels, fast=conditions.fast, spawned=spawned
                )
            else:
                self._engine = engine(spec, wanted)

    @classmethod
    def create(
        cls,
        protocol: str | Path | Protocol,
        participant: str,
        *,
        folder: str | Path | None = None,
        seed: int | None = None,
        order: int | None = None,
        texture: float | None = None,
        contrast: float | None = None,
        group: str | None = None,
        fields: Mapping[str, str] | None = None,
        conditions: Conditions = USUAL,
        engine: MakeEngine | None = None,
        begun: Any = None,
    ) -> Session:
        """Plan a new session; nothing is written to the disk before `run`.

        Parameters
        ----------
        protocol
            Name of a protocol that comes with the program, a TOML file, or the protocol itself.
        participant
            Pseudonym of the participant.
        folder
            New directory for the session; PARTICIPANT-PROTOCOL-TIME if none is given.
        seed
            Number that all random choices of the plan follow from; one is drawn if none is given.
        order, texture, contrast, group
            These are described at `vbraille.sessions.planning.making.make_plan`.
        fields
            Answers to the protocol's questions about the participant, by the names of the
            questions; questions that are not answered stay empty.
        conditions
            What the session is run with, such as its device.
        engine
            Function that makes the engine which drives the device, from the device's spec and the
            display that is wanted. It is for programs that have a loop of their own; None for
            the usual engine.
        begun
            Host process that was begun beforehand, as for `Session`.

        Raises
        ------
        InputError
            If an argument cannot be used, or the directory exists already.
        """
        planned, plan = plan_session(protocol, participant, seed, order, texture, contrast, group)
        name = f"{plan.participant}-{plan.protocol}-{datetime.now():%Y%m%d-%H%M%S}"
        place = Path(name if folder is None else folder)
        progress = Progress(plan, procedure=procedure_of(planned, plan))
        session = cls(place, planned, plan, conditions, progress, engine, begun)
        session.tell(fields or {})
        session._drawn = seed is None
        check_free(place, "folder")
        return session

    @classmethod
    def resume(
        cls,
        folder: str | Path,
        *,
        engine: MakeEngine | None = None,
        begun: Any = None,
        **changed: Any,
    ) -> Session:
        """Go on with a session that was begun earlier.

        Parameters
        ----------
        folder
            The session's directory.
        engine, begun
            Function that makes the engine, or a host process, as for `create`.
        changed
            Fields of the `Conditions` that differ from when the session began: device, hand,
            answers, fast, sound, live, markers or also. If the answers come from elsewhere now, the
            session is not fast unless that is asked for again.

        Raises
        ------
        InputError
            If the directory holds no session, the session has ended, or an argument cannot be
            used.
        VbrailleError
            If the session's record is damaged.
        """
        record = load(Path(folder))
        if record.journal.damage is not None:
            raise VbrailleError(
                f"{record.folder} is damaged: of {journal.NAME} {record.journal.damage}; the "
                f"{len(record.journal.events)} events before it are whole, and nothing was changed"
            )
        progress = record.progress()
        if progress.ended:
            raise InputError(f"{record.folder} has ended; session export makes tables of it")
        began = Conditions.of(record.head)
        refuse_hand(changed.get("device", began.device), hand=changed.get("hand"))
        if changed.get("answers", began.answers) != began.answers:
            changed = {"fast": False, **changed}
        conditions = replace(began, **changed)
        session = cls(
            record.folder, record.protocol, record.plan, conditions, progress, engine, begun
        )
        session._begun = True
        session._resumed = record
        return session

    def __enter__(self) -> Self:
        """Hand over the session; at the block's end it lets its device go."""
        return self

    def __exit__(self, *_exception: object) -> None:
        self.close()

    def close(self) -> None:
        """Let the device go, if the session has it; further calls do nothing.

        `run` does so at its end. What was answered stays, and the session can be resumed.
        """
        if self._engine is not None:
            self._engine.close()

    @property
    def record(self) -> Record:
        """Content of the session's directory, which exists once the session was run."""
        return load(self.folder)

    @property
    def trials(self) -> list[dict[str, Any]]:
        """A row for each planned trial, as `vbraille session export` writes them.

        The columns are described in `vbraille.sessions.record.codebook.COLUMNS`.
        """
        from vbraille.sessions.record.export import rows

        return rows(self.record)

    def tell(self, fields: Mapping[str, str]) -> None:
        """Answer what the protocol asks about the participant.

        Raises
        ------
        InputError
            If the protocol has no such question, or the answer is none of the question's choices.
        """
        self.fields = told_fields(self.protocol, fields)

    def answers(self, source: Source | None = None) -> Responses:
        """Make the source of answers for `run`, and check it before anything is begun.

        Raises
        ------
        InputError
            If the answers cannot be used with this session.
        """
        chosen = self.conditions.answers if source is None else source
        fast = self.conditions.fast
        return responses_of(chosen, self.protocol, self.plan, self.progress, fast=fast)

    def run(
        self,
        answers: Source | None = None,
        *,
        say: Say = _ignore,
        warn: Say = _ignore,
        sound: Sound | None = None,
        before_rest: Callable[[], None] = _nothing,
        view: SessionView | None = None,
    ) -> Self:
        """Conduct the session until its end, or until it is stopped.

        Parameters
        ----------
        answers
            Source of the answers: a spec as in `Conditions`, the lines themselves, or a function
            that gives the line for a `Trial`; None for the source that the conditions name.
        say
            Function that is called with each sentence that the experimenter should hear.
        warn
            Function that is called with sentences which should be kept apart from those: that
            code is being compiled, and which seed was drawn.
        sound
            Device that makes the participant's signals; None for the one that the conditions name.
        before_rest
            Function that is called just before the array is brought to rest, which nothing may
            interrupt.
        view
            Pages that watch; None for those that the conditions ask for.

        Returns
        -------
        Session
            This session itself.

        Raises
        ------
        InputError
            If an argument cannot be used; a new session is then not on the disk.
        VbrailleError
            If the device or the disk fails and does not recover.
        """
        given = self.answers(answers)
        begins = not self._begun
        if view is None:
            view = usual_view(self.protocol, self.conditions, self._pointer)
        if view is not None:
            say = view.relay(say)
            view.begin(self._engine)
        markers = conventional = None
        try:
            if self.conditions.markers is not None:
                markers = Markers(
                    parse_markers(self.conditions.markers), self.protocol.marker_codes
                )
            conventional = usual_conventional(
                self.protocol, self.plan, self.conditions, felt=given.felt
            )
            if isinstance(self._engine, Host):
                self._engine.launch()
            # This import stands here because numba takes long to load; the host starts meanwhile.
            from vbraille.sessions.running.apparatus import Apparatus, make_sound

            apparatus = Apparatus(
                self._engine,
                given,
                self._steering,
                sound=lambda: sound or make_sound(self.conditions.sound, given, say),
                real=not self.conditions.fast,
                say=say,
                warn=warn,
                before_rest=before_rest,
                view=view,
                markers=markers,
                conventional=conventional,
            )
            if begins:
                apparatus.open(self.protocol, self.plan)
                began = replace(self.conditions, answers=given.name)
                head = head_of(self.protocol, self.plan, self.fields, began)
                create(self.folder, self.protocol, self.plan, head)
                self._begun = True
                if self._drawn:
                    warn(f"seed: {self.plan.seed}")
                say(f"session: {self.folder}")
            # Its journal is read again once it is locked; all else cannot change meanwhile.
            known = self.progress if self._resumed is not None else None
            record, self._resumed = self._resumed or self.record, None
            self.progress = apparatus.run(
                record,
                known,
                why="start" if begins else "resume",
                spec=self.conditions.device,
                hand=self.conditions.hand,
            )
        finally:
            if self._engine is not None:
                before_rest()
            self.close()
            if view is not None:
                view.close()
            if conventional is not None:
                conventional.close()
            if markers is not None:
                for sentence in markers.close():
                    say(sentence)
        return self


def usual_engine(
    spec: str,
    wanted: Display,
    protocol: Protocol,
    plan: Plan,
    channels: Sequence[Steering | Pointer],
    *,
    fast: bool,
    spawned: Any = None,
) -> RunEngine:
    """Make the usual engine: a process of its own, or a loop in this one if it runs fast.

    Parameters
    ----------
    spec, wanted
        Spec of the device, and the display that the protocol is written for.
    protocol, plan
        What the session shows, which says how much room a picture needs.
    channels
        Shared memory by which a simulated hand is moved, which the process inherits.
    fast
        Whether it runs as fast as the machine can.
    spawned
        Process that was begun beforehand, and inherits that memory already; None for a new one.
    """
    if fast:
        from vbraille.engine.batch import BatchEngine

        return BatchEngine(open_device(spec, wanted), wanted.rate_hz)
    find_driver(spec)  # before anything is compiled for what is not there
    inherited = [channel.descriptor for channel in channels]
    return Host(spec, wanted, room_for(protocol, plan, wanted), pass_fds=inherited, spawned=spawned)


def room_for(protocol: Protocol, plan: Plan, wanted: Display) -> int:
    """Bytes of the largest program of a plan, at any contrast and texture."""
    if protocol.pictures:
        different = {(s.scene, s.picture): s for s in plan.stimuli()}.values()
        # A picture of less than full contrast is a group, which takes a little more.
        return max(protocol.program(s, replace(s.tuning, contrast=0.5)).nbytes for s in different)
    most = max(len(protocol.line(stimulus.masks)) for stimulus in plan.stimuli())
    return protocol.model.style.room(wanted, most)


def usual_view(
    protocol: Protocol, conditions: Conditions, pointer: Pointer | None
) -> SessionView | None:
    """Make the pages of the live view that is wanted; None if none is.

    Parameters
    ----------
    protocol, conditions
        What the session shows, and what it is run with.
    pointer
        Pointer by which a page is the hand; None if no page may be.
    """
    live = conditions.live
    if live is None:
        return None
    # Imported here, since a session without a live view needs none of it.
    from vbraille.live.monitor import Monitor
    from vbraille.sessions.running.liveview import LOOPBACK, SessionView

    blind, steers = protocol.session.blind, pointer is not None
    monitor = Monitor(host=live.host, port=live.port, pointer=pointer, blind=blind, steers=steers)
    return SessionView(monitor, blind=blind, host=live.host or LOOPBACK, simulated=steers)


def usual_conventional(
    protocol: Protocol, plan: Plan, conditions: Conditions, *, felt: bool
) -> OnConventional | None:
    """Begin to drive the conventional display that the protocol needs; None if it needs none.

    Parameters
    ----------
    protocol, plan, conditions
        What the session shows, in which order, and what it is run with.
    felt
        Whether answers come from what is felt: a simulated reader compares nothing with what
        stands there.
    """
    if conditions.fast or felt or not protocol.needs_conventional:
        return None
    from vbraille.conventional.display import ConventionalDisplay
    from vbraille.sessions.running.conventional import OnConventional

    spec = conditions.also or CONVENTIONAL
    cells = cells_needed(protocol, plan)
    table = protocol.conventional
    return OnConventional(ConventionalDisplay(spec), table, cells=cells, spec=spec)


def cells_needed(protocol: Protocol, plan: Plan) -> int:
    """Number of cells that a conventional display must have for all of a plan."""
    table = protocol.conventional
    shown = [stimulus.masks for stimulus in plan.stimuli() if stimulus.conventional]
    return max(len(table.placed(masks)) for masks in [table.reference, *shown])


def check_conventional(protocol: Protocol, conditions: Conditions) -> None:
    """Check that the protocol and a conventional display go together.

    Raises
    ------
    InputError
        If they do not.
    """
    if conditions.also is not None and not protocol.needs_conventional:
        raise InputError(
            f"{protocol.name} shows nothing on a conventional display; leave out {setting('also')}"
        )
    shows = any(protocol.place_of(c) == CONVENTIONAL for c in protocol.conditions)
    if conditions.fast and shows:
        raise InputError(
            f"{protocol.name} shows strings on a conventional display, which takes its time; "
            f"leave out {setting('fast')}"
        )


def check_live(protocol: Protocol, conditions: Conditions, *, usual: bool) -> None:
    """Check that there is a host process whose memory a live view can show.

    Parameters
    ----------
    protocol, conditions
        What the session shows, and what it is run with.
    usual
        Whether the engine is the usual one.

    Raises
    ------
    InputError
        If there is none.
    """
    name = setting("monitor")
    if protocol.medium == "paper":
        raise InputError(
            f"{protocol.name} is read on paper, and {name} shows a device; leave it out"
        )
    if conditions.fast:
        raise InputError(
            f"{name} is for sessions that run by the clock; leave it out, or {setting('fast')}"
        )
    if not usual:
        raise InputError(f"{name} is for the usual engine; leave it out with one of your own")
