"""What each element of HTML begins, and what of that its end has to end."""

from __future__ import annotations

from dataclasses import replace
from pathlib import PurePosixPath
from typing import TYPE_CHECKING
from urllib.parse import unquote

from vbraille.translate.documents.markup import attributes as attribute
from vbraille.translate.documents.markup import lists
from vbraille.translate.documents.markup.lists import whole
from vbraille.translate.source import BlockKind, MarkKind

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from vbraille.translate.documents.markup.writing import Writing

    Undo = Callable[[], None]
    Begin = Callable[[Writing, str, Mapping[str, str]], tuple[Undo, ...]]

_BLOCKS_NAMES = (
    "address article aside blockquote body caption center dd details dialog dir div dl dt "
    "fieldset figcaption figure footer form frameset h1 h2 h3 h4 h5 h6 header hgroup hr html "
    "legend li listing main menu nav ol optgroup p plaintext pre search section summary table "
    "tbody tfoot thead title tr ul xmp"
)
BLOCKS = frozenset(_BLOCKS_NAMES.split())
HEADINGS = {f"h{level}": level for level in range(1, 7)}
EMPHASES = {
    **dict.fromkeys(("em", "i", "cite", "dfn", "var"), MarkKind.ITALIC),
    **dict.fromkeys(("strong", "b"), MarkKind.BOLD),
    **dict.fromkeys(("u", "ins"), MarkKind.UNDERLINE),
    **dict.fromkeys(("code", "kbd", "samp", "tt"), MarkKind.CODE),
    "sup": MarkKind.SUPERSCRIPT,
    "sub": MarkKind.SUBSCRIPT,
}
# Text of these is not for a reader, or is told elsewhere.
_DROPPED_NAMES = (
    "script style template noscript rp datalist param source track iframe noframes noembed"
)
DROPPED = frozenset(_DROPPED_NAMES.split())
_DEEPEST = 64  # lists in lists, quotations in quotations
_UNSHOWN = {
    "canvas": ("drawing", "drawing"),
    "audio": ("sound", "sound"),
    "bgsound": ("sound", "sound"),
    "video": ("film", "film"),
    "object": ("embedded object", "object"),
    "embed": ("embedded object", "object"),
    "applet": ("embedded object", "object"),
}
_BUTTONS = frozenset(("submit", "reset", "button"))


def begin_heading(writing: Writing, level: int) -> tuple[Undo, ...]:
    """Begin a heading of a level."""
    writing.lay_out_table()
    place = replace(writing.place, kind=BlockKind.HEADING, level=max(level, 1))
    return (writing.enter(place),)


def begin_note(writing: Writing) -> tuple[Undo, ...]:
    """Begin the text of a note."""
    place = replace(writing.place, kind=BlockKind.NOTE, level=0, is_note=True)
    return (writing.enter(place),)


def begin_notes(writing: Writing) -> tuple[Undo, ...]:
    """Begin a section of notes, which are the items of its list."""
    before, writing.in_notes = writing.in_notes, True

    def end() -> None:
        writing.in_notes = before

    return (end,)


