"""Plain text as blocks: paragraphs and items of lists, or lines as they are."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from vbraille.translate.blocks import Block, BlockKind
from vbraille.translate.encodings import read_text_of, tidy

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.translate.source import Source

_NEWLINE = re.compile(r"\r\n?|[\v\x85\u2028]")
_PARAGRAPH = re.compile(r"\n[ \t\u3000]*\n\s*|\f\s*|\u2029\s*")
# Blanks that may break a line, which no-break spaces are not; but single spaces.
_BLANK = r"\t\n\r\u1680\u2000-\u2006\u2008-\u200a\u205f\u3000"
_BLANKS = re.compile(f"[{_BLANK}][ {_BLANK}]*| [ {_BLANK}]+")
# What told old printers to strike a character twice, or to underline it.
_STRUCK = re.compile("_\b(?=.)|(?<=.)\b_|(.)\b(?=\\1)")
# A word that a line's end cut, but not "pre-" before "and".
_CUT = re.compile(r"(?<=\w)([-\u2010])\n[ \t]*(?!(?:and|or|to|und|oder|bis|et|ou)\b)(?=\w)")
_ITEM = re.compile(
    r"[ \t]*(?:(?P<bullet>[•‣◦⁃●○■▪*])|(?P<dash>[-–—+])|\(?(?P<number>\d{1,3})[.)]"
    r"|\(?(?P<letter>[A-Za-z])[.)])[ \t\u00a0\u3000]+\S"
)


def read_text(
    source: Source, encoding: str | None = None, *, keep_lines: bool = False
) -> Iterator[Block]:
    """Read a text file."""
    return text_blocks(source, read_text_of(source, encoding), keep_lines=keep_lines)


def text_blocks(source: Source, text: str, *, keep_lines: bool = False) -> Iterator[Block]:
    """Blocks of a text."""
    text = _NEWLINE.sub("\n", text).replace("\u2007", "\u00a0").replace("\u202f", "\u00a0")
    text = _STRUCK.sub("", text)
    source.expected = len(text)
    if keep_lines:
        for line in text.rstrip("\n \t").split("\n"):
            yield Block(tidy(line.replace("\f", "").expandtabs()).rstrip(), BlockKind.LINE)
        return
    for paragraph in _PARAGRAPH.split(text):
        for item in _items(_CUT.sub(r"\1", paragraph.replace("\u00ad\n", ""))):
            words = _BLANKS.sub(" ", tidy(item)).strip(" \n")
            if words:
                yield Block(words)


def _items(paragraph: str) -> Iterator[str]:
    """Parts of a paragraph that begin with what an item of a list does.

    A bullet always begins an item. A dash does in a list of dashes; a number or a letter if it is
    the first or follows the last of its kind. Otherwise a line of prose can begin with either.
    """
    lines = paragraph.split("\n")
    markers = [_marker(line) for line in lines]
    item, last = lines[:1], markers[0]
    for at in range(1, len(lines)):
        kind, value = markers[at]
        is_first = value == 1 and (kind == "number" or (kind, 2) in markers[at:])
        follows = (kind, value - (value > 0)) == last
        if kind == "bullet" or (
            kind and (is_first or follows or lines[at - 1].rstrip().endswith(":"))
        ):
            yield "\n".join(item)
            item, last = [], markers[at]
        item.append(lines[at])
    yield "\n".join(item)


def _marker(line: str) -> tuple[str, int]:
    """Kind of the marker of the item that a line begins, and its number; "" and 0 for none."""
    found = _ITEM.match(line)
    if found is None or found.lastgroup is None:
        return "", 0
    if found["letter"]:
        return "letter", ord(found["letter"].lower()) - ord("a") + 1
    return found.lastgroup, int(found["number"] or 0)
