"""The live view of a reading or of a picture: the state that pages are told, and their wishes."""

from __future__ import annotations

import base64
import math
from abc import ABC, abstractmethod
from collections import deque
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any, Final, Self, cast

from msgspec.structs import replace

from vbraille.cli.old.reading.commands.turning import turn_to
from vbraille.cli.old.reading.keys import Context
from vbraille.cli.old.reading.lineviews import figure_address
from vbraille.cli.old.reading.outputs import Output
from vbraille.cli.old.reading.position import line_name, percent
from vbraille.cli.old.reading.reader import Reader
from vbraille.config.settings import KNOBS, say_mapping
from vbraille.devices.base import Placing
from vbraille.devices.events import Back, Silent, Stalled, Stranger, Unplugged
from vbraille.errors import InputError
from vbraille.live.messages import (
    BesideShown,
    CardShown,
    CommandShown,
    LineShown,
    PagePress,
    SceneShown,
    SignalShown,
    Turn,
    ViewState,
)
from vbraille.live.monitor import Monitor
from vbraille.live.states import (
    array_shown,
    beside_shown,
    geometry_shown,
    knobs_shown,
    line_shown,
    rows_shown,
)
from vbraille.scene.checking import kind_of
from vbraille.scene.signals import Switch, ordered
from vbraille.wording import printable, spelled

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence
    from concurrent.futures import Future

    from vbraille.cli.old.reading.device import OpenDevice
    from vbraille.cli.old.reading.game import GameView
    from vbraille.cli.old.reading.sceneview import SceneView
    from vbraille.cli.old.reading.view import View
    from vbraille.cli.old.reading.viewport import Window
    from vbraille.devices.events import Event
    from vbraille.feeling.loading import LoadedScene
    from vbraille.layout import Line
    from vbraille.live.messages import Turn
    from vbraille.render.braille.mappings import Mapping
    from vbraille.scene.scene import Scene
    from vbraille.simulation.steering import Pointer

MOST_SAID: Final = 20
_MOST_DRAWN: Final = 8  # pictures that stay drawn
BEFORE, AFTER = 2, 3  # lines around the one under the hand
_NUMBER: Final = 0xFFFF_FFFF  # as much of a line's number as a frame has room for
_PLACES: Final = {
    Placing.MARK: "place: the carriage has to pass its mark",
    Placing.STOP: "place: the carriage has to be shown its place",
}
_GONE: Final = (Unplugged, Silent, Stalled, Stranger)
_BACK: Final = (Back,)


class LastSentences:
    """The last sentences that a reader was told.

    Attributes
    ----------
    count : int
        Number of all sentences so far.
    """

    def __init__(self) -> None:
        self.count = 0
        self._last: deque[str] = deque(maxlen=MOST_SAID)

    def add(self, sentence: str) -> None:
        """Keep a sentence."""
        self.count += 1
        self._last.append(sentence)

    @property
    def last(self) -> list[str]:
        """The last sentences, oldest first, `MOST_SAID` at most."""
        return list(self._last)


