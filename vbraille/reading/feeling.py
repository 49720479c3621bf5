"""Commands that change how braille feels, and which braille it is, while the hand moves."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError, VbrailleError
from vbraille.knobs import KNOBS
from vbraille.reading.commands import command
from vbraille.render import MAPPINGS
from vbraille.render.braille.mappings import single_row
from vbraille.translate import Book, BrailleTable, find_table

if TYPE_CHECKING:
    from vbraille.reading.reader import Reader
    from vbraille.render import BrailleStyle
    from vbraille.render.braille.mappings import Mapping

# Keys for more and less of each knob, own and NVDA's.
_KEYS = {
    "texture": ("t", "T", "r", "R"),
    "contrast": ("c", "C", "c", "C"),
    "dot_width": ("d", "D", "d", "D"),
    "dot_spacing": ("s", "S", "s", "S"),
    "cell_gap": ("j", "J", "j", "J"),
}
_BAND_STEP, _BANDS = 0.1, (0.0, 1.0)  # in line pitches
_CONTRACTED = 2  # the grade that is asked for


def _turn(reader: Reader, name: str, steps: int) -> None:
    """Turn a knob by a step, and say where it stands."""
    knob = KNOBS[name]
    value = knob.value(reader.style)
    wanted = knob.turned(value, steps)
    if wanted == value:
        reader.refuse(f"{knob.said(value)} is the {'most' if steps > 0 else 'least'}")
    elif _tuned(reader, **{knob.field: wanted}):
        reader.say(knob.said(wanted))


def _tuned(reader: Reader, **changes: Any) -> bool:
    """Change the style, or say why that cannot be."""
    try:
        reader.tune(**changes)
    except (InputError, ValueError) as error:
        reader.refuse(str(error))
        return False
    return True


def _add_knobs() -> None:
    for name, (more, less, nvda_more, nvda_less) in _KEYS.items():
        label = KNOBS[name].label
        for way, step, key, nvda in (("more", 1, more, nvda_more), ("less", -1, less, nvda_less)):
            words = {"dot_width": ("wider dots", "narrower dots")}.get(
                name, (f"more {label}", f"less {label}")
            )[step < 0]
            called = f"{way}-{name.replace('_', '-')}"
            command(words, key, nvda, name=called)(partial(_turn, name=name, steps=step))


_add_knobs()


@command("next dot mapping", "#", steers=True)
def mapping(reader: Reader) -> None:
    style = reader.style
    found = _mappings(style, reader.device.display.rows)
    names = [each.name for each in found]
    here = names.index(style.mapping.name) if style.mapping.name in names else -1
    chosen = found[(here + 1) % len(found)]
    if _tuned(reader, mapping=chosen):
        reader.say(mapping_said(chosen))


@command("in the live view: the next mapping beside it", "|", steers=True)
def beside(reader: Reader) -> None:
    found = [None, *_mappings(reader.style, reader.device.display.rows)]
    at = found.index(reader.beside_mapping) if reader.beside_mapping in found else 0
    reader.beside_mapping = chosen = found[(at + 1) % len(found)]
    reader.say(f"beside: {'nothing' if chosen is None else mapping_said(chosen)}")


def _mappings(style: BrailleStyle, rows: int) -> list[Mapping]:
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
    now = reader.style.straying
    manner = "free" if now.manner == "line" else "line"
    said = "what lies under each contactor" if manner == "free" else "the line of the finger"
    _stray(reader, f"shown: {said}", manner=manner)


@command("wider band: leave a line of a page later", ")")
def wider_band(reader: Reader) -> None:
    _turn_band(reader, 1)


@command("narrower band: leave a line of a page sooner", "(")
def narrower_band(reader: Reader) -> None:
    _turn_band(reader, -1)


def _turn_band(reader: Reader, steps: int) -> None:
    low, high = _BANDS
    before = reader.style.straying.band
    band = round(min(max(before + steps * _BAND_STEP, low), high), 2)
    if band == before and reader.surface.rows:
        reader.refuse(f"band: {band:g} line pitches is the {'most' if steps > 0 else 'least'}")
    else:
        _stray(reader, f"band: {band:g} line pitches", band=band)


def _stray(reader: Reader, said: str, **changes: Any) -> None:
    if not reader.surface.rows:
        reader.refuse("only one line is shown; nothing to change")
    elif _tuned(reader, straying=replace(reader.style.straying, **changes)):
        reader.say(said)


@command("undo the last tuning change", "U", steers=True)
def undo(reader: Reader) -> None:
    if not reader.undo:
        reader.refuse("nothing to undo")
        return
    before, now = reader.undo.pop(), reader.style
    reader.use(before)
    said = [
        knob.said(knob.value(before))
        for knob in KNOBS.values()
        if knob.value(before) != knob.value(now)
    ]
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
    if table is None:
        reader.refuse("the text is in braille already")
    elif info is None or not info.language:
        reader.refuse(f"table {table.name} does not say its language; y chooses one")
    else:
        long = info.grade.isdecimal() and int(info.grade) >= _CONTRACTED
        _translate(reader, info.language, 1 if long else _CONTRACTED)


@command("translate by the table of a language", "y")
def language(reader: Reader) -> None:
    def answer(typed: str) -> None:
        if typed.strip():
            _translate(reader, typed.strip())
        else:
            reader.say("cancelled")

    if reader.book.table is None:
        reader.refuse("the text is in braille already")
    else:
        reader.ask("language, such as fr", answer)


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
        reader.lay_out(book)
    except InputError as error:
        reader.refuse(str(error))
        return
    reader.kept.set_options(table=None, language=language, grade=grade)
    reader.say(f"braille: {table.said}")
