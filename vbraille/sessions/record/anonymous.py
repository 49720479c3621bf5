"""Tables without times of day, paths and notes, for those who give them away.

Notes are left out because people may type anything into them. The name of a session's directory,
which has a time in it, is replaced by a number made from the session's first event.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from vbraille.sessions.record.folder import Record

LEFT_OUT = ("notes", "notes_before", "notes_after", "cue_time", "answer_time", "trace")
_PATH = re.compile(r"\S*[/\\]\S*")
_SOURCES = ("typed", "simulated", "program")


def number_of(record: Record) -> str:
    """Eight digits that identify a session, whatever its directory is called."""
    return f"{record.told.crcs[0] if record.told.crcs else 0:08x}"


def without_paths(text: str) -> str:
    """Text with each word that may be a path replaced."""
    return _PATH.sub("(left out)", text)


def anonymous(record: Record, table: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows of `vbraille.sessions.record.export.rows` without times of day, paths and notes."""
    return [_row(record, row) for row in table]


def _row(record: Record, row: dict[str, Any]) -> dict[str, Any]:
    kept = {
        name: without_paths(value) if name == "faults" or name.startswith("field_") else value
        for name, value in row.items()
        if name not in LEFT_OUT
    }
    kept["session"] = number_of(record)
    if kept["answers_from"] and kept["answers_from"].partition(":")[0] not in _SOURCES:
        kept["answers_from"] = "file"
    return kept