class ExploredState(ABC):
    """State of an exploration, as pages of the live view are told of it.

    Parameters
    ----------
    device
        Device that something is explored on.
    activity
        Reader or feeler.
    said
        What was said.
    facts
        Name and value of whatever else is to be shown.

    Attributes
    ----------
    standing : str
        Sentence on why nothing is done, such as that the program is stopped; empty if it is.
    """

    def __init__(
        self,
        device: OpenDevice,
        activity: View,
        said: LastSentences,
        facts: Iterable[tuple[str, str]] = (),
    ) -> None:
        self.standing = ""
        self._device = device
        self._activity = activity
        self._said = said
        self._facts = list(facts)
        self._gone = ""  # sentence on where the device is
        self._number = 0
        self._told: tuple[object, ...] = ()

    @abstractmethod
    def _compared(self) -> tuple[object, ...]:
        """Give whatever else may change, which is compared as objects but for plain values."""

    @abstractmethod
    def _parts(self) -> dict[str, Any]:
        """Parts of the state that are of one activity alone."""

    def obey(self, asked: PagePress | Turn) -> None:
        """Do what a page has asked for."""
        obey_page(self._activity, asked)

    def see(self, events: Iterable[Event]) -> None:
        """Take note of events of the device."""
        for event in events:
            if isinstance(event, _GONE):
                self._gone = event.say()
            elif isinstance(event, _BACK):
                self._gone = ""

    def changed(self) -> ViewState | None:
        """State of the activity; None if it is what it was at the last call."""
        device, done = self._device, self._activity.done
        # What is compared is small, for this is asked fifty times a second. What cannot change is
        # compared as an object, and kept here, so that no other can take its place in memory.
        now = (
            *(done, device.paused, device.placing, device.held),
            *(self._said.count, self._gone, self.standing),
            *self._compared(),
        )
        if len(now) == len(self._told) and all(
            a is b or (isinstance(a, bool | int | str) and a == b)
            for a, b in zip(now, self._told, strict=True)
        ):
            return None
        self._told = now
        self._number += 1
        said = self._said.last
        return ViewState(
            number=self._number,
            array=array_shown(device.display),
            paused=device.paused,
            simulated=device.pointer is not None,
            held=device.held,
            device=self._standing(),
            said=said,
            said_before=self._said.count - len(said),
            done=done,
            **{"facts": self._facts, **self._parts()},
        )

    def _standing(self) -> str:
        """Sentence on the state of the device."""
        doing, placing = self._activity.doing, self._device.placing
        if self.standing:
            return self.standing
        if self._activity.done:
            return f"{doing} is over"
        if self._gone:
            return self._gone
        if placing is Placing.DONE:
            return "paused" if self._device.paused else doing
        return _PLACES[placing]


class ReadState(ExploredState):
    """A text that is read.

    Nothing is translated or laid out for it: of the lines around the one under the hand it shows
    those that are there already.

    Parameters
    ----------
    device
        Device that a text is shown on.
    title
        Title of what is read.
    said, facts
        As for a `ExploredState`.
    """

    def __init__(
        self,
        device: OpenDevice,
        title: str,
        said: LastSentences,
        facts: Iterable[tuple[str, str]] = (),
    ) -> None:
        super().__init__(device, device.reader, said, facts)
        self._title = title
        self._pictures = ScenePictures()
        self._placed: list[SceneShown] = []
        self._felt: FeltScene | None = None

    def _compared(self) -> tuple[object, ...]:
        reader = self._device.reader
        under, layout = reader.under, reader.layout
        alone = self._alone
        felt = () if alone is None else alone.compared()
        pictures = [self._pictures.of(one.figure.loaded) for one in under.figured.placed]
        self._placed = [
            replace(picture, top_mm=-one.top_mm)
            for one, picture in zip(under.figured.placed, pictures, strict=True)
        ]
        seen = reader.window, under.style, layout, under.shown, under.reached, layout.counted
        return (*seen, reader.beside, under.alone, *felt, *pictures)

    @property
    def _alone(self) -> FeltScene | None:
        """Figure that is felt in place of the text."""
        view = self._device.reader.under.alone
        if self._felt is None or self._felt.view is not view:
            felt = cast("SceneView | None", view)  # which a figure alone is
            self._felt = None if felt is None else FeltScene(felt, self._pictures)
        return self._felt

    def _parts(self) -> dict[str, Any]:
        alone = self._alone
        if alone is not None:
            return alone.parts()
        reader = self._device.reader
        style, layout, line = reader.style, reader.layout, reader.line
        counted = f"{line_name(layout, line)}, " if layout.counted else ""
        return {
            "title": self._title,
            "geometry": geometry_shown(style.geometry),
            "rows_shown": rows_shown(style, self._device.display),
            "lines": list(self._lines(line)),
            "place": f"{counted}{percent(layout, line)} %",
            "knobs": knobs_shown(style),
            "mapping": say_mapping(style.mapping),
            "figures": self._placed,
            "beside": None if reader.beside is None else self._beside(reader.beside),
            "commands": commands_shown(
                reader, (*_READING, "FEEL") if figure_address(line) else _READING
            ),
        }

    def _beside(self, mapping: Mapping) -> BesideShown:
        """Make the line under the hand in another mapping."""
        window, display = self._device.reader.window, self._device.display
        style = self._device.reader.style.replace(mapping=mapping)
        words = say_mapping(mapping)
        return beside_shown(style, display, window.masks, window.start_mm, words)

    def _lines(self, line: Line) -> Iterable[LineShown]:
        """Lines to be drawn, from top to bottom."""
        reader = self._device.reader
        window, layout, surface = reader.window, reader.layout, reader.under.surface
        pitch_mm = reader.style.geometry.line_pitch_mm
        if surface.paged:
            for row, part in enumerate(surface.windows):
                if part is not None:
                    yield _part_shown(part, top_mm=row * pitch_mm, under=part is window)
            return
        for step in range(-BEFORE, AFTER + 1):
            if step == 0:
                yield _part_shown(window, under=True)
                continue
            other = layout.laid_near(line, step)
            if other is not None:
                yield line_shown(
                    other,
                    count=min(len(other), window.width),
                    top_mm=step * pitch_mm,
                    number=other.number & _NUMBER,
                )


