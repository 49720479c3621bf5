"""``vbraille session``: plan, run, resume, check and export sessions."""

from __future__ import annotations

import sys
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from vbraille.cli import options
from vbraille.cli.printing import say, show
from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.running.answers import Typed
    from vbraille.sessions.session import Session


_file = click.argument("path", type=click.Path(), metavar="FILE")
_files = click.argument("paths", type=click.Path(), nargs=-1, required=True, metavar="FILE...")
_protocol = click.argument("protocol")
_PLAN = (
    options.option("--participant", metavar="P07", required=True, help="Pseudonym."),
    options.option("--seed", type=options.whole(0), metavar="N", help="Seed of the plan; drawn."),
    options.option("--order", type=options.whole(1), metavar="N", help="Balanced order to take."),
    options.option("--group", metavar="NAME", help="Group of the participant."),
    options.option("--session", type=options.whole(1), metavar="N",
                   help="Number of the participant's session with this protocol."),
    options.option("--best-from", type=click.Path(), metavar="FILE",
                   help="Session that tells the reader's best texture."),
)  # fmt: skip
_CONDUCT = (
    options.device(default=None, show_default=False),
    options.hand(default=None, show_default=False),
    options.option("--answers", metavar="SOURCE",
                   help="Answers: typed, simulated:NOISE or a file."),
    options.option("--fast", is_flag=True, default=None,
                   help="Run as fast as the machine can, with a simulated device."),
    options.speech,
    options.cues,
    options.also,
    options.option("--markers", metavar="RECORDER",
                   help="Send markers: lsl, lsl:NAME or serial:PORT.", group="Output and keys"),
    *options.LIVE,
)  # fmt: skip


@click.group(cls=options.Group)
def command() -> None:
    """A session is one file, which keeps the protocol, the plan, every answer and every frame."""


@command.action("session protocols", click.argument("name", required=False), options.json)
def protocols(name: str | None, json: bool) -> None:
    """List the protocols that come with the program, or print one."""
    from vbraille.sessions.planning.loading import FOLDER, OWN_FILE, load_protocol, shipped

    if name is not None:
        beside = FOLDER / name
        content = beside.read_bytes() if beside.is_file() else load_protocol(name).files[OWN_FILE]
        click.echo(content, nl=False)
        return
    loaded = [load_protocol(each) for each in shipped()]
    rows = [{"name": p.name, "title": p.title, "display": p.model} for p in loaded]
    lines = (f"{p.name}: {p.title}, {p.display_model.title}" for p in loaded)
    show(lines, rows, as_json=json)


@command.action(
    "session plan letters --participant P07",
    _protocol,
    *_PLAN,
    options.option("--brf", is_flag=True, help="Print the strings in ASCII braille."),
    options.json,
)
def plan(protocol: str, brf: bool, json: bool, **given: Any) -> None:
    """Print the order of a session, and how long it takes."""
    from vbraille.sessions.planning.plan import plan_lines, to_brf
    from vbraille.sessions.session import plan_session

    loaded, planned = plan_session(protocol, **given)
    if given["seed"] is None:
        say(f"seed: {planned.seed}", aside=True)
    if brf:
        click.echo(to_brf(loaded, planned), nl=False)
    else:
        show(plan_lines(loaded, planned), planned, as_json=json)


@command.action(
    "session run letters --participant P07 --seed 42",
    _protocol,
    *_PLAN,
    options.option("--field", "fields", type=options.pair, multiple=True,
                   metavar="NAME=VALUE",
                   help="Answer to a question about the participant."),
    options.option("--out", type=click.Path(), metavar="FILE",
                   help="File of the session; PARTICIPANT-PROTOCOL.session by default."),
    options.rate(default=None),
    options.option("--another", is_flag=True,
                   help="This is another person than one of a similar pseudonym."),
    *_CONDUCT,
)  # fmt: skip
def run(protocol: str, fields: tuple[tuple[str, str], ...], out: str | None, another: bool,
        rate: float | None, **given: Any) -> None:  # fmt: skip
    """Run a session; type help at its prompt for what can be typed."""
    from vbraille.sessions.planning.loading import load_protocol
    from vbraille.sessions.planning.plan import check_participant
    from vbraille.sessions.session import Session, check_fields, nearly_same

    participant = given.pop("participant")
    chosen = ("seed", "order", "group", "session", "best_from")
    planned = {name: given.pop(name) for name in chosen}
    check_participant(participant)
    loaded = load_protocol(protocol)
    answered = dict(fields)
    check_fields(loaded, answered)
    with _typing(given.get("answers"), given.pop("speech")) as (typed, tell):
        near = None if another else nearly_same(Path(out or "new").absolute().parent, participant)
        if near is not None:
            _ask_who(participant, near, typed, tell)
        if typed is not None:
            answered |= _ask_fields(loaded, answered, typed, tell)
        session = Session.create(protocol, participant, path=out, fields=answered, **planned)
        if planned["seed"] is None:
            say(f"seed: {session.content.plan.seed}", aside=True)
        tell(f"session: {session.path}")
        try:
            _conduct(session, typed, tell, rate_hz=rate, **given)
        except BaseException:
            if not any(event.kind == "run" for event in session.content.events):
                session.path.unlink()  # the device did not open: nothing has begun
            raise


