"""Commands that change how braille feels, and which braille it is, while the hand moves."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError, VbrailleError
from vbraille.knobs import KNOBS
from vbraille.reading.commands import Where, both_ways, command
from vbraille.render import MAPPINGS
from vbraille.render.braille.mappings import single_row
from vbraille.translate import Book, BrailleTable, find_table

if TYPE_CHECKING:
    from vbraille.reading.reader import Reader
    from vbraille.render.braille.mappings import Mapping

_BAND_STEP = 0.1  # in line pitches, of which it is 1 at most
_CONTRACTED = 2  # the grade that is asked for


def _turn(reader: Reader, step: int, name: str) -> None:
    """Turn a knob by a step, and say where it stands."""
    knob = KNOBS[name]
    value = knob.value(reader.style)
    wanted = knob.turned(value, step)
    if wanted == value:
        reader.refuse_beyond(knob.said(value), up=step > 0)
    else:
        _tune(reader, knob.said(wanted), **{knob.field: wanted})


def _tune(reader: Reader, said: str, **changes: Any) -> None:
    """Change the style, and say so, or why that cannot be."""
    try:
        reader.tune(**changes)
    except (InputError, ValueError) as error:
        reader.refuse(str(error))
    else:
        reader.say(said)


_BOTH = Where.BOOK | Where.SCREEN

for name, ways, keys, nvda in (
    ("texture", ("more texture", "less texture"), "t | T", "r | R"),
    ("contrast", ("more contrast", "less contrast"), "c | C", ""),
    ("dot_width", ("wider dots", "narrower dots"), "d | D", ""),
    ("dot_spacing", ("more dot spacing", "less dot spacing"), "s | S", ""),
    ("cell_gap", ("more cell gap", "less cell gap"), "j | J", ""),
):
    hyphened = name.replace("_", "-")
    # Dots of other sizes make other numbers of cells, which BRLTTY has been told.
    where = _BOTH if name in ("texture", "contrast") else Where.BOOK
    names = f"more-{hyphened} less-{hyphened}"
    both_ways(ways, keys, nvda, name=names, where=where)(partial(_turn, name=name))


@command("next dot mapping", "#", where=_BOTH, steers=True)
def mapping(reader: Reader) -> None:
    chosen = _after(reader.style.mapping, _mappings(reader))
    _tune(reader, mapping_said(chosen), mapping=chosen)


def _after(now: Any, found: list[Any]) -> Any:
    """Next of a list, its first after its last."""
    return found[(found.index(now) + 1) % len(found)] if now in found else found[0]


def _mappings(reader: Reader) -> list[Mapping]:
    style, rows = reader.style, reader.device.display.rows
    if style.mapping.rows == 1:
        return [single_row(row) for row in (1, 2, 3)]
    return [each for each in MAPPINGS.values() if each.rows <= rows - (style.first_row or 0)]


def mapping_said(mapping: Mapping) -> str:
    """Words for a mapping, such as "mapping: sheared" or "dot row: 2"."""
    if mapping.rows == 1:
        return f"dot row: {mapping.left[0] + 1}"
    return f"mapping: {mapping.name}"


@command("keep the finger on its line, or show what lies under each contactor", "=")
def straying(reader: Reader) -> None:
    if reader.style.straying.manner == "line":
        _stray(reader, "shown: what lies under each contactor", manner="free")
    else:
        _stray(reader, "shown: the line of the finger", manner="line")


@both_ways(
    ("wider band: leave a line of a page later", "narrower band: leave a line of a page sooner"),
    ") | (", name="wider-band narrower-band",
)  # fmt: skip
def band(reader: Reader, step: int) -> None:
    before = reader.style.straying.band
    value = round(min(max(before + step * _BAND_STEP, 0.0), 1.0), 2)
    said = f"band: {value:g} line pitches"
    if value == before and reader.rows:
        reader.refuse_beyond(said, up=step > 0)
    else:
        _stray(reader, said, band=value)


def _stray(reader: Reader, said: str, **changes: Any) -> None:
    if reader.rows:
        _tune(reader, said, straying=replace(reader.style.straying, **changes))
    else:
        reader.refuse("only one line is shown; nothing to change")


@command("undo the last tuning change", "U", steers=True)
def undo(reader: Reader) -> None:
    if not reader.undo:
        reader.refuse("nothing to undo")
        return
    before, now = reader.undo.pop(), reader.style
    reader.use(before)
    values = ((knob, knob.value(before)) for knob in KNOBS.values())
    said = [knob.said(value) for knob, value in values if value != knob.value(now)]
    if before.mapping != now.mapping:
        said.append(mapping_said(before.mapping))
    if before.straying != now.straying:
        said.append(f"band: {before.straying.band:g} line pitches")
    reader.say(f"undone: {', '.join(said)}")


@command("save the tuning", "P", "ctrl-w")
def save(reader: Reader) -> None:
    if reader.save is None:
        reader.refuse("no settings file to save in")
        return
    try:
        reader.say(reader.save(reader.style))
    except VbrailleError as error:  # reading goes on
        reader.refuse(f"not saved: {error}")


@command("contracted or uncontracted braille", "x", also="pins:CONTRACTED")
def contracted(reader: Reader) -> None:
    table = reader.book.table
    info = None if table is None else table.info
    if info is not None and info.language:
        long = info.grade.isdecimal() and int(info.grade) >= _CONTRACTED
        _translate(reader, info.language, 1 if long else _CONTRACTED)
    elif table is not None:
        reader.refuse(f"table {table.name} does not say its language; y chooses one")
    else:
        reader.refuse("the text is in braille already")


@command("translate by the table of a language", "y")
def language(reader: Reader) -> None:
    if reader.book.table is None:
        reader.refuse("the text is in braille already")
    else:
        reader.ask("language, such as fr", lambda typed: _translate(reader, typed))


def _translate(reader: Reader, language: str, grade: int | None = None) -> None:
    before = reader.book
    assert before.table is not None, "a text in braille is not translated"
    try:
        name = find_table(language, grade)
        if name == before.table.name:
            reader.say(f"braille: {before.table.said}, as before")
            return
        table = BrailleTable(name, before.table.undefined)
        book = Book(before.source, table, language=language, grade=grade, switch=before.switch)
        reader.lay_out(book, reader.place, under=reader.cell is not None)
    except InputError as error:
        reader.refuse(str(error))
        return
    reader.kept.set_options(table=None, language=language, grade=grade)
    reader.say(f"braille: {table.said}")
