"""The live view as an output: what pages are told of a reading, and what they ask for."""

from __future__ import annotations

import base64
from collections import deque
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vbraille.devices.base import Placing
from vbraille.errors import InputError
from vbraille.knobs import KNOBS
from vbraille.live.messages import (
    CardShown,
    CommandShown,
    KnobShown,
    LetGo,
    LineShown,
    Point,
    SceneShown,
    SignalShown,
    Turn,
    ViewState,
)
from vbraille.live.states import (
    array_shown,
    geometry_shown,
    line_shown,
    rows_shown,
)
from vbraille.reading.commands import Where, table
from vbraille.reading.outputs import Cue, Output
from vbraille.reading.surface import Part
from vbraille.simulation import steering

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.live.view import LiveView
    from vbraille.pictures.loading import LoadedScene
    from vbraille.reading.device import ReadingDevice
    from vbraille.reading.explored import Explored

_MOST_SAID, _MOST_DRAWN = 20, 8
_AROUND = (-2, -1, 1, 2, 3)  # lines that are shown around the one under the hand, by their steps
_EVERY = 2  # polls from one state to the next
_NUMBER = 0xFFFF_FFFF  # as much of a line's number as a frame has room for
_PLACES = {
    Placing.STOP: "place: the carriage has to be shown its place",
}