@command.action("session resume P07-letters.session", _file, *_CONDUCT)
def resume(path: str, speech: bool, **given: Any) -> None:
    """Go on with a session where it was stopped, or the machine failed."""
    from vbraille.sessions.session import Session

    session = Session(path)
    with _typing(given["answers"] or session.last_conditions.answers, speech) as (typed, tell):
        _conduct(session, typed, tell, **given)


def _conduct(
    session: Session, typed: Typed | None, tell: Callable[[str], None], **given: Any
) -> None:
    from vbraille.signals import EAR

    address = (given.pop("host"), given.pop("port"))
    monitor = address if given.pop("monitor") else None
    given["sound"] = given.pop("cues")
    given["answers"] = typed or given["answers"]
    chosen = {name: value for name, value in given.items() if value is not None}
    session.run(say=tell, monitor=monitor, before_rest=EAR.close, **chosen)


@command.action(
    "session check P07-letters.session",
    _file,
    options.option("--expect", metavar="SUM", help="Checksum that was noted earlier."),
    options.option("--salvage", type=click.Path(), metavar="NEW",
                   help="Write what can be read into a new file."),
    options.json,
)  # fmt: skip
def check(path: str, expect: str | None, salvage: str | None, json: bool) -> int:
    """Check that a session is whole, and that nothing was changed."""
    from vbraille.sessions.record import checking

    if salvage is not None:
        for line in checking.salvage(Path(path), Path(salvage)):
            say(line)
        return 0
    faults = checking.check(Path(path), expect or "")
    lines = [f"fault: {fault}" for fault in faults]
    if not faults:
        lines = ["whole: the protocol, the plan, all events and all ticks"]
        lines.append(f"record: {checking.sum_of(Path(path))}")
    show(lines, {"good": not faults, "faults": faults}, as_json=json)
    return 1 if faults else 0


@command.action(
    "session export P07-letters.session --out trials.csv",
    _files,
    options.out,
    options.force,
    options.option("--bids", is_flag=True, help="Add the sessions to a BIDS dataset at --out."),
    options.option("--codebook", type=click.Path(), metavar="FILE",
                   help="Also write what each column means."),
    options.option("--anonymous", is_flag=True, help="Leave out times of day, paths and notes."),
)  # fmt: skip
def export(paths: tuple[str, ...], out: str | None, force: bool, bids: bool, codebook: str | None,
           anonymous: bool) -> None:  # fmt: skip
    """Write the trials of sessions as a table, or as a BIDS dataset."""
    from vbraille.files import write_file
    from vbraille.sessions.record import record, trials

    given = [Path(path) for path in paths]
    if len({path.resolve() for path in given}) < len(given):
        raise InputError("a session is given twice; give each once")
    if bids:
        from vbraille.sessions.record.bids import export_bids

        if out is None:
            raise InputError("--bids needs a folder; give one with --out")
        for written in export_bids(given, Path(out), anonymous=anonymous):
            say(f"written: {written}")
        return
    rows = [row for path in given for row in trials.rows(path, anonymous=anonymous)]
    text = trials.to_csv(rows)
    if out is None:
        click.echo(text, nl=False)
    else:
        write_file(Path(out), text.encode("utf-8-sig"), replace=force)
        say(f"written: {out}, {len(rows)} rows")
    if codebook is not None:
        columns = list(dict.fromkeys(name for row in rows for name in row))
        book = trials.codebook(columns, trials.protocol_of(record.read(given[0])))
        entries = [{"column": name, **each._asdict()} for name, each in book.items()]
        write_file(Path(codebook), trials.to_csv(entries).encode("utf-8-sig"), replace=force)
        say(f"written: {codebook}")


