"""A session from its plan to its table: it is created, run, resumed, and read as rows."""

from __future__ import annotations

import secrets
from collections.abc import Callable, Mapping
from contextlib import closing
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Self

from msgspec import convert, structs

from vbraille.errors import InputError
from vbraille.names import likeness
from vbraille.sessions.planning.loading import load_protocol
from vbraille.sessions.planning.plan import Plan, make_plan
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.record import record, trials
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.record import Content, Record
from vbraille.sessions.running.conditions import Conditions, open_answers

_MOST_DRAWN = 1_000_000  # a seed that is drawn is short enough to be written down by hand


def _nothing(*_: object) -> None:
    """Do nothing."""


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
        path = Path(path) if path else _free_path(participant, loaded.name)
        number = session or 1 + _participants(path.absolute().parent).count(participant)
        loaded, plan = plan_session(
            loaded, participant, seed, number, best_from, order=order, group=group
        )
        head = {
            "protocol": loaded.name,
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
        return trials.rows(self.path)

    def run(
        self,
        answers: Any = None,
        *,
        say: Callable[[str], None] = _nothing,
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
        from vbraille.sessions.running.runner import Runner  # what only a run needs

        with closing(Record(self.path)) as opened:
            content = opened.read()
            progress = Progress(trials.protocol_of(content), content.plan, content.events)
            if progress.ended:
                raise InputError(f"{self.path} has ended; session export makes a table of it")
            conditions = _conditions_now(content, changed)
            source = open_answers(answers, conditions, progress)
            conditions = structs.replace(conditions, answers=source.name)
            if progress.runs:
                known = f"device {conditions.device}, answers {conditions.answers}"
                say(f"resume: {known}; {progress.done} trials have answers")
                if datetime.fromisoformat(content.events[-1].wall) > datetime.now(UTC):
                    back = "times of day go back in the record, t_s does not"
                    say(f"clock: set back since the last run; {back}")
            Runner(opened, progress, conditions, source, say).run(monitor, before_rest)
            opened.write_ticks()
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
        texture = trials.best_level(Path(best_from), "texture")
        display = structs.replace(loaded.display, texture=texture)
        loaded = structs.replace(loaded, display=display)
    plan = make_plan(loaded, participant, seed, session=session or 1, **chosen)
    return loaded.of_group(plan.group), plan


def nearly_same(folder: Path, participant: str) -> str | None:
    """Return a pseudonym with sessions in a folder that differs in case, zeros or signs alone.

    None if there is no such pseudonym, or the participant has sessions there.
    """
    known, own = _participants(folder), likeness(participant, person=True)
    alike = (each for each in sorted(known) if likeness(each, person=True) == own)
    return None if participant in known else next(alike, None)


def _participants(folder: Path) -> list[str]:
    """Return whose the sessions in a folder are."""
    return [*filter(None, map(record.participant_of, folder.glob("*.session")))]


def _free_path(participant: str, protocol: str) -> Path:
    """Return the name of a new session in this folder: P01-letters.session, or P01-letters-2."""
    number, path = 1, Path(f"{participant}-{protocol}.session")
    while path.exists():
        number += 1
        path = path.with_name(f"{participant}-{protocol}-{number}.session")
    return path


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
        if (choices and value not in choices) or not value.isprintable():
            hint = " or ".join(choices) or "one line of text"
            raise InputError(f"{name} is {value!r}; give {hint}")
    return {name: given.get(name, "") for name in known}


def _conditions_now(content: Content, changed: Mapping[str, Any]) -> Conditions:
    """Return the conditions of the last run, with changes."""
    runs = [e.data["conditions"] for e in content.events if "conditions" in e.data]
    return (convert(runs[-1], Conditions) if runs else Conditions()).changed(changed)