def _part_shown(part: Window, *, under: bool, top_mm: float = 0.0) -> LineShown:
    """Show a part of a line, whose upper edge is at a place, as a page draws it."""
    return line_shown(
        part.line,
        first=part.offset,
        count=len(part),
        start_mm=part.start_mm,
        top_mm=top_mm,
        number=part.line.number & _NUMBER,
        under=under,
    )


class FeltState(ExploredState):
    """A picture that is felt on a device.

    Parameters
    ----------
    device
        Device that the picture is felt on.
    feeler
        Who feels it.
    said, facts
        As for a `ExploredState`.
    """

    def __init__(
        self,
        device: OpenDevice,
        feeler: SceneView,
        said: LastSentences,
        facts: Iterable[tuple[str, str]] = (),
    ) -> None:
        super().__init__(device, feeler, said, facts)
        self._felt = FeltScene(feeler, ScenePictures())

    def see(self, events: Iterable[Event]) -> None:
        """Take note of events of the device, all of which are said."""

    def _compared(self) -> tuple[object, ...]:
        return self._felt.compared()

    def _parts(self) -> dict[str, Any]:
        return self._felt.parts()


class FeltScene:
    """Parts of a state for a picture that is felt: by itself, or as a figure of a text.

    Parameters
    ----------
    view
        Who feels it.
    pictures
        Pictures of scenes from above.
    """

    def __init__(self, view: SceneView, pictures: ScenePictures) -> None:
        self.view = view
        self._pictures = pictures
        self._shown = pictures.of(view.shown, view.engine.switches, wait=True)

    def compared(self) -> tuple[object, ...]:
        """Give whatever may change; see `ExploredState`."""
        view = self.view
        drawn = self._pictures.of(view.shown, view.engine.switches)
        if drawn.image:  # until then the one before stays
            self._shown = drawn
        return view.shown, view.aperture, view.under, view.engine.switches, self._shown

    def parts(self) -> dict[str, Any]:
        """Make the parts of the state."""
        # Only a live view waits for what draws pictures and has words for them.
        from vbraille.pictures.scenewords import signal_words

        view, aperture = self.view, self.view.aperture
        scene, under = view.shown.scene, view.under
        canvas = scene.canvas
        signals = {one.name: one.signal for one in ordered(scene.signals)}
        return {
            "title": view.shown.title,
            "place": "" if under is None else f"here: {under.name}",
            "scene": replace(
                self._shown,
                width_mm=canvas.width_mm,
                height_mm=canvas.height_mm,
                left_mm=aperture.left_mm,
                top_mm=aperture.top_mm,
            ),
            "signals": [
                SignalShown(name, signal_words(one)) for name, one in signals.items() if one
            ],
            "commands": [
                *commands_shown(view, _FEELING),
                *(
                    CommandShown(f"SWITCH_{one.key}", one.title or f"switch {one.key}")
                    for one in {
                        one.key: one for one in signals.values() if isinstance(one, Switch)
                    }.values()
                ),
            ],
        }


