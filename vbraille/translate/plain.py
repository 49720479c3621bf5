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
_STRUCK = re.compile(r"_\b(?=.)|(?<=.)\b_|(.)\b(?=\1)".replace(r"\b", "\b"))
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
    if "\b" in text:
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
    item, last, kind = [lines[0]], *_marker(lines[0])
    for number, line in enumerate(lines[1:], 1):
        value, its_kind = _marker(line)
        first = value == 1 and (its_kind == "number" or _goes_on(lines[number + 1 :], its_kind))
        after_colon = its_kind != "" and lines[number - 1].rstrip().endswith(":")
        follows = its_kind == kind and value == last + (its_kind in ("number", "letter"))
        if its_kind == "bullet" or (its_kind and (first or follows or after_colon)):
            yield "\n".join(item)
            item, last, kind = [], value, its_kind
        item.append(line)
    yield "\n".join(item)


def _goes_on(lines: list[str], kind: str) -> bool:
    """Tell whether a later line has the second marker of a kind, as of a list of letters."""
    return any(_marker(line) == (2, kind) for line in lines)


def _marker(line: str) -> tuple[int, str]:
    """Number of the item that a line begins, and the kind of its marker; (0, "") for none."""
    found = _ITEM.match(line)
    if found is None:
        return 0, ""
    if found["number"]:
        return int(found["number"]), "number"
    if found["letter"]:
        return ord(found["letter"].lower()) - ord("a") + 1, "letter"
    return 0, "bullet" if found["bullet"] else "dash"
