"""Where the chunks of a text begin, and whether a file is the one that this was found in."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

_SAMPLES, _SAMPLE_BYTES = 16, 1_024


@dataclass(frozen=True, slots=True)
class ChunkMark:
    """Place at which reading can go on, before a block's first character.

    Parameters
    ----------
    block
        Number of the next block, from 0.
    character
        Place of the block's first character in the document.
    offset, state
        A place in the file at or before that character, and the decoder's state there.
    skip
        Number of characters between that place and the block.
    continues
        Whether the block is a further piece of the block before.
    item
        Number of the list item that the block is a piece of; 0 for none.
    """

    block: int
    character: int
    offset: int
    state: tuple[bytes, int]
    skip: int
    continues: bool
    item: int = 0

    @property
    def bytes(self) -> int:
        """Estimated number of bytes before the place: a character takes at least one."""
        return self.offset + self.skip

    @property
    def row(self) -> tuple[int | str, ...]:
        """Values of the mark, as an index keeps them; bytes are in hexadecimal."""
        held, flag = self.state
        numbers = self.block, self.character, self.offset
        return (*numbers, held.hex(), flag, self.skip, int(self.continues), self.item)

    @classmethod
    def of_row(cls, row: Sequence[int | str]) -> ChunkMark:
        """Make the mark of an index's row."""
        block, character, offset, held, flag, skip, continues, item = row
        state = bytes.fromhex(str(held)), int(flag)
        block, character, offset, skip, item = map(int, (block, character, offset, skip, item))
        return cls(block, character, offset, state, skip, bool(continues), item)


def fingerprint(read: Callable[[int, int], bytes], size: int) -> str:
    """SHA-256 of samples from all of a file, in hexadecimal; a file of any size is done at once.

    Parameters
    ----------
    read
        Function that gives the bytes at an offset, and at most so many.
    size
        Number of bytes in the file.
    """
    digest = hashlib.sha256()
    last = max(size - _SAMPLE_BYTES, 0)
    for n in range(_SAMPLES):
        digest.update(read(n * last // (_SAMPLES - 1), _SAMPLE_BYTES))
    return digest.hexdigest()