class ScenePictures:
    """Pictures of scenes from above, as their switches stand, drawn in a thread of their own."""

    def __init__(self) -> None:
        self._drawer = ThreadPoolExecutor(1)
        # With each scene, which has its number for itself while it is here.
        self._found: dict[tuple[int, int], tuple[LoadedScene, SceneShown, Future[SceneShown]]] = {}

    def of(self, loaded: LoadedScene, switches: int = 0, *, wait: bool = False) -> SceneShown:
        """Give the picture of a scene, the same until something changes.

        Parameters
        ----------
        loaded
            The scene.
        switches
            States of its switches, as `vbraille.scene.signals.packed` has them.
        wait
            Whether to wait until it is drawn; else it has no image till then.
        """
        key = id(loaded), switches
        if key not in self._found:
            while len(self._found) >= _MOST_DRAWN:
                del self._found[next(iter(self._found))]
            drawing = self._drawer.submit(_drawn, loaded, switches)
            self._found[key] = loaded, scene_shown(loaded, ""), drawing
        _, blank, drawing = self._found[key]
        return drawing.result() if wait or drawing.done() else blank


def _drawn(loaded: LoadedScene, switches: int) -> SceneShown:
    """Draw a scene as its switches have it, and the layers that they hide."""
    # Only a live view waits for what draws it.
    from vbraille.feeling.index import label_of
    from vbraille.pictures.scenes import hidden_layers, small_png
    from vbraille.render.compiling import settled

    def address(scene: Scene, beyond: Scene | None = None) -> str:
        drawn = base64.b64encode(small_png(scene, loaded.assets, beyond)).decode()
        return f"data:image/png;base64,{drawn}"

    scene = loaded.scene
    shown = settled(scene, switches=switches) if scene.signals else scene
    picture = scene_shown(loaded, address(shown))
    hidden = hidden_layers(scene, switches)
    if hidden is None:
        return picture
    off = [
        f"{'' if whole else 'part of '}{label_of(element) or kind_of(element).replace('-', ' ')} "
        f"(signal {name})"
        for element, whole, name in hidden.elements
    ]
    return replace(picture, off=off, off_image=address(hidden.shown, shown))


class PlayedState(ExploredState):
    """A memory game that is played on a device: how the cards lie, and not what they are.

    Parameters
    ----------
    device
        Device that the cards are felt on.
    view
        The game.
    said, facts
        As for a `ExploredState`.
    """

    def __init__(
        self,
        device: OpenDevice,
        view: GameView,
        said: LastSentences,
        facts: Iterable[tuple[str, str]] = (),
    ) -> None:
        super().__init__(device, view, said, facts)
        self._view = view

    def _compared(self) -> tuple[object, ...]:
        return self._view.game, self._view.place, self._view.felt

    def _parts(self) -> dict[str, Any]:
        view, game = self._view, self._view.game
        points = [("points", " : ".join(map(str, game.points))), ("turns", str(game.turns))]
        return {
            "title": "memory game",
            "place": f"place: {view.name(view.place)}, {game.side(view.place).value}",
            "facts": [*self._facts, *points],
            "blind": True,
            "cards": [
                [
                    CardShown(view.name(place), game.side(place).value, place == view.felt)
                    for place in row
                ]
                for row in view.rows()
            ],
            "commands": commands_shown(view, _PLAYING),
        }


def scene_shown(loaded: LoadedScene, image: str) -> SceneShown:
    """Words and size of a scene for a page, with the address of its image."""
    scene = loaded.scene
    return SceneShown(
        loaded.title, scene.description, scene.canvas.width_mm, scene.canvas.height_mm, image
    )


