"""A word processor's document as HTML, which the reader of HTML then makes into blocks.

The document is in anydoc's model. What that model has no place for, such as languages, `officexml`
has written into the text as annotations.
"""

from __future__ import annotations

import re
from html import escape
from itertools import groupby
from typing import TYPE_CHECKING

from vbraille.translate.documents.markup.lists import numeral
from vbraille.translate.documents.office.annotations import ANNOTATED, STRAY

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from anydoc import Block, Cell, Document, Inline, List, Table

_NUMBERING = {
    "decimal": "1",
    "lower_alpha": "a",
    "upper_alpha": "A",
    "lower_roman": "i",
    "upper_roman": "I",
}
_UNDERLINE = re.compile("</?u>")
_DEEPEST = 60  # lists and quotes in each other


def written(document: Document, title: str, language: str) -> Iterator[str]:
    """Pieces of the HTML of a document.

    Parameters
    ----------
    document
        Document in anydoc's model.
    title, language
        Title and tag of the language; empty if the document does not say.
    """
    numbers = {note.id: str(number) for number, note in enumerate(document.notes, 1)}
    lang = f' lang="{escape(language)}"' if language else ""
    yield f"<!DOCTYPE html><html{lang}><head><meta charset='utf-8'>"
    yield f"<title>{escape(title)}</title></head><body>\n"
    yield from _blocks(document.blocks, numbers, 0)
    if document.notes:
        yield '<section role="doc-endnotes"><ol>'
        for note in document.notes:
            yield f'<li id="{escape(note.id)}" role="doc-endnote">'
            yield from _blocks(note.blocks, numbers, 0)
            yield "</li>\n"
        yield "</ol></section>"
    yield "</body></html>"


def _blocks(
    blocks: Iterable[Block], numbers: Mapping[str, str], depth: int, *, styled: bool = False
) -> Iterator[str]:
    said = ""  # text of a picture, which its caption often repeats
    for block in blocks:
        if block.kind == "paragraph":
            content = block.content or []
            text = _plain(content)
            if not said or text != said:
                yield f"<p>{_inlines(content, numbers, styled=styled)}</p>\n"
            said = (content[0].alt or "").strip() if _is_picture(content) else ""
            continue
        said = ""
        yield from _block(block, numbers, min(depth, _DEEPEST))


def _block(block: Block, numbers: Mapping[str, str], depth: int) -> Iterator[str]:
    """HTML of a block that is no paragraph."""
    match block.kind:
        case "heading":
            anchor = f' id="{escape(block.anchor)}"' if block.anchor else ""
            level = min(max(block.level or 1, 1), 6)
            inner = _inlines(block.content or [], numbers, styled=True)
            yield f"<h{level}{anchor}>{inner}</h{level}>\n"
        case "list" if block.list is not None:
            yield from _list(block.list, numbers, depth)
        case "table" if block.table is not None:
            yield from _table(block.table, numbers, depth)
        case "block_quote":
            deeper = depth < _DEEPEST
            yield "<blockquote>" if deeper else "<div>"
            yield from _blocks(block.blocks or [], numbers, depth + 1, styled=True)
            yield "</blockquote>\n" if deeper else "</div>\n"
        case "code_block":
            yield f"<pre>\n{_text(block.text or '')}</pre>\n"
        case "math":
            yield f"<p>{_formula(block.text)}</p>\n"
        case "rule":
            yield "<hr>\n"
        case kind:
            yield f'<p><object aria-label="{escape(kind)}"></object></p>\n'


def _list(found: List, numbers: Mapping[str, str], depth: int) -> Iterator[str]:
    numbering = _NUMBERING.get(found.marker)
    labelled = any(item.marker_label for item in found.items)
    deeper = depth < _DEEPEST
    name = "ul" if numbering is None or labelled else "ol"
    if deeper:
        style = ' style="list-style: none"' if labelled else ""
        kind = f' type="{numbering}" start="{found.start}"' if name == "ol" else ""
        yield f"<{name}{style}{kind}>"
    for number, item in enumerate(found.items, found.start):
        yield "<li>" if deeper else "<div>"
        if labelled:
            label = "•" if numbering is None else f"{numeral(number, numbering)}."
            yield f"{_text(item.marker_label or label)} "
        blocks = item.blocks
        if blocks and blocks[0].kind == "paragraph":
            yield _inlines(blocks[0].content or [], numbers)
            blocks = blocks[1:]
        yield from _blocks(blocks, numbers, depth + 1)
        yield "</li>\n" if deeper else "</div>\n"
    if deeper:
        yield f"</{name}>\n"