class LiveOutput(Output):
    """Shows on pages of a browser what is explored, and gives what they ask as keys.

    Parameters
    ----------
    view
        The live view, which serves the pages.
    device
        The device.
    say
        Function that is called with each sentence on the live view itself.
    """

    def __init__(self, view: LiveView, device: ReadingDevice, say: Callable[[str], None]) -> None:
        self._view, self._device, self._say = view, device, say
        self._last: deque[str] = deque(maxlen=_MOST_SAID)
        self._said = self._polls = 0
        self._draw = lru_cache(_MOST_DRAWN)(partial(ThreadPoolExecutor(1).submit, _drawn))
        self._image = ""  # of a picture
        self._watched, self._failed = 0, False

    def say(self, sentence: str, cue: Cue = Cue.NONE) -> None:  # noqa: ARG002 - cues are heard
        """Show a sentence."""
        if sentence:
            self._said += 1
            self._last.append(sentence)

    def rest(self) -> None:
        """Do nothing: pages show what stands."""

    def pressed(self, what: Explored) -> list[str]:
        """Tell pages what has changed, and give what they have asked for, as keys."""
        for note in self._view.notes():
            self._say(note)
        if self._watched != self._device.starts:
            self._watched = self._device.starts
            self._view.watch(self._device.engine.reader())
        self._polls += 1
        if self._polls % _EVERY == 0 and not self._failed:
            try:
                self._view.tell(self._state(what))
            except Exception as error:  # a fault of what is shown beside never ends a reading
                self._failed = True
                self._say(f"live view: stopped by a fault: {type(error).__name__}: {error}")
        found = (self._key(what, asked) for asked in self._view.take())
        return [key for key in found if key]

    def _key(self, what: Explored, asked: Any) -> str:
        """Key for what a page asks; what is no key is done here."""
        if isinstance(asked, Point):
            self._device.engine.give(steering.Hold(asked.x_mm, asked.y_mm, asked.theta_rad))
        elif isinstance(asked, LetGo):
            self._device.engine.give(steering.LetGo())
        elif isinstance(asked, Turn):
            if asked.knob in KNOBS and what.prompt is None:
                try:
                    if said := what.turn(asked.knob, asked.value):
                        what.say(said)
                except InputError as error:
                    what.refuse(str(error))
        elif asked.place is not None and what.where is Where.GAME:
            return f"place:{asked.place}"
        elif any(one.name == asked.command for one in _offered(what)):
            return f"command:{asked.command}"
        return ""

    # The state

    def _state(self, what: Explored) -> ViewState:
        device = self._device
        parts = {
            Where.BOOK: self._book, Where.TUNING: lambda tuning: self._book(tuning.reader),
            Where.GAME: self._game, Where.SCREEN: self._screen,
        }  # fmt: skip
        made = parts.get(what.where, self._picture)(what)
        return ViewState(
            array=array_shown(device.display),
            paused=device.paused,
            simulated=device.steered,
            held=device.held,
            device=_PLACES.get(device.placing, "paused" if device.paused else what.doing),
            said=list(self._last),
            said_before=self._said - len(self._last),
            done=what.done,
            commands=[CommandShown(one.name, one.help) for one in _offered(what)],
            **made,
        )

    def _book(self, reader: Any) -> dict[str, Any]:
        from vbraille.reading.feeling import mapping_said

        style, source = reader.style, reader.book.source
        geometry = style.geometry
        return {
            "title": source.title or Path(source.name).name,
            "geometry": geometry_shown(geometry),
            "rows_shown": rows_shown(style, self._device.display),
            "lines": self._lines(reader),
            "place": f"{reader.named}, {100 * source.progress(reader.line.place):.0f} %",
            "knobs": [
                KnobShown(
                    knob.name, knob.label, knob.unit, knob.value(style), knob.step, knob.low,
                    knob.high, "" if knob.fits(style) else "it changes nothing on this display",
                )
                for knob in KNOBS.values()
            ],
            "mapping": mapping_said(style.mapping),
        }  # fmt: skip

    def _lines(self, reader: Any) -> list[LineShown]:
        """Lines to be drawn, from top to bottom: the page, or the line and some around it."""
        pitch_mm, line = reader.style.geometry.line_pitch_mm, reader.line
        rows = {row: part for row, part in enumerate(reader.parts) if part is not None}
        if not reader.rows:
            near = ((step, reader.layout.beside(line, step)) for step in _AROUND)
            rows |= {step: Part(other, reader.width) for step, other in near if other is not None}
        return [
            line_shown(
                part.line, first=part.first, count=len(part), top_mm=row * pitch_mm,
                number=part.line.id & _NUMBER, under=row == reader.row,
            )
            for row, part in sorted(rows.items())
        ]  # fmt: skip

    def _picture(self, picture: Any) -> dict[str, Any]:
        from vbraille.pictures.scenewords import signal_words

        shown, aperture, canvas = picture.shown, picture.aperture, picture.shown.scene.canvas
        drawing = self._draw(shown, self._device.engine.switches)
        if drawing.done():  # what was drawn before stays until this is
            self._image = drawing.result()
        return {
            "title": shown.title,
            "place": "" if picture.spot is None else f"here: {picture.spot.element.name}",
            "scene": SceneShown(
                shown.title, shown.scene.description, canvas.width_mm, canvas.height_mm,
                self._image, aperture.left_mm, aperture.top_mm,
            ),
            "signals": [
                SignalShown(name, signal_words(one)) for name, one in shown.scene.signals.items()
            ],
        }  # fmt: skip

    def _game(self, game: Any) -> dict[str, Any]:
        from vbraille.reading.game import COLUMNS

        cards = [
            CardShown(game.name(place), side, place == game.felt)
            for place, side in enumerate(game.sides)
        ]
        points = [("points", " : ".join(map(str, game.points))), ("turns", str(game.turns))]
        return {
            "title": "memory game",
            "place": f"{game.name(game.place)}, {game.sides[game.place]}",
            "facts": points,
            "blind": True,
            "cards": [cards[at : at + COLUMNS] for at in range(0, len(cards), COLUMNS)],
        }

    def _screen(self, screen: Any) -> dict[str, Any]:
        style, cells, talk = screen.style, screen.line_masks.size, screen.talk
        pitch_mm, places = style.geometry.line_pitch_mm, [(n, n + 1) for n in range(cells)]
        return {
            "title": "the screen",
            "geometry": geometry_shown(style.geometry),
            "rows_shown": rows_shown(style, self._device.display),
            "lines": [
                LineShown(
                    row + 1, talk.text[row * cells : (row + 1) * cells], 0.0, row * pitch_mm,
                    masks.tolist(), places, row == screen.row,
                )
                for row, masks in enumerate(talk.masks)
            ],
            "place": screen.doing,
        }  # fmt: skip


def _offered(what: Explored) -> list[Any]:
    """Commands that pages offer as buttons."""
    return [one for one in table(what.where) if one.steers]


def _drawn(loaded: LoadedScene, switches: int) -> str:
    """Draw a scene as its switches have it, and give the image's address."""
    from vbraille.pictures.scenes import small_png
    from vbraille.render.compiling import settled

    scene = loaded.scene
    shown = settled(scene, switches=switches) if scene.signals else scene
    drawn = base64.b64encode(small_png(shown, loaded.assets)).decode()
    return f"data:image/png;base64,{drawn}"
