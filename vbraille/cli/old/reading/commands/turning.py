"""Commands that change how the braille feels, or which braille it is, while the hand moves."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

from vbraille.config.settings import KNOBS, fixed, next_mapping, obstacle, say_mapping
from vbraille.errors import InputError, VbrailleError
from vbraille.render.braille.style import BAND_BOUNDS
from vbraille.translate import Book, BrailleTable, find_table
from vbraille.wording import spelled

if TYPE_CHECKING:
    from vbraille.cli.old.reading.reader import Reader
    from vbraille.config.options import StyleKnob
    from vbraille.render.braille.style import BrailleStyle, Straying


def turn(reader: Reader, name: str, steps: int) -> None:
    """Turn a knob up or down, as far as it goes.

    Parameters
    ----------
    name
        Name of the knob, such as "texture" or "dot_width_mm"; see `KNOBS`.
    steps
        Number of the knob's steps; negative turns it down.
    """
    knob = KNOBS[name]
    after = knob.turned(knob.value(reader.style), steps)
    _turn_knob(reader, knob, after, "most" if steps > 0 else "least")


def turn_to(reader: Reader, name: str, value: float) -> None:
    """Turn a knob to a value, as far as it goes; what it has already is not told again.

    Parameters
    ----------
    reader
        Reader whose style it is.
    name
        Name of the knob, as for `turn`.
    value
        Value that is wanted, a finite number.
    """
    knob = KNOBS[name]
    before = knob.value(reader.style)
    if value != before:
        _turn_knob(reader, knob, knob.nearest(value), "most" if value > before else "least")


def change_mapping(reader: Reader) -> None:
    """Take the next way in which actuators show dots, of those that the display can show."""
    style, display = reader.style, reader.engine.display
    mapping = next_mapping(style, display)
    if mapping == style.mapping:
        reader.say_limit(f"{say_mapping(mapping)}, the only one for this display")
    else:
        _turn(reader, "mapping", mapping, say_mapping(mapping))


def show_beside(reader: Reader) -> None:
    """Show the line in the next mapping beside the array in the live view, or in none any more."""
    style, display = reader.style, reader.engine.display
    now = style if reader.beside is None else style.replace(mapping=reader.beside)
    mapping = next_mapping(now, display)
    reader.beside = None if mapping == style.mapping else mapping
    reader.say(f"beside: {'nothing' if reader.beside is None else say_mapping(mapping)}")


def undo_turn(reader: Reader) -> None:
    """Take back the last turn that was not taken back yet."""
    if not reader.styles_before:
        reader.say_limit("undo: nothing was turned")
        return
    style = reader.styles_before.pop()
    said = _differences(reader.style, style)
    reader.tune(**_fields(style))
    reader.say(f"undo: {said}")


def save_settings(reader: Reader) -> None:
    """Save the present tuning in the profile in use."""
    if reader.save_style is None:
        reader.say_limit("saved: nothing, since no settings file is in use")
    else:
        try:
            reader.say(reader.save_style(reader.style))
        except VbrailleError as error:  # reading goes on
            reader.say(f"not saved: {spelled(str(error))}")


def _turn_knob(reader: Reader, knob: StyleKnob, after: float, end: str) -> None:
    """Give a knob a value, or say that it is at its end in that direction, and why."""
    style = reader.style
    value = knob.value(style)
    why = fixed(knob, style) or obstacle(knob, style.geometry, reader.engine.display, after)
    if why or after == value:
        reader.say_limit(f"{knob.said(value)}, the {end}{why and f': {why}'}")
    else:
        _turn(reader, knob.field, after, knob.said(after))


def _turn(reader: Reader, field: str, value: object, sentence: str) -> None:
    """Show another style, and say what has changed."""
    before = reader.style
    reader.tune(**{field: value})
    reader.styles_before.append(before)
    reader.say(sentence)


def _fields(style: BrailleStyle) -> dict[str, Any]:
    """All that commands of this module change in a style."""
    names = ("geometry", "tuning", "mapping", "straying")
    return {name: getattr(style, name) for name in names}


def _differences(one: BrailleStyle, other: BrailleStyle) -> str:
    """Words for the values of a style that differ from another's."""
    said = [
        knob.said(knob.value(other))
        for knob in KNOBS.values()
        if knob.value(one) != knob.value(other)
    ]
    if one.mapping != other.mapping:
        said.append(say_mapping(other.mapping))
    return ", ".join(said).replace(": ", " ")


