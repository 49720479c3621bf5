"""The live view of a reading or of a picture: the state that pages are told, and their wishes."""

from __future__ import annotations

import base64
import math
from abc import ABC, abstractmethod
from collections import deque
from typing import TYPE_CHECKING, Any, Final, Self

from msgspec.structs import replace

from vbraille.config.settings import KNOBS, say_mapping
from vbraille.devices.base import Placing
from vbraille.devices.events import Back, Changed, Silent, Stalled, Stranger, Unplugged
from vbraille.errors import InputError
from vbraille.live.messages import LineShown, PagePress, SceneShown, Turn, ViewState
from vbraille.live.monitor import Monitor
from vbraille.live.states import (
    array_shown,
    geometry_shown,
    knobs_shown,
    line_shown,
    rows_shown,
)
from vbraille.reading.commands.table import COMMANDS
from vbraille.reading.commands.turning import turn_to
from vbraille.reading.keys import Context
from vbraille.reading.outputs import Output
from vbraille.reading.position import line_name, percent
from vbraille.wording import printable, spelled

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from vbraille.devices.events import Event
    from vbraille.feeling.loading import LoadedScene
    from vbraille.layout.pages import Line
    from vbraille.live.messages import Turn
    from vbraille.reading.device import OpenDevice
    from vbraille.reading.reader import Reader
    from vbraille.reading.sceneview import SceneView
    from vbraille.reading.view import View
    from vbraille.reading.viewport import Window
    from vbraille.simulation.steering import Pointer

MOST_SAID: Final = 20
BEFORE, AFTER = 2, 3  # lines around the one under the hand
_NUMBER: Final = 0xFFFF_FFFF  # as much of a line's number as a frame has room for
_PLACES: Final = {
    Placing.MARK: "place: the carriage has to pass its mark",
    Placing.STOP: "place: the carriage has to be shown its place",
}
_GONE: Final = (Unplugged, Silent, Stalled, Stranger)
_BACK: Final = (Back, Changed)


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

    @abstractmethod
    def obey(self, asked: PagePress | Turn) -> None:
        """Do what a page has asked for."""

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
            facts=self._facts,
            done=done,
            **self._parts(),
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

    def obey(self, asked: PagePress | Turn) -> None:
        """Do what a page has asked for."""
        obey_page(self._device.reader, asked)

    def _compared(self) -> tuple[object, ...]:
        reader = self._device.reader
        under, layout = reader.under, reader.layout
        return reader.window, under.style, layout, under.shown, under.reached, layout.counted

    def _parts(self) -> dict[str, Any]:
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
        }

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
        self._feeler = feeler
        self._drawn: tuple[LoadedScene, SceneShown] | None = None

    def obey(self, asked: PagePress | Turn) -> None:
        """Pass over what a page asks for: it can be the hand, but nothing can be turned."""

    def see(self, events: Iterable[Event]) -> None:
        """Take note of events of the device, all of which are said."""

    def _compared(self) -> tuple[object, ...]:
        return self._feeler.shown, self._feeler.aperture, self._feeler.under

    def _parts(self) -> dict[str, Any]:
        under, shown, aperture = self._feeler.under, self._feeler.shown, self._feeler.aperture
        scene = self._scene(shown)
        return {
            "title": shown.title,
            "place": "" if under is None else f"here: {under.name}",
            "scene": replace(scene, left_mm=aperture.left_mm, top_mm=aperture.top_mm),
        }

    def _scene(self, loaded: LoadedScene) -> SceneShown:
        """Picture from above, which is drawn once."""
        if self._drawn is None or self._drawn[0] is not loaded:
            # Only a live view waits for what draws it.
            from vbraille.pictures.scenes import small_png

            drawn = base64.b64encode(small_png(loaded.scene, loaded.assets)).decode()
            self._drawn = loaded, scene_shown(loaded, f"data:image/png;base64,{drawn}")
        return self._drawn[1]


def scene_shown(loaded: LoadedScene, image: str) -> SceneShown:
    """Words and size of a scene for a page, with the address of its image."""
    scene = loaded.scene
    return SceneShown(
        loaded.title, scene.description, scene.canvas.width_mm, scene.canvas.height_mm, image
    )


_COMMANDS: Final = {command.name: command for command in COMMANDS if command.paged}
_MOST_NAMED = 40  # characters of an unknown name


def obey_page(reader: Reader, asked: PagePress | Turn) -> None:
    """Do what a page asks, as if the reader had pressed a key, or say why it cannot be done."""
    if reader.context is not Context.READING:
        reader.say("live view: not now; what the keys have begun comes first")
        return
    try:
        if isinstance(asked, PagePress):
            _press(reader, asked.command)
        else:
            _turn(reader, asked.knob, asked.value)
    except InputError as error:  # reading goes on
        reader.say(f"live view: {spelled(str(error))}")


def _press(reader: Reader, name: str) -> None:
    command = _COMMANDS.get(name)
    if command is None:
        raise InputError(f"{printable(name[:_MOST_NAMED])} is no command that a page may call")
    command.handler(reader)


def _turn(reader: Reader, name: str, value: float) -> None:
    if name not in KNOBS:
        raise InputError(f"{printable(name[:_MOST_NAMED])} is no knob")
    if not math.isfinite(value):
        raise InputError(f"{KNOBS[name].label} cannot be {value}; it must be a number")
    turn_to(reader, name, value)


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