@command.action("session methods P07-letters.session", _files)
def methods(paths: tuple[str, ...]) -> None:
    """Print a paragraph for a paper on what was done."""
    from vbraille.analysis import methods_of

    for line in methods_of([Path(path) for path in paths]):
        say(line)


@command.action(
    "session withdraw P07 sessions",
    click.argument("participant"),
    click.argument("paths", type=click.Path(), nargs=-1, metavar="[FOLDER]..."),
    options.option("--yes", is_flag=True, help="Do not ask."),
)
def withdraw(participant: str, paths: tuple[str, ...], yes: bool) -> int:
    """Remove all data of a participant from folders."""
    from vbraille.sessions.record.withdraw import Withdrawal

    found = Withdrawal([Path(path) for path in paths or (".",)], participant)
    left = [f"left: {path} names {participant}; look at it yourself" for path in found.left]
    if not found.lines:
        for line in left:
            say(line)
        raise InputError(f"there is nothing of {participant} to remove")
    if not yes:
        for line in found.lines:
            say(f"found: {line}")
        if not click.confirm(f"remove all of {participant} for good?"):
            raise InputError("nothing was removed; answer yes, or give --yes")
    lines = found.lines
    found.remove()
    for line in (*(f"removed: {line}" for line in lines), *left):
        say(line)
    return 1 if left else 0


@contextmanager
def _typing(
    answers: str | None, speech: bool
) -> Iterator[tuple[Typed | None, Callable[[str], None]]]:
    """Open the terminal for lines that are typed: where they come from, and what says a sentence.

    Parameters
    ----------
    answers
        Spec of the answers; None for typed ones.
    speech
        Whether all is spoken.
    """
    from vbraille.reading.outputs import Behind, Output, Speech

    with ExitStack() as stack:
        spoken = Behind("speech", Speech, _say) if speech else Output()
        stack.callback(spoken.close)

        def tell(sentence: str) -> None:
            _say(sentence)
            spoken.say(sentence)

        if answers not in (None, "typed"):
            yield None, tell
        elif sys.stdin is not None and sys.stdin.isatty():
            from vbraille.cli.typing import TypedKeys

            keys = stack.enter_context(TypedKeys(spoken.say))
            yield keys, keys.say
        else:
            from vbraille.sessions.running.answers import Typed

            yield Typed(), tell


def _say(sentence: str) -> None:
    with suppress(BrokenPipeError):  # a session does not end because its output is closed
        say(sentence)


def _ask_who(participant: str, near: str, typed: Typed | None, tell: Callable[[str], None]) -> None:
    """Ask whether a new participant is one whose pseudonym is nearly the same."""
    if typed is None or not sys.stdin.isatty():
        raise InputError(
            f"{participant} is new here, and {near} has sessions; give --participant {near}, or "
            f"--another if {participant} is another person"
        )
    tell(f"participant: {near} has sessions here; is {participant} another person? yes or no")
    if _next_line(typed).lower() not in ("y", "yes"):
        raise InputError(f"nothing was begun; give --participant {near}")


def _ask_fields(
    protocol: Protocol, given: dict[str, str], typed: Typed, tell: Callable[[str], None]
) -> dict[str, str]:
    """Ask what the protocol wants to know about the participant and was not given."""
    found = {}
    for field in protocol.fields:
        if field.name in given:
            continue
        choices = f" ({' or '.join(field.choices)})" if field.choices else ""
        while True:
            tell(f"{field.ask}{choices}:")
            found[field.name] = _next_line(typed)
            if not field.choices or found[field.name] in field.choices:
                break
    return found


def _next_line(typed: Typed) -> str:
    from vbraille.sessions.running.answers import Line, NoMoreAnswers

    try:
        while True:
            line = typed.line(None, 1.0)
            if isinstance(line, Line):
                return line.text.strip()
    except NoMoreAnswers:
        raise InputError("standard input has ended; give the answers with --field") from None