# Commands that pages offer as buttons, in this order.
_READING: Final = ("LNUP", "LNDN", "PAUSE", "MAPPING", "BESIDE", "UNDO")
_FEELING: Final = (
    *("BACK", "PAUSE", "ZOOM_IN", "ZOOM_OUT", "WHOLE"),
    *("PAN_LEFT", "PAN_RIGHT", "PAN_UP", "PAN_DOWN", "HERE", "ENTERING"),
)
_PLAYING: Final = ("TURN", "OTHER", "TABLE", "POINTS", "ONE", "TWO", "PAUSE")
_MOST_NAMED = 40  # characters of an unknown name


def commands_shown(view: View, names: Iterable[str]) -> list[CommandShown]:
    """Commands of a view with these names, as pages offer them."""
    found = {command.name: command for command in view.bound.commands}
    return [CommandShown(name, found[name].help) for name in names if name in found]


def obey_page(view: View, asked: PagePress | Turn) -> None:
    """Do what a page asks, as if a key had been pressed, or say why it cannot be done."""
    view = view.listener()
    if view.context is not Context.READING:
        view.say("live view: not now; what the keys have begun comes first")
        return
    try:
        if isinstance(asked, PagePress):
            _press(view, asked)
        else:
            _turn(view, asked.knob, asked.value)
    except InputError as error:  # the exploration goes on
        view.say(f"live view: {spelled(str(error))}")


def _press(view: View, asked: PagePress) -> None:
    name = asked.command
    command = next((one for one in view.bound.commands if one.name == name and one.paged), None)
    if command is None:
        raise InputError(f"{printable(name[:_MOST_NAMED])} is no command that a page may call")
    if command.placed is not (asked.place is not None):
        raise InputError(f"{name} is {'' if command.placed else 'not '}for a place")
    if asked.place is None:
        command.handler(view)
    else:
        command.handler(view, asked.place)


def _turn(view: View, name: str, value: float) -> None:
    if not isinstance(view, Reader):
        raise InputError("knobs turn while a text is under the hand")
    if name not in KNOBS:
        raise InputError(f"{printable(name[:_MOST_NAMED])} is no knob")
    if not math.isfinite(value):
        raise InputError(f"{KNOBS[name].label} cannot be {value}; it must be a number")
    turn_to(view, name, value)


class LiveView(Output):
    """The live view of an exploration. A context manager; its pages are served while it is open.

    Parameters
    ----------
    host, port
        Address and port of its pages; None for what is usual.
    pointer
        Pointer by which pages may hold the hand of the device; None if a person moves that.
    print_line
        Function that prints what the live view has to say itself.

    Attributes
    ----------
    monitor : Monitor
        Process that serves the pages, and takes what they ask for.
    """

    def __init__(
        self,
        host: str | None,
        port: int | None,
        pointer: Pointer | None,
        print_line: Callable[[str], None],
    ) -> None:
        self.monitor = Monitor(host=host, port=port, pointer=pointer)
        self.said = LastSentences()
        self._print = print_line
        self._state: ExploredState | None = None

    def show(self, state: ExploredState) -> None:
        """Show something from now on."""
        self._state = state
        self.attend()

    def say(self, sentence: str) -> None:
        """Show a sentence on the pages."""
        self.said.add(sentence)

    def attend(self, events: Sequence[Event] = ()) -> None:
        """Do what pages ask for, and tell them what has changed."""
        for note in self.monitor.notes():
            self._print(note)
        asked = self.monitor.take()
        state = self._state
        if state is None:
            return
        if not state.standing:  # otherwise the reader cannot do it now
            for one in asked:
                state.obey(one)
        state.see(events)
        changed = state.changed()
        if changed is not None:
            self.monitor.tell(changed)

    def stand(self, why: str) -> None:
        """Tell the pages why nothing is explored."""
        if self._state is not None:
            self._state.standing = why
        self.attend()

    def __enter__(self) -> Self:
        self.monitor.launch()
        return self

    def __exit__(self, *_: object) -> None:
        self.monitor.close()
