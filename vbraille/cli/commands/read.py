"""``vbraille read``."""

from __future__ import annotations

import sys
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path, PurePath
from typing import TYPE_CHECKING

from vbraille.cli.atdevice import AtDevice, say_summary, surrounded
from vbraille.cli.build import (
    build_lengths,
    build_page,
    build_show,
    chosen_profile,
    lay_out,
    note_unseen_dots,
    open_to_resume,
)
from vbraille.cli.options.exploring import check_live_options
from vbraille.cli.terminal import say_line
from vbraille.config.settings import settle, with_profile
from vbraille.devices.registry import check_actuators, check_height, check_travel, find_driver
from vbraille.display import USUAL_RATE_HZ, check_rate
from vbraille.errors import InputError
from vbraille.reading.advancing import Scroll
from vbraille.reading.commands.table import bound_for
from vbraille.reading.device import HAND
from vbraille.reading.keyboard import Keyboard
from vbraille.reading.library import KeptPlaces
from vbraille.reading.outputs import Echo, language_of
from vbraille.render import MODELS, model_of
from vbraille.simulation.specs import is_simulated, parse_hand, refuse_hand
from vbraille.translate.documents.document import Document
from vbraille.wording import spelled

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterable

    from vbraille.cli.atdevice import Surroundings
    from vbraille.cli.build import Page
    from vbraille.devices.events import Event
    from vbraille.reading.activity import Activity
    from vbraille.reading.conventionalview import ConventionalView
    from vbraille.reading.device import OpenDevice
    from vbraille.reading.keyboard import StoppableKeyboard
    from vbraille.reading.lineviews import Figures
    from vbraille.reading.liveview import LastSentences, ReadState
    from vbraille.render import Model

_FIGURE_ROOM = 1 << 21  # bytes of the largest page with figures, or of a figure


def run(arguments: argparse.Namespace) -> int:
    """Read until the text ends, a key says so, or something goes wrong."""
    check_live_options(arguments)
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
        with surrounded(
            arguments,
            keyboard,
            wanted,
            hand,
            language_of(opened.book, arguments.language),
            echo=echo,
            often=arguments.rate is not None,
        ) as around:
            device, outputs = around.device, around.outputs
            also = _also(arguments, around)
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
                scroll=Scroll(),
                cue=outputs.cue,
                save_style=lambda style: _save(settings.path, profile, replace(model, style=style)),
                verbose=arguments.verbose,
                figures=lambda: _figures(page, Path(arguments.file).parent, device, rate_hz),
            )
            if opened.place is not None:
                outputs.say(f"book: {opened.book.source.title or opened.book.source.name}")
                device.reader.announce()
            if around.live is not None:
                around.live.show(lambda said, facts: _view(device, said, facts), hand)
            try:
                _Reading(page, around, keys, also).run()
            finally:
                opened.leave(device.reader, model, page.model.style)
    page.say_unknown()
    speed = f"mean scanning speed {device.tally.scanning_mm_s:.1f} mm/s"
    say_summary(device, f"lines {device.reader.lines}", rate_hz=rate_hz, speed=speed)
    return 0


class _Reading(AtDevice):
    """One reading, to the end of the text."""

    def __init__(
        self,
        page: Page,
        around: Surroundings,
        keys: StoppableKeyboard,
        also: ConventionalView | None,
    ) -> None:
        super().__init__(around, around.device.reader, keys)
        self._page = page
        self._also = also

    def run(self) -> None:
        """Read to the end; see `AtDevice.run`."""
        try:
            self._say_notes()
            super().run()
        finally:
            self._device.reader.leave()

    def _see(self, events: Iterable[Event]) -> None:  # noqa: ARG002 - the device obeys them
        device = self._device
        self._outputs.see(device.line)
        if device.reader.layout is self._page.layout:
            self._page.see(device.reader.line_number)
        self._say_notes()

    @property
    def _keyed(self) -> Activity:
        """Whoever feels a figure alone, or the reader."""
        return self._device.reader.under.alone or self._device.reader

    def _press(self, key: str) -> None:
        super()._press(key)
        self._device.reader.leave_figure()

    def _show(self) -> None:
        """Have what is under the hand stand on the conventional display, and obey its keys."""
        if self._also is not None:
            self._also.attend(self._device.reader)

    def _rest(self) -> None:
        if self._also is not None:
            self._also.rest()

    def _say_notes(self) -> None:
        """Say what is to be said of the text and of its table, which may have changed."""
        for note in self._device.reader.layout.book.notes():
            say_line(spelled(note), aside=True)


def _view(device: OpenDevice, said: LastSentences, facts: list[tuple[str, str]]) -> ReadState:
    """Describe what is read, as the state of the live view."""
    # Only a reading that has a live view waits for what it needs.
    from vbraille.reading.liveview import ReadState

    source, table = device.reader.layout.book.source, device.reader.layout.book.table
    tables = [] if table is None else [("table", table.name)]
    return ReadState(device, source.title or PurePath(source.name).name, said, [*tables, *facts])


def _also(arguments: argparse.Namespace, around: Surroundings) -> ConventionalView | None:
    """Conventional display that was asked for, which comes while the text is laid out."""
    if arguments.also is None:
        return None
    # Only a reading that has such a display needs what drives it.
    from vbraille.conventional.display import ConventionalDisplay
    from vbraille.reading.conventionalview import ConventionalView

    display = around.closing.enter_context(ConventionalDisplay(arguments.also))
    return ConventionalView(display, around.outputs.say)


def _figures(page: Page, folder: Path, device: OpenDevice, rate_hz: float) -> Figures:
    """Figures of the text; a text without any does not wait for what reads them."""
    from vbraille.reading.bookfigures import BookFigures

    def note(sentence: str) -> None:
        say_line(f"note: {sentence}", aside=True)

    return BookFigures(page.source, folder, device, note, rate_hz=rate_hz, room=_FIGURE_ROOM)


def _save(path: Path, profile: str, model: Model) -> str:
    """Save how braille feels in a profile, and give a sentence on that."""
    # Most readings save nothing, and need not wait for what writes settings.
    from vbraille.config.settings import save_profile

    return save_profile(path, profile, model)


def _echo(chosen: str | None) -> Echo:
    """How much is said of each line; at a terminal, speech must not read the book aloud."""
    if chosen is not None:
        return Echo(chosen)
    return Echo.NONE if sys.stdout.isatty() else Echo.BOTH
