"""Events as JSON, in which the lines of a journal have them."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any

import msgspec

from vbraille.sessions.record.events import AnyEvent

if TYPE_CHECKING:
    from vbraille.sessions.record.eventbase import JournalEvent

_FROM_JSON = msgspec.json.Decoder(AnyEvent)
_FIELD = re.compile(r"Object (missing required|contains unknown) field `(.+?)`")


def read(line: bytes) -> JournalEvent:
    """Read an event from a line of a journal, given as JSON without its checksum.

    Raises
    ------
    ValueError
        If the kind is not known, or the fields are not those of the kind. The message goes on
        a sentence that begins with the number of the line.
    """
    try:
        return _FROM_JSON.decode(line)
    except msgspec.ValidationError as error:
        raise ValueError(_fault(json.loads(line), str(error))) from None
    except msgspec.DecodeError:
        return _read_slowly(line)


def _read_slowly(line: bytes) -> JournalEvent:
    """Read an event that has a lone surrogate, as file names may; fail if it is not JSON."""
    try:
        told = json.loads(line)
    except ValueError:
        raise ValueError("is not JSON") from None
    try:
        return msgspec.convert(told, AnyEvent)
    except msgspec.ValidationError as error:
        raise ValueError(_fault(told, str(error))) from None


def _fault(told: Any, why: str) -> str:
    """Say what is wrong with JSON that is not an event."""
    kind = told.get("event") if isinstance(told, dict) else None
    if kind is None or why.endswith("`$.event`"):
        return f"has an event of the kind {kind!r}, which this vbraille does not know"
    has = f"has an event of the kind {kind!r}"
    found = _FIELD.match(why)
    if found is None:
        return f"{has} that cannot be read: {why}"
    missing = found[1] == "missing required"
    return f"{has} {'without' if missing else 'with an unknown field,'} {found[2]!r}"


def to_json(event: JournalEvent) -> dict[str, Any]:
    """Event in the form that the journal has; `read` makes an equal event of it."""
    told = msgspec.to_builtins(event)
    # The number and the kind come first and the times last, for people who read the journal.
    first = {"n": told.pop("n", 0), "event": told.pop("event")}
    last = {name: told.pop(name) for name in ("t_s", "wall", "up_s") if name in told}
    return first | told | last
