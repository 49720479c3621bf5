"""Tables as full grids: each cell stands in all rows and columns that it covers."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.translate.blocks import Block, BlockKind, Mark, MarkKind

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.translate.trees import Element

BETWEEN = "  "  # cells of a row
EMPTY = (
    "⠐⠐⠐"  # three unspaced dots 5, as the Braille Authority of North America writes an empty cell
)
_MOST = 1_000  # columns or rows that one cell covers
_EMPHASES = (MarkKind.BOLD, MarkKind.ITALIC, MarkKind.UNDERLINE)  # of a head, which has them anyway
_LAYING_OUT = (BlockKind.HEADING, BlockKind.QUOTE, BlockKind.LINE, BlockKind.ROW, BlockKind.NOTE)


@dataclass(slots=True)
class _Cell:
    """A cell with its text, wherever in the grid it stands."""

    blocks: list[Block]
    whole: Block
    is_header: bool
    identity: str
    named: list[str]
    columns: int
    rows: int


def table_blocks(
    table: Element, read: Callable[[Element], list[Block]], *, lays_out: bool
) -> Iterator[Block]:
    """Rows of a table; or the blocks of its cells, if it only puts them beside each other.

    Parameters
    ----------
    table
        Element of the table.
    read
        Function that reads the blocks of a cell.
    lays_out
        Whether the table says that it is none.
    """
    heads, rows = [], []
    for row, is_head in _rows(table):
        heads.append(is_head)
        rows.append([_cell(each, read) for each in row.elements if each.name in ("td", "th")])
    cells = [cell for row in rows for cell in row]
    kinds = [block.kind for cell in cells for block in cell.blocks]
    if lays_out or len(cells) <= 1 or any(kind in _LAYING_OUT for kind in kinds):
        for cell in cells:
            yield from cell.blocks
        return
    texts = {cell.identity: cell.whole.text for cell in cells if cell.identity}
    headers: dict[int, str] = {}
    for row, is_head, line in zip(rows, heads, _grid(rows), strict=True):
        yield from (b for cell in row for b in cell.blocks if b.kind is BlockKind.PAGE)
        shown = line[:1] if len({id(cell) for cell in line}) == 1 else line
        if not any(cell is not None and cell.whole.text for cell in shown):
            continue
        is_head = is_head or (len(row) > 1 and all(c.is_header or not c.whole.text for c in row))
        told = [
            " ".join(
                texts.get(name, "")
                for name in cell.named
                if name in texts and name != _row_head(row)
            )
            if cell is not None and cell.named
            else headers.get(column, "")
            for column, cell in enumerate(shown)
        ]
        if is_head:
            for column, cell in enumerate(line):
                text = "" if cell is None else cell.whole.text
                headers[column] = f"{headers.get(column, '')} {text}".strip()
        block = joined(
            [_EMPTY if c is None or not c.whole.text else c.whole for c in shown], BETWEEN
        )
        told = [] if is_head or not any(told) else told
        marks = tuple(m for m in block.marks if not is_head or m.kind not in _EMPHASES)
        yield block.replace(kind=BlockKind.ROW, level=0, headers=tuple(told), marks=marks)


_EMPTY = Block(EMPTY)


def _row_head(row: list[_Cell]) -> str:
    """Name of the cell that heads a row, which is said with the row and not above it."""
    return row[0].identity if row and row[0].is_header else ""


def _rows(table: Element, *, is_head: bool = False) -> Iterator[tuple[Element, bool]]:
    """Rows of a table, with whether they are its head; not those of tables in it."""
    for child in table.elements:
        if child.name == "tr":
            yield child, is_head
        elif child.name in ("thead", "tbody", "tfoot"):
            yield from _rows(child, is_head=child.name == "thead")


def _cell(element: Element, read: Callable[[Element], list[Block]]) -> _Cell:
    blocks = read(element)
    return _Cell(
        blocks,
        joined([block for block in blocks if block.kind is not BlockKind.PAGE], " "),
        element.name == "th" or element.get("role") in ("columnheader", "rowheader"),
        element.get("id"),
        element.get("headers").split(),
        _span(element.get("colspan")),
        _span(element.get("rowspan")),
    )


def _span(value: str) -> int:
    return min(max(int(value), 1), _MOST) if re.fullmatch(r"\s*\d{1,6}\s*", value) else 1


def _grid(rows: list[list[_Cell]]) -> list[list[_Cell | None]]:
    """Cells of each row by columns, those above that reach into it among them."""
    grid: list[list[_Cell | None]] = []
    above: dict[int, tuple[_Cell, int]] = {}  # by column: a cell, and rows that it goes on for
    for row in rows:
        line: list[_Cell | None] = []
        waiting = list(row)
        while waiting or any(column >= len(line) for column in above):
            column = len(line)
            if column in above:
                cell, more = above.pop(column)
                line.append(cell)
                if more > 1:
                    above[column] = cell, more - 1
                continue
            if not waiting:
                line.append(None)
                continue
            cell = waiting.pop(0)
            for over in range(column, column + cell.columns):
                line.append(cell)
                if cell.rows > 1:
                    above[over] = cell, cell.rows - 1
        grid.append(line)
    most = max((len(row) for row in grid if len(set(map(id, row))) > 1), default=0)
    return [
        line if len(line) >= most and len(set(map(id, line))) == 1
        else line[: max(most, 1)] + [None] * (most - len(line))
        for line in grid
    ]  # fmt: skip


def joined(blocks: list[Block], between: str) -> Block:
    """One block of several, with their marks and anchors."""
    if not blocks:
        return Block("")
    text, marks, anchors = "", [], ()
    for block in blocks:
        text += between if text and block.text else ""
        marks += [
            Mark(mark.kind, mark.start + len(text), mark.end + len(text), mark.target)
            for mark in block.marks
        ]
        text += block.text
        anchors += block.anchors
    return blocks[0].replace(text=text, marks=tuple(marks), anchors=anchors)
