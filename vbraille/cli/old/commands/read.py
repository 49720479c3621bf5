"""``vbraille read``."""

from __future__ import annotations

import sys
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path, PurePath
from typing import TYPE_CHECKING

from vbraille.cli.old.build import (
    build_lengths,
    build_page,
    build_show,
    chosen_profile,
    lay_out,
    note_unseen_dots,
    open_to_resume,
)
from vbraille.cli.old.exploring import around_device, say_summary
from vbraille.cli.old.terminal import say_line
from vbraille.config.settings import settle, with_profile
from vbraille.devices.registry import check_actuators, check_height, check_travel, find_driver
from vbraille.display import USUAL_RATE_HZ, check_rate
from vbraille.errors import InputError
from vbraille.reading.commands.table import bound_for
from vbraille.reading.device import HAND
from vbraille.reading.exploration import Exploration
from vbraille.reading.keyboard import Keyboard
from vbraille.reading.library import KeptPlaces
from vbraille.reading.outputs import Echo, Output, language_of
from vbraille.render import MODELS, model_of
from vbraille.simulation.specs import is_simulated, parse_hand, refuse_hand
from vbraille.translate.documents.document import Document
from vbraille.wording import spelled

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    from vbraille.cli.old.build import Page
    from vbraille.cli.old.exploring import Around
    from vbraille.devices.events import Event
    from vbraille.reading.device import OpenDevice
    from vbraille.reading.lineviews import Figures
    from vbraille.reading.liveview import LiveView
    from vbraille.render import Model

_FIGURE_ROOM = 1 << 21  # bytes of the largest page with figures, or of a figure


def run(arguments: argparse.Namespace) -> int:
    """Read until the text ends, a key says so, or something goes wrong."""
    settings = settle(arguments)
    profile = chosen_profile(arguments, settings)
    rate_hz = USUAL_RATE_HZ if arguments.rate is None else check_rate(arguments.rate)
    refuse_hand(arguments.device, hand=arguments.hand, seed=arguments.seed)
    bound = bound_for(settings, arguments.keys)
    hand = HAND if arguments.hand is None else arguments.hand
    # An unknown hand is refused before anything is opened.
    parse_hand(hand, pointed=arguments.monitor)
    echo = _echo(arguments.echo)
    # Display that the options ask for: a simulated device is like it, a real device is what it is.
    asked = build_lengths(arguments, MODELS[arguments.model or "stress2"])
    wanted = build_page(arguments, replace(asked, display=asked.on(asked.style.geometry, rate_hz)))
    wanted = wanted.display
    if arguments.model is not None or is_simulated(arguments.device):
        build_show(arguments, asked)
    find_driver(arguments.device)
    with ExitStack() as closing, Keyboard(beside=arguments.file == "-") as keyboard:
        if arguments.advance == "key" and not keyboard.attached:
            raise InputError("--advance key needs a terminal to type at; leave it out without one")
        # A text or a table that is not there is refused before anything is begun or compiled.
        places = closing.enter_context(KeptPlaces.open())
        opened = open_to_resume(arguments, places)
        closing.callback(opened.book.source.close)
        with around_device(
            arguments,
            keyboard,
            wanted,
            hand,
            language_of(opened.book, arguments.language),
            echo=echo,
            often=arguments.rate is not None,
        ) as around:
            device, outputs = around.device, around.outputs
            _show_also(arguments, around)
            display = device.find()
            rate_hz = min(rate_hz, display.rate_hz)
            if arguments.model is not None:
                check_actuators(display, wanted)
            own = with_profile(settings, profile, model_of(display))
            model = build_show(arguments, opened.tuned(own))
            if arguments.travel is not None:
                check_travel(display, arguments.travel)
            check_height(display, arguments.height)
            model = build_page(arguments, build_lengths(arguments, model, display.travel_mm))
            page = lay_out(arguments, opened.book, model, arguments.cells, opened.place)
            note_unseen_dots(page)
            device.start(page.model, None if isinstance(page.source, Document) else _FIGURE_ROOM)
            keys = around.keys()
            seeker = opened.seeker(arguments)
            if seeker is not None:
                around.closing.enter_context(seeker)
            device.show(
                page.layout,
                first=page.first,
                last=page.last,
                at=None if opened.place is None else opened.place.character,
                advance=arguments.advance == "return",
                echo=echo,
                bound=bound,
                seeker=seeker,
                kept=opened.kept,
                cue=outputs.cue,
                save_style=lambda style: _save(settings.path, profile, replace(model, style=style)),
                verbose=arguments.verbose,
                figures=lambda: _figures(arguments, page, around, rate_hz),
            )
            if opened.place is not None:
                outputs.say(f"book: {opened.book.source.title or opened.book.source.name}")
                device.reader.announce()
            outputs.add(_Notes(page, device))
            if around.live is not None:
                _show_live(around.live, device, hand)
            try:
                Exploration(device.reader, device, keys, outputs).run()
            finally:
                device.reader.leave()
                opened.leave(device.reader, model, page.model.style)
    page.say_unknown()
    speed = f"mean scanning speed {device.tally.scanning_mm_s:.1f} mm/s"
    say_summary(device, f"lines {device.reader.lines}", rate_hz=rate_hz, speed=speed)
    return 0