def _table(table: Table, numbers: Mapping[str, str], depth: int) -> Iterator[str]:
    rows = [[slot.cell for slot in row if slot.cell is not None] for row in table.grid]
    if table.kind == "layout" or depth >= _DEEPEST:
        for cell in (cell for row in rows for cell in row):
            yield "<div>"
            yield from _blocks(cell.blocks, numbers, depth + 1)
            yield "</div>\n"
        return
    yield "<table>"
    for number, row in enumerate(rows):
        head = number < table.header_rows
        yield "<thead><tr>" if head else "<tr>"
        for cell in row:
            yield from _cell(cell, numbers, depth, head=head)
        yield "</tr></thead>\n" if head else "</tr>\n"
    yield "</table>\n"


def _cell(cell: Cell, numbers: Mapping[str, str], depth: int, *, head: bool) -> Iterator[str]:
    name = "th" if head else "td"
    yield f"<{name}"
    if cell.col_span > 1:
        yield f' colspan="{cell.col_span}"'
    if cell.row_span > 1:
        yield f' rowspan="{cell.row_span}"'
    yield ">"
    if all(block.kind == "paragraph" for block in cell.blocks):
        parts = (_inlines(block.content or [], numbers, styled=head) for block in cell.blocks)
        yield "<br>".join(parts)
    else:
        yield from _blocks(cell.blocks, numbers, depth + 1)
    yield f"</{name}>"


def _inlines(content: list[Inline], numbers: Mapping[str, str], *, styled: bool = False) -> str:
    """HTML of the inner of a block.

    If the block is styled, such as a heading, emphasis that all of its text has is the style's and
    is left out.
    """
    styles = [set(_style(inline) or ()) for inline in content if (inline.text or "").strip()]
    common = set.intersection(*styles) if styled and styles else set()
    parts = []
    for style, run in groupby(content, _style):
        if style is None:
            parts += [_inline(inline, numbers) for inline in run]
            continue
        tags = [tag for tag in style if tag not in common]
        inner = _text("".join(inline.text or "" for inline in run))
        opened = "".join(f"<{tag}>" for tag in tags)
        closed = "".join(f"</{tag}>" for tag in reversed(tags))
        parts.append(f"{opened}{inner}{closed}")
    return "".join(parts)


def _style(inline: Inline) -> tuple[str, ...] | None:
    """Tags of a text's style; None for what is no text."""
    if inline.kind != "text":
        return None
    style = inline.style
    if style is None:
        return ()
    has = (("b", style.bold), ("i", style.italic), ("s", style.strike), ("code", style.code))
    return tuple(tag for tag, there in has if there)


def _inline(inline: Inline, numbers: Mapping[str, str]) -> str:
    match inline.kind:
        case "link":
            # A link is underlined because it is one.
            inner = _UNDERLINE.sub("", _inlines(inline.content or [], numbers))
            target = inline.target
            if target is None:
                return inner
            address = f"#{target.value}" if target.kind == "anchor" else target.value
            return f'<a href="{escape(address)}">{inner}</a>'
        case "image":
            alt = (inline.alt or "").translate(STRAY).strip()
            return f'<img alt="{escape(alt)}">' if alt else "<img>"
        case "anchor":
            return f'<a id="{escape(inline.anchor or "")}"></a>'
        case "note_ref":
            note = inline.note_id or ""
            number = escape(numbers.get(note, note))
            return f'<a role="doc-noteref" href="#{escape(note)}">{number}</a>'
        case "line_break":
            return "<br>"
        case "math":
            return _formula(inline.text)
        case "checkbox":
            return "☑" if inline.checked else "☐"
    return _text(inline.text or "")


def _formula(tex: str | None) -> str:
    return f'<math alttext="{escape((tex or "").translate(STRAY))}"></math>'


def _text(text: str) -> str:
    """HTML of characters, of which some may be annotations."""
    return ANNOTATED.sub(_annotated, escape(text, quote=False)).translate(STRAY)


def _annotated(found: re.Match[str]) -> str:
    inner = found[2]
    for word in found[1].split("|"):
        name, _, value = word.partition("=")
        match name:
            case "sup" | "sub" | "u":
                inner = f"<{name}>{inner}</{name}>"
            case "lang":
                inner = f'<span lang="{value}">{inner}</span>'
            case "page":
                inner = f'<span role="doc-pagebreak" aria-label="{value}"></span>{inner}'
            case "object":
                inner = f'<canvas aria-label="{value}"></canvas>{inner}'
    return inner


def _plain(content: Iterable[Inline]) -> str:
    """Characters of a paragraph of nothing but text; empty if it has anything else."""
    inlines = list(content)
    if any(inline.kind != "text" for inline in inlines):
        return ""
    text = "".join(inline.text or "" for inline in inlines)
    return ANNOTATED.sub(r"\2", text).strip()


def _is_picture(content: list[Inline]) -> bool:
    return len(content) == 1 and content[0].kind == "image"
