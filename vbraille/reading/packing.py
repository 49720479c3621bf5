"""Indices and answers as bytes, for a file or for a pipe."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import msgspec

from vbraille.reading.queries import Counted, Failed, Found, Indexed, NotFound, Searched
from vbraille.translate.source import Index

if TYPE_CHECKING:
    from vbraille.reading.queries import Answer

_ANSWERS = {
    kind.__struct_config__.tag: kind
    for kind in (Found, NotFound, Searched, Counted, Failed, Indexed)
}


def pack_index(index: Index) -> bytes:
    """Bytes of an index."""
    return msgspec.msgpack.encode(index)


def unpack_index(packed: bytes) -> Index:
    """Index of its bytes.

    Raises
    ------
    ValueError
        If they are no index's.
    """
    return _index_of(msgspec.msgpack.decode(packed))


def unpack_answer(fields: dict[str, Any]) -> Answer:
    """Answer of its fields, as msgpack gives them.

    Raises
    ------
    ValueError
        If they are no answer's.
    """
    fields = dict(fields)
    try:
        kind = _ANSWERS[fields.pop("type")]
        if "index" in fields:
            fields["index"] = _index_of(fields["index"])
        return kind(**fields)
    except (KeyError, TypeError) as error:
        raise ValueError(f"there is no such answer: {error}") from None


def _index_of(fields: Any) -> Index:
    # Text beside bytes in one list is more than msgspec's own types can tell apart.
    try:
        rows = tuple(tuple(row) for row in fields["rows"])
        form, fits, complete = fields["form"], fields["fits"], fields["complete"]
        if not isinstance(form, str) or not isinstance(complete, bool):
            raise TypeError
        return Index(form, tuple(fits), rows, complete)
    except (KeyError, TypeError):
        raise ValueError("these are not the bytes of an index") from None