class _Notes(Output):
    """Notes on the text and its table, and a count of the characters that could not be written."""

    def __init__(self, page: Page, device: OpenDevice) -> None:
        self._page, self._device = page, device

    def attend(self, events: Sequence[Event] = ()) -> None:  # noqa: ARG002 - which are said
        """Count what is on the line under the hand, and say what is to be said of the text."""
        reader = self._device.reader
        if reader.layout is self._page.layout:
            self._page.see(reader.line.number)
        for note in reader.layout.book.notes():
            say_line(spelled(note), aside=True)


def _show_live(live: LiveView, device: OpenDevice, hand: str) -> None:
    """Show what is read on the pages of the live view."""
    # Only a reading that has a live view waits for what it needs.
    from vbraille.reading.liveview import ReadState

    book = device.reader.layout.book
    facts = [] if book.table is None else [("table", book.table.name)]
    facts += [] if device.pointer is None else [("hand", hand)]
    title = book.source.title or PurePath(book.source.name).name
    live.show(ReadState(device, title, live.said, facts))


def _show_also(arguments: argparse.Namespace, around: Around) -> None:
    """Have the conventional display that was asked for come while the text is laid out."""
    if arguments.also is None:
        return
    # Only a reading that has such a display needs what drives it.
    from vbraille.conventional.display import ConventionalDisplay
    from vbraille.reading.conventionalview import ConventionalView

    display = ConventionalDisplay(arguments.also)
    around.outputs.add(ConventionalView(display, lambda: around.device.reader, around.outputs.say))


def _figures(arguments: argparse.Namespace, page: Page, around: Around, rate_hz: float) -> Figures:
    """Figures of the text; a text without any does not wait for what reads them."""
    from vbraille.reading.bookfigures import BookFigures

    def note(sentence: str) -> None:
        say_line(f"note: {sentence}", aside=True)

    return BookFigures(
        page.source,
        Path(arguments.file).parent,
        around.device,
        note,
        rate_hz=rate_hz,
        room=_FIGURE_ROOM,
        sound=around.outputs.sound,
        sounding=arguments.sounds,
    )


def _save(path: Path, profile: str, model: Model) -> str:
    """Save how braille feels in a profile, and give a sentence on that."""
    # Most readings save nothing, and need not wait for what writes settings.
    from vbraille.config.settings import save_profile

    return save_profile(path, profile, model)


def _echo(chosen: str | None) -> Echo:
    """Choose the echo; at a terminal, speech must not read the book aloud."""
    if chosen is not None:
        return Echo(chosen)
    return Echo.NONE if sys.stdout.isatty() else Echo.BOTH