def _heading(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:
    return begin_heading(writing, whole(attributes.get("aria-level"), HEADINGS[name]))


def begin_list(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:
    """Begin a list, by its name in HTML."""
    place = writing.place
    if place.items >= _DEEPEST:
        return ()
    group = place.group if place.items else writing.group()
    writing.lists.append(lists.begun(name, attributes, group))
    leave = writing.enter(replace(place, items=place.items + 1, group=group))
    return leave, _dropping(writing)


def _dropping(writing: Writing) -> Undo:
    def drop() -> None:
        writing.lists.pop()

    return drop


def _item(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    place = writing.place
    marker = writing.lists[-1].marker(attributes) if writing.lists else lists.BULLET
    writing.begin_item(marker)
    if place.is_note or (writing.in_notes and place.items == 1):
        inner = replace(place, kind=BlockKind.NOTE, level=0, is_note=True)
    else:
        inner = replace(place, kind=BlockKind.ITEM, level=max(place.items, 1))
    return writing.enter(inner), writing.end_item


def _terms(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    place = writing.place
    if place.items >= _DEEPEST:
        return ()
    group = place.group if place.items else writing.group()
    return (writing.enter(replace(place, items=place.items + 1, group=group)),)


def _term(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    place = writing.place
    if place.is_note or writing.in_notes:
        return begin_note(writing)
    level = max(place.items, 1) + (name == "dd")
    writing.begin_item("")
    return (
        writing.enter(replace(place, kind=BlockKind.ITEM, level=level)),
        writing.end_item,
    )


def _quote(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    writing.lay_out_table()
    place = writing.place
    quotes = min(place.quotes + 1, _DEEPEST)
    if place.is_note:
        return ()
    return (writing.enter(replace(place, kind=BlockKind.QUOTE, level=quotes, quotes=quotes)),)


def _lines(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    writing.lay_out_table()
    leave = writing.enter(replace(writing.place, kind=BlockKind.LINE, level=0))
    before, writing.keeps_lines = writing.keeps_lines, True
    writing.starts_lines = True

    def end() -> None:
        writing.keeps_lines, writing.starts_lines = before, False

    return leave, end


def _table(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    end = writing.begin_table()
    if attributes.get("role") in {"presentation", "none"} and writing.table is not None:
        writing.table.lays_out = True
    return (end,)


def _row(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    writing.begin_row()
    return (writing.end_row,)


def _cell(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:
    writing.begin_cell(
        columns=whole(attributes.get("colspan"), 1),
        rows=whole(attributes.get("rowspan"), 1),
        is_header=name == "th",
    )
    return (writing.end_cell,)


def _head(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    table = writing.table
    writing.end_row()
    if table is None:
        return ()
    table.in_head = name == "thead"

    def end() -> None:
        table.in_head = False

    return end, writing.end_row


def _caption(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    if name == "caption" and writing.table is not None:
        return (writing.enter(replace(writing.place, group=writing.table.group)),)
    before, writing.in_caption = writing.in_caption, True

    def end() -> None:
        writing.in_caption = before

    return (end,)


def _figure(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    return (writing.begin_figure(),)


def _rule(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    writing.lay_out_table()
    writing.divide()
    return ()


def _break(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    writing.line_break()
    return ()


def _around(before: str, after: str) -> Begin:
    """Text before and after an element."""

    def begin(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
        writing.write(writing.spell(before))
        return (lambda: writing.write(writing.spell(after)),)

    return begin


def _image(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:
    if address := attribute.figure_address(attributes):
        told = attributes.get("title") or attributes.get("aria-label") or attributes.get("alt")
        name = " ".join((told or "").split()) or PurePosixPath(unquote(address)).stem
        writing.figure(name, address)
        return ()
    said = attributes.get("aria-label") or attributes.get("alt")
    if said is None:
        said = attributes.get("title")
    if said is None:
        writing.unshown("picture", "picture")
    elif said := " ".join(said.split()):
        writing.picture(said)
    return ()


def _unshown(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:
    words, what = _UNSHOWN[name]
    label = " ".join((attributes.get("aria-label") or attributes.get("title") or "").split())
    writing.unshown(f"{words}: {label}" if label else words, what)
    return ()


def _input(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:
    kind = attributes.get("type", "").lower()
    if name == "input" and kind == "hidden":
        return ()
    if name == "input" and kind == "image":
        return _image(writing, name, attributes)
    label = " ".join((attributes.get("aria-label") or "").split())
    if kind in _BUTTONS and name == "input":
        label = label or " ".join(attributes.get("value", "").split())
    writing.unshown(f"form field: {label}" if label else "form field", "form")
    return ()


def _apart(writing: Writing, name: str, attributes: Mapping[str, str]) -> tuple[Undo, ...]:  # noqa: ARG001
    writing.flow.blank()
    return (writing.flow.blank,)


BEGINS: dict[str, Begin] = {
    **dict.fromkeys(HEADINGS, _heading),
    **dict.fromkeys(("ul", "ol", "menu", "dir"), begin_list),
    **dict.fromkeys(("dt", "dd"), _term),
    **dict.fromkeys(("pre", "listing", "xmp", "plaintext"), _lines),
    **dict.fromkeys(("td", "th"), _cell),
    **dict.fromkeys(("thead", "tbody", "tfoot"), _head),
    **dict.fromkeys(("caption", "figcaption"), _caption),
    **dict.fromkeys(_UNSHOWN, _unshown),
    **dict.fromkeys(("input", "select", "textarea"), _input),
    **dict.fromkeys(("option", "button"), _apart),
    "li": _item,
    "dl": _terms,
    "blockquote": _quote,
    "table": _table,
    "tr": _row,
    "figure": _figure,
    "hr": _rule,
    "br": _break,
    "img": _image,
    "rt": _around("(", ")"),
    "q": _around("“", "”"),
}
