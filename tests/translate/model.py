"""The rules for paragraphs once more, a character at a time and in plain Python."""

import unicodedata
from functools import cache
from typing import NamedTuple

BLANKS = "\t \u1680\u205f\u3000" + "".join(chr(c) for c in range(0x2000, 0x200B) if c != 0x2007)
NEWLINES = "\n\v\r\x85\u2028"
BREAKS = "\f\u2029"
DROPPED = "\xad\ufeff"
NO_BREAK = "\xa0\u2007\u202f"
ACCENTS = frozenset(map(chr, (*range(0x300, 0x370), *range(0x653, 0x656), 0x3099, 0x309A)))
SUSPENDED = ("and", "or", "to", "und", "oder", "bis", "et", "ou")
PIECE = 8192
BLANKS_KEPT = 4096
BULLETS, DASHES = "•‣◦⁃●○■▪*-", "–—+"


class Piece(NamedTuple):
    """Text, the place of each of its characters, and whether it goes on with the one before."""

    text: str
    source: list[int]
    continues: bool


def pieces_of(text: str, *, keep_lines: bool = False) -> list[Piece]:
    """All paragraphs of a text, the long ones cut."""
    text = "".join("\ufeff" if n in _struck(text) else c for n, c in enumerate(text))
    whole = _lines(text) if keep_lines else _paragraphs(text)
    return [piece for characters in whole for piece in _cut(characters)]


@cache
def _struck(text):
    """Places of backspaces, underlines and doubled letters that only told a printer of emphasis."""
    no_letters = BLANKS + NEWLINES + BREAKS + DROPPED
    struck = set()
    for at in range(1, len(text) - 1):
        before, after = text[at - 1], text[at + 1]
        if text[at] != "\b" or before == "\b" or before in no_letters or after in no_letters:
            continue
        if before in ("_", after):
            struck |= {at - 1, at}
        elif after == "_":
            struck |= {at, at + 1}
    return struck


def _paragraphs(text):
    done, characters, newlines, broken, gap = [], [], 0, False, False
    item = 0
    for at, c in enumerate(text):
        if c == "\n" and text[at - 1 : at] == "\r":
            continue
        if c in NEWLINES:
            newlines += 1
            gap = True
        elif c in BREAKS:
            broken = True
        elif c in BLANKS:
            gap = True
        elif c not in DROPPED:
            number = _item(text, at)
            if not characters or broken or newlines > 1:
                item = number
                done += [characters] if characters else []
                characters = []
            elif newlines and number and _goes_on(number, item, text[characters[-1][1]]):
                item = number
                done.append(characters)
                characters = []
            elif characters and gap and not _joins(text, characters[-1][1], at, newlines):
                characters.append((" ", characters[-1][1] + 1))
            characters.append(("\xa0" if c in NO_BREAK else c, at))
            newlines, broken, gap = 0, False, False
    return [*done, characters] if characters else done


def _item(text, at):
    """Number of the list item that begins here, -1 for a bullet, -2 for a dash, 0 for none."""
    first, blank, _ = text[at : at + 6].replace("\t", " ").replace("\xa0", " ").partition(" ")
    if not blank:
        return 0
    if len(first) == 1 and first in BULLETS + DASHES:
        return -1 if first in BULLETS else -2
    body, end = first.removeprefix("("), first[-1:]
    body = body[:-1]
    if body.isascii() and body.isdigit() and len(body) < 4 and end in ".)":
        return int(body)
    if len(body) == 1 and "a" <= body <= "z" and end == ")":
        return ord(body) - 96
    return 0


def _goes_on(number, item, before):
    if number in (-1, 1) or before == ":":
        return True
    return number == (item if item < 0 else item + 1)


def _joins(text, before, after, newlines):
    if newlines != 1:
        return False
    if text[before + 1] == "\xad":
        return True
    if text[before] not in "-\u2010" or before == 0:
        return False
    if not (text[before - 1].isalnum() and text[after].isalnum()):
        return False
    return text[after : after + 5].split()[0] not in SUSPENDED


def _lines(text):
    done, characters, blanks, empty = [], [], [], False
    for at, c in enumerate(f"{text}\n"):
        if c == "\n" and text[at - 1 : at] == "\r":
            continue
        if c in NEWLINES + BREAKS:
            if characters:
                done.append(characters)
                empty = False
            elif done and not empty:
                done.append([])
                empty = True
            characters, blanks = [], []
        elif c in BLANKS:
            blanks.append((" ", at))
        elif c not in DROPPED:
            characters += [*blanks[:BLANKS_KEPT], ("\xa0" if c in NO_BREAK else c, at)]
            blanks = []
    return done[:-1] if empty else done


def _cut(characters):
    text = "".join(c for c, _ in characters)
    start, continues = 0, False
    while len(text) - start > PIECE:
        window = text[start : start + PIECE + 1]
        sentences = [n + 2 for n in range(PIECE) if window[n : n + 2] in (". ", "! ", "? ", "… ")]
        spaces = [n + 1 for n in range(1, PIECE + 1) if window[n] == " "]
        if sentences and sentences[-1] > PIECE // 2 + 2:
            length = sentences[-1]
        elif spaces:
            length = spaces[-1]
        else:
            length = PIECE
            while length > PIECE // 2 and unicodedata.combining(window[length]):
                length -= 1
        yield _composed(characters[start : start + length], continues)
        start, continues = start + length, True
        if start == len(text):
            return
    yield _composed(characters[start:], continues)


def _composed(characters, continues):
    text, source = "", []
    for c, at in characters:
        together = unicodedata.normalize("NFC", text[-1:] + c)
        if c in ACCENTS and text and len(together) == 1:
            text = text[:-1] + together
        else:
            text += c
            source.append(at)
    return Piece(text, source, continues)