_BAND_STEP: Final = 0.1  # of the band, in line pitches
_STRAYING: Final = {
    "line": "straying: the finger is kept on its line",
    "free": "straying: each actuator shows what lies under it",
}


def turn_page(reader: Reader, step: int) -> None:
    """Turn to the next page of the surface, or to the one before; one line is a page, too."""
    if not reader.turn_page(step):
        reader.say_limit("last page" if step > 0 else "first page")
    elif not reader.under.rows:
        reader.announce()


def change_straying(reader: Reader) -> None:
    """Keep the finger on its line of a page, or show what lies under each actuator."""
    straying = reader.style.straying
    manner = "free" if straying.manner == "line" else "line"
    _show_straying(reader, replace(straying, manner=manner), _STRAYING[manner])


def turn_band(reader: Reader, steps: int) -> None:
    """Make the band of a line wider, or narrower if negative."""
    straying = reader.style.straying
    low, high = BAND_BOUNDS
    band = round(min(max(straying.band + steps * _BAND_STEP, low), high), 2)
    if band == straying.band:
        reader.say_limit(f"band: {band:g} line pitches, the {'most' if steps > 0 else 'least'}")
    else:
        _show_straying(reader, replace(straying, band=band), f"band: {band:g} line pitches")


def _show_straying(reader: Reader, straying: Straying, sentence: str) -> None:
    """Show pages with another straying, which can be taken back, and say what has changed."""
    if reader.under.rows:
        _turn(reader, "straying", straying, sentence)
    else:
        reader.say_limit("straying: one line is under the hand, and the finger cannot leave it")


_CONTRACTED = 2  # the grade that is asked for


def contracted(reader: Reader) -> None:
    """Change between contracted and uncontracted braille of the same language."""
    table = reader.layout.book.table
    if table is None:
        reader.say("table: the text is in braille already")
        return
    info = table.info
    if info is None or not info.language:
        reader.say(f"table: {table.name} does not say its language; choose one by language")
        return
    book, before = reader.layout.book, reader.book_before
    if before is not None and before[0] is book:
        # As it was, with whatever grade passages in other languages had.
        _show_book(reader, before[1])
        return
    grade = 1 if info.grade.isdecimal() and int(info.grade) >= _CONTRACTED else _CONTRACTED
    _change(reader, info.language, grade)


def ask_language(reader: Reader) -> None:
    """Ask for a language and translate with its usual table."""
    if reader.layout.book.table is None:
        reader.say("table: the text is in braille already")
    else:
        reader.ask("language", "type its tag such as fr, Enter", "language", _change)


def skip_blank(reader: Reader) -> None:
    """Pass over lines without a dot, or no longer."""
    skips = not reader.range.skip_blank
    reader.range = replace(reader.range, skip_blank=skips)
    reader.say(f"blank lines: {'skipped' if skips else 'read'}")


def scroll(reader: Reader) -> None:
    """Have the next line come by time, or no longer."""
    reader.scroll.on = not reader.scroll.on
    reader.say(f"autoscroll: {reader.scroll.words if reader.scroll.on else 'off'}")


def change_speed(reader: Reader, step: int) -> None:
    """Have lines come sooner, or later if the step is -1."""
    scroll = reader.scroll
    if scroll.turn(step):
        reader.say(f"autoscroll: {scroll.words}")
    else:
        end = "fastest" if step > 0 else "slowest"
        reader.say_limit(f"autoscroll: {scroll.words}, the {end}")


def _change(reader: Reader, language: str, grade: int | None = None) -> None:
    """Translate with another table from now on; the same text stays under the finger."""
    book = reader.layout.book
    assert book.table is not None, "a text in braille is not translated"
    try:
        name = find_table(language, grade)
        if name == book.table.name:
            reader.say(f"table: {book.table.said}, as before")
            return
        if name == find_table(language):
            grade = None  # the usual one, with which passages have what is usual in theirs
        other = BrailleTable(name, book.table.how)
        _show_book(
            reader, Book(book.source, other, language=language, grade=grade, switch=book.switch)
        )
    except InputError as error:
        reader.say(f"table: {spelled(str(error))}")


def _show_book(reader: Reader, book: Book) -> None:
    """Show a book by another table, and say by which.

    Raises
    ------
    InputError
        If it cannot be laid out.
    """
    before = reader.layout.book
    reader.lay_out_again(book=book)
    reader.book_before = (book, before)
    if book.table is not None:
        reader.say(f"table: {book.table.said}")
