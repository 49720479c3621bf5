"""What the elements of DTBook begin that are not those of HTML."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from vbraille.translate.documents.markup.elements import (
    BEGINS,
    begin_heading,
    begin_list,
    begin_note,
)
from vbraille.translate.source import BlockKind

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vbraille.translate.documents.markup.elements import Begin, Undo
    from vbraille.translate.documents.markup.writing import Writing

_BLOCKS_NAMES = (
    "annotation author bodymatter book bridgehead byline covertitle dateline docauthor "
    "doctitle epigraph frontmatter hd imggroup level level1 level2 level3 level4 level5 "
    "level6 line linegroup list note poem prodnote rearmatter sidebar"
)
_BLOCKS = _BLOCKS_NAMES.split()


def _section(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    before = writing.sections
    writing.sections = int(name[5:]) if name[5:].isdigit() else before + 1

    def end() -> None:
        writing.sections = before

    return (end,)


def _heading(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    return begin_heading(writing, 1 if name == "doctitle" else max(writing.sections, 1))


def _note(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    return begin_note(writing)


def _line(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    return (writing.enter(replace(writing.place, kind=BlockKind.LINE, level=0)),)


def _list(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    kind = attributes.get("type", "pl")
    found = {**attributes, "type": attributes.get("enum", "1")}
    if kind == "pl":  # its items have their numbers in their text, if any
        found["style"] = "list-style: none"
    return begin_list(writing, "ol" if kind == "ol" else "ul", found)


def _plain(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    return ()


def _as_block(begin: Begin) -> Begin:
    """An element that is a block in DTBook only."""

    def begin_block(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:
        writing.begin_block()
        return (writing.begin_block, *begin(writing, name, attributes))

    return begin_block


_BEGINS: dict[str, Begin] = {
    **dict.fromkeys(_BLOCKS, _plain),
    **dict.fromkeys(("level", *(f"level{level}" for level in range(1, 7))), _section),
    **dict.fromkeys(("hd", "doctitle", "bridgehead"), _heading),
    **dict.fromkeys(("note", "annotation"), _note),
    "line": _line,
    "list": _list,
    "imggroup": BEGINS["figure"],
}
DTBOOK: dict[str, Begin] = {
    **BEGINS,
    "q": _plain,  # its quotation marks are in its text
    "linenum": BEGINS["option"],
    **{name: _as_block(begin) for name, begin in _BEGINS.items()},
}
