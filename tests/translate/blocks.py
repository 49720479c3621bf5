"""A source that is a list of blocks, for what no text file has."""

from vbraille.translate import Block, BlockKind, Document, Text


def text_of(string: str) -> Text:
    """Text of a string, nothing in it folded."""
    block = Document.from_text(string, keep_lines=True).block(0)
    return Text.empty() if block is None else block.text


def block_of(string: str, kind: BlockKind = BlockKind.PARAGRAPH, level: int = 0) -> Block:
    """Block of a kind, whose text begins at the source's first character."""
    return Block(text_of(string) if string else Text.empty(), kind, level)


class BlockList:
    """A source of these blocks."""

    name = "blocks"
    title = language = ""
    in_cells = False
    complete = True

    def __init__(self, *blocks: Block) -> None:
        self._blocks = blocks

    def block(self, number: int) -> Block | None:
        return self._blocks[number] if 0 <= number < len(self._blocks) else None

    def block_at(self, character: int) -> int | None:
        ends = (n for n, block in enumerate(self._blocks) if character < block.text.end)
        return next(ends, None)

    @property
    def end(self) -> int:
        return max((block.text.end for block in self._blocks), default=0)

    def progress(self, number: int) -> float:
        return number / len(self._blocks)

    def note(self) -> str | None:
        return None

    def sha256(self) -> str:
        return "0" * 64
