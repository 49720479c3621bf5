"""Documents in pieces, and texts that are made by chance."""

import io
import itertools
import random
from functools import cache

from tests.conftest import SEED
from tests.translate.model import Piece
from vbraille.translate import Block, Document

GAPS = [" "] * 40 + ["\n"] * 8 + ["\r\n", "\r", "  ", "\t", "-\n", "\xad\n", "\x85", "\u2028"]
ENDS = ["\n\n", "\r\n\r\n", "\n \n", "\f", "\u2029", "\n\n\n\n\n"]
STRAYS = ["\xa0", "\xad", "\ufeff", "\0", "\x1b", "e\u0301", "😀", "漢字", "и", "\u202f"]


class Repeated(io.RawIOBase):
    """A file in which one text stands again and again, of any size; counts what is read."""

    def __init__(self, text: bytes, size: int) -> None:
        super().__init__()
        self.text, self.size, self.at, self.taken = text, size, 0, 0

    def seekable(self) -> bool:
        return True

    def seek(self, offset, whence=io.SEEK_SET):
        self.at = offset if whence == io.SEEK_SET else self.size + offset
        return self.at

    def read(self, size=-1):
        size = min(size, self.size - self.at)
        start = self.at % len(self.text)
        self.at += size
        self.taken += size
        return (self.text * (1 + (start + size) // len(self.text)))[start : start + size]


def document(raw: bytes, encoding: str | None = None, *, keep_lines: bool = False) -> Document:
    return Document(io.BytesIO(raw), "a.txt", encoding, keep_lines=keep_lines)


def blocks(document: Document) -> list[Block]:
    return list(iter_blocks(document))


def iter_blocks(document: Document):
    found = map(document.block, itertools.count())
    return itertools.takewhile(lambda block: block is not None, found)


def pieces(document: Document) -> list[Piece]:
    return [piece(p) for p in iter_blocks(document)]


def piece(block: Block) -> Piece:
    return Piece(str(block.text), block.text.places.tolist(), block.continues)


@cache
def made_text(words: tuple[str, ...], length: int, *, ends: bool) -> str:
    """Words and what may stand between them, drawn by chance, and the same every time."""
    chance = random.Random(SEED)
    text, size = [], 0
    while size < length:
        word = chance.choice(words)
        if chance.random() < 0.1:
            word += chance.choice(STRAYS) + chance.choice(words)
        gap = chance.choice(ENDS if ends and chance.random() < 0.02 else GAPS)
        text.append(word + gap)
        size += len(text[-1])
    return "".join(text)
