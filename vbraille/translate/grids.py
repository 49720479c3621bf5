"""Tables as full grids: each cell stands in all rows and columns that it covers."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from vbraille.translate.blocks import Block, BlockKind, MarkKind, cut_marks
from vbraille.translate.numbering import MOST, counted

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.translate.trees import Element

BETWEEN = "  "  # cells of a row
# Three unspaced dots 5, as the Braille Authority of North America writes an empty cell.
EMPTY = Block("⠐⠐⠐")
EMPHASES = (MarkKind.BOLD, MarkKind.ITALIC, MarkKind.UNDERLINE)
_LAYING_OUT = (BlockKind.HEADING, BlockKind.QUOTE, BlockKind.LINE, BlockKind.ROW, BlockKind.NOTE)


class _Cell(NamedTuple):
    """A cell with its text, wherever in the grid it stands."""

    element: Element
    blocks: list[Block]
    whole: Block


def table_blocks(table: Element, read: Callable[[Element], list[Block]]) -> Iterator[Block]:
    """Rows of a table; or the blocks of its cells, if it only puts them beside each other.

    Parameters
    ----------
    table
        Element of the table.
    read
        Function that reads the blocks of a cell.
    """
    rows = list(_rows(table, read))
    cells = [cell for _, row in rows for cell in row if cell.element.name != "above"]
    kinds = [block.kind for cell in cells for block in cell.blocks]
    lays_out = bool(table.words & {"presentation", "none"})
    if lays_out or len(cells) <= 1 or any(kind in _LAYING_OUT for kind in kinds):
        for cell in cells:
            yield from cell.blocks
        return
    texts = {cell.element.get("id"): cell.whole.text for cell in cells}
    headers: dict[int, str] = {}
    for (is_head, row), line in zip(rows, _grid([row for _, row in rows]), strict=True):
        yield from (b for cell in row for b in cell.blocks if b.kind is BlockKind.PAGE)
        shown = line[:1] if len(set(map(id, line))) == 1 else line
        wholes = [cell.whole if cell and cell.whole.text else EMPTY for cell in shown]
        if all(each is EMPTY for each in wholes):
            continue
        # The cell that heads a row is said with the row, and not above its cells.
        own = row[0].element.get("id") if row and row[0].element.name == "th" else ""
        told = []
        for column, cell in enumerate(shown):
            named = cell.element.get("headers").split() if cell else []
            said = " ".join(texts[name] for name in named if name in texts and name != own)
            told.append(said if named else headers.get(column, ""))
        block = joined(wholes, BETWEEN)
        kinds = {cell.element.name for cell in row if cell.whole.text}
        if is_head or (kinds == {"th"} and len(row) > 1):
            for column, cell in enumerate(line):
                text = cell.whole.text if cell else ""
                headers[column] = f"{headers.get(column, '')} {text}".strip()
            marks = tuple(mark for mark in block.marks if mark.kind not in EMPHASES)
            block, told = block.replace(marks=marks), []
        yield block.replace(kind=BlockKind.ROW, level=0, headers=tuple(told) if any(told) else ())


def _rows(
    table: Element, read: Callable[[Element], list[Block]], *, is_head: bool = False
) -> Iterator[tuple[bool, list[_Cell]]]:
    """Rows of a table, with whether they are its head; not those of tables in it."""
    for child in table.elements:
        if child.name == "tr":
            row = []
            for element in child.elements:
                if element.name in ("td", "th", "above"):
                    blocks = read(element)
                    texts = [block for block in blocks if block.kind is not BlockKind.PAGE]
                    row.append(_Cell(element, blocks, joined(texts, " ")))
            yield is_head, row
        elif child.name in ("thead", "tbody", "tfoot"):
            yield from _rows(child, read, is_head=child.name == "thead")


def _grid(rows: list[list[_Cell]]) -> list[list[_Cell | None]]:
    """Cells of each row by columns, those above that reach into it among them."""
    lines: list[dict[int, _Cell]] = [{} for _ in rows]
    for number, row in enumerate(rows):
        column = 0
        for cell in row:
            while column in lines[number]:
                column += 1
            spanned = counted(cell.element.get("colspan"))
            columns = range(column, column + (spanned if column + spanned <= MOST else 1))
            if cell.element.name == "above":  # of a word processor: the cell above goes on
                cell = lines[number - 1].get(column, cell)
            for line in lines[number : number + counted(cell.element.get("rowspan"))]:
                line.update(dict.fromkeys(columns, cell))
            column = columns.stop
    # A row that is one cell does not make the table wider.
    parted = [line for line in lines if len(set(map(id, line.values()))) > 1]
    most = max((max(line) + 1 for line in parted), default=1)
    return [[line.get(column) for column in range(most)] for line in lines]


def joined(blocks: list[Block], between: str, like: Block | None = None) -> Block:
    """One block of several, with their marks and anchors; all else is that of the first."""
    if not blocks:
        return Block("")
    text, marks, anchors = "", (), ()
    for block in blocks:
        text += between if text and block.text else ""
        marks += cut_marks(block.marks, 0, len(block.text), len(text))
        text += block.text
        anchors += block.anchors
    return (like or blocks[0]).replace(text=text, marks=marks, anchors=anchors)
