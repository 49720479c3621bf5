"""A session, from the plan to the table: `create`, `run`, `resume`, `check`, `export`."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import Any

from msgspec import Struct, structs

from vbraille.errors import InputError
from vbraille.sessions.planning.plan import Plan, make_plan
from vbraille.sessions.planning.protocol import Protocol, load_protocol, parse_protocol
from vbraille.sessions.record import record
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.record import Record
from vbraille.sessions.running.answers import answers_of
from vbraille.sessions.running.device import SessionDevice
from vbraille.sessions.running.paper import Paper
from vbraille.sessions.running.runner import Runner, Say


class Conditions(Struct, frozen=True):
    """What a session is run with: device, simulated hand, source of answers, and pace."""

    device: str = "sim"
    hand: str = "slow"
    answers: str = "typed"
    fast: bool = False


def create(
    path: Path,
    protocol_name: str,
    participant: str,
    seed: int,
    *,
    order: int | None = None,
    fields: dict[str, str] | None = None,
) -> Plan:
    """Plan a session, and write its record.

    Raises
    ------
    InputError
        If the protocol or a field cannot be used.
    RecordError
        If the record cannot be written.
    """
    protocol, content = load_protocol(protocol_name)
    plan = make_plan(protocol, participant, seed, order)
    head = {
        "protocol": protocol.name,
        "participant": participant,
        "seed": seed,
        "order": plan.order,
        "group": plan.group,
        "fields": _checked(protocol, fields or {}),
    }
    record.create(path, head, {"protocol.toml": content}, plan)
    return plan


def run(path: Path, say: Say, **changed: Any) -> None:
    """Run a session from where it is: from its start, or from where it was stopped or killed.

    Parameters
    ----------
    path
        File of the session.
    say
        Is called with each sentence for the experimenter.
    changed
        Fields of the `Conditions` that differ from those of the last run.

    Raises
    ------
    InputError, VbrailleError
        If the session has ended, or the device or the disk fails.
    """
    with closing(Record(path)) as opened:
        content = opened.read()
        protocol = parse_protocol(content.files["protocol.toml"], f"protocol of {path}")
        protocol = protocol.of_group(content.plan.group)
        progress = Progress(protocol, content.plan, content.events)
        if progress.ended:
            raise InputError(f"{path} has ended; session export makes a table of it")
        last = [event.data["conditions"] for event in content.events if event.kind == "run"]
        conditions = structs.replace(Conditions(**(last[-1] if last else {})), **changed)
        if last:
            say(f"resume: {conditions.device}, answers {conditions.answers}")
        answers = answers_of(conditions.answers, protocol, content.plan, progress.script_line)
        device: SessionDevice | Paper
        if protocol.medium == "paper":
            device = Paper(progress.line, at_once=not answers.typed)
        else:
            device = SessionDevice(
                protocol,
                conditions.device,
                conditions.hand,
                seed=content.plan.seed + progress.runs,
                fast=conditions.fast,
                line=progress.line,
            )
        with closing(device):
            device.start()
            runner = Runner(opened, progress, answers, device, say)
            runner.run(conditions=structs.asdict(conditions))
        say(f"record: {opened.sum.hex()}")


def _checked(protocol: Protocol, given: dict[str, str]) -> dict[str, str]:
    """Return the answers to the protocol's fields; those that were not given are empty."""
    known = {field.name: field for field in protocol.fields}
    for name, value in given.items():
        if name not in known:
            raise InputError(f"there is no field {name!r}; there are {', '.join(known)}")
        choices = known[name].choices
        if choices and value not in choices:
            raise InputError(f"{name} is {value!r}; give {' or '.join(choices)}")
    return {name: given.get(name, "") for name in known}
