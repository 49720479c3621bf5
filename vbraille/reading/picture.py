"""A tactile picture under the hand: what is there, and the way to what is elsewhere."""

from __future__ import annotations

import math
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.feeling.aperture import ZOOMS, Aperture
from vbraille.feeling.composing import compose, viewed
from vbraille.feeling.index import SceneIndex
from vbraille.feeling.loading import FileWatch, check_fits, load_scene
from vbraille.reading.commands import Where
from vbraille.reading.explored import Explored
from vbraille.reading.outputs import Cue
from vbraille.scene.measures import MOST_MM
from vbraille.scene.signals import Switch, packed
from vbraille.simulation.steering import GlideTo, ReadPage

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.feeling.index import NamedElement, Spot
    from vbraille.feeling.loading import LoadedScene
    from vbraille.reading.device import ReadingDevice
    from vbraille.reading.outputs import Output
    from vbraille.render.program import Program

Point = tuple[float, float]
KEYED_MM_S, LED_MM_S = 60.0, 100.0  # as a hand that explores goes, and one that is led
_THERE_MM = 3.0
_MOVED_MM = 0.2  # a hand that moved less is asked about no more
_LINE_MM = 10.0  # between the lines that a hand goes along which goes by itself
_WAY_EVERY_S = 1.0


def way(place: Point, to: Point) -> str:
    """Words for the way from a place to another, in mm, such as "12 mm right, 3 mm up"."""
    ways = [
        f"{abs(mm):.0f} mm {forward if mm > 0 else back}"
        for mm, forward, back in (
            (to[0] - place[0], "right", "left"),
            (to[1] - place[1], "down", "up"),
        )
        if abs(mm) >= 1
    ]
    return ", ".join(ways) or "less than 1 mm"


class Picture(Explored):
    """A picture, and the part of it within reach of the hand.

    Parameters
    ----------
    loaded
        The picture.
    device, outputs, key_set
        As of `Explored`.
    where
        Where.PICTURE, or Where.FIGURE for a figure of a book.
    rate_hz
        Frames a second.
    y_mm
        Height at which an array is that moves along x alone; None for one where the picture is
        felt, near the middle of the canvas.
    entering, sound
        Whether each element is said when the finger comes to it, and what plays its sound; None if
        none is played.
    watched
        Whether the picture is read again when its file has changed.
    goes
        Whether a simulated hand goes over the picture by itself; without a person at a keyboard
        that is all.
    zoom
        Zoom to begin with.

    Attributes
    ----------
    aperture : Aperture
        Part of the canvas within reach.
    shown : LoadedScene
        The picture at its zoom.
    spot : Spot or None
        What the finger is on.
    goal : tuple or None
        Name and place that the hand is on its way to.
    """

    doing = "feeling"

    def __init__(
        self,
        loaded: LoadedScene,
        device: ReadingDevice,
        outputs: Sequence[Output],
        key_set: str = "usual",
        *,
        where: Where = Where.PICTURE,
        rate_hz: float = 1000.0,
        y_mm: float | None = None,
        entering: bool = False,
        sound: Callable[[Path], None] | None = None,
        sounding: bool = False,
        watched: bool = False,
        goes: bool = False,
        attended: bool = True,
        zoom: float = 1.0,
    ) -> None:
        super().__init__(device, outputs, key_set)
        self.where, self.loaded, self.contrast = where, loaded, 1.0
        self.entering, self.sounding, self._sound = entering or sounding, sounding, sound
        self._rate_hz, self._attended = rate_hz, attended
        self._goes = goes and device.steered
        self._watch = FileWatch(Path(loaded.opened.path)) if watched else None
        self.aperture = Aperture((device.display.travel_mm, device.display.height_mm), zoom)
        self.spot: Spot | None = None
        self.goal: tuple[str, Point] | None = None
        self._said_s = -math.inf
        self._outside = False  # whether it is to be seen if a person's finger is on the picture
        self._aim: Point | None = None  # where keys have sent the hand
        self._looked_at = (math.nan, math.nan)
        self.states: dict[int, int] = {}  # of the picture's switches, by their keys
        self.element = -1  # number of the element that was gone to last
        self._maker = ThreadPoolExecutor(1)  # makes the picture at another zoom
        self._making: tuple[float, Future[tuple[LoadedScene, Program]]] | None = None
        self._number = 0
        self._chosen = y_mm is not None
        self._y_mm = zoom * (loaded.scene.canvas.height_mm / 2 if y_mm is None else y_mm)
        shown = loaded.zoomed(zoom)
        self._take(shown, self._compose(shown))

    def begin(self) -> None:
        """Show the picture where something of it is felt, and say what it is."""
        if not (self.flat or self._chosen):
            self._y_mm = self.index.inside()[1]
        self.show()
        self.steer()
        self.say_picture()
        if not self.flat:
            self.say(
                f"one axis: one line of the picture is felt at a time, now at {self.height}; up "
                "and down choose another"
            )

    @property
    def flat(self) -> bool:
        """Tell whether the carriage goes along y, too."""
        return self.device.display.height_mm > 0

    @property
    def place(self) -> Point | None:
        """Place of the canvas under the array's centre; None if it is not known."""
        pose = self.device.pose
        if pose is None:
            return None
        x_mm, y_mm = self.aperture.on_canvas(pose.x_mm, pose.y_mm)
        return (x_mm, y_mm) if self.flat else (x_mm, self._y_mm)

    @property
    def height(self) -> str:
        """Words for the height of the line that is felt on a device of one axis."""
        return f"{self._y_mm / self.aperture.zoom:.0f} mm from the top"

    def steer(self) -> None:
        """Have a simulated hand go over the picture, or begin inside it."""
        if self._goes:
            canvas = self.loaded.scene.canvas
            lines = max(1, round(canvas.height_mm / _LINE_MM))
            self.device.give(ReadPage(lines, canvas.height_mm / lines, canvas.width_mm))
        elif self.device.steered:
            self.glide(self.index.inside(), LED_MM_S)
        else:
            self._outside = self.flat or not self._chosen

    # What is shown

    def _compose(self, loaded: LoadedScene) -> Program:
        how = {"rate_hz": self._rate_hz, "contrast": self.contrast}
        return compose(loaded, self.device.display, **how)

    def _take(self, shown: LoadedScene, program: Program) -> None:
        self.shown, self._program = shown, program
        before = self.index.elements[self.element].name if self.element >= 0 else ""
        self.index = SceneIndex(shown.scene, shown.assets, shown.boxes())
        names = [element.name for element in self.index.elements]
        self.element = names.index(before) if before in names else -1
        self.spot = self._aim = None
        self._switch()

    def show(self) -> None:
        """Show the part within reach; what it replaces fades."""
        self._number += 1
        self._looked_at = (math.nan, math.nan)
        origin_mm = self.aperture.left_mm, self.aperture.top_mm
        self.device.put(viewed(self._program, self._y_mm, origin_mm), self._number)

    def set_contrast(self, contrast: float) -> None:
        """Show the picture with a share of the actuators' swing."""
        self.contrast = contrast
        self._program = self._compose(self.shown)
        self.show()

    def choose_height(self, y_mm: float) -> None:
        """Show the line of the picture at another height, on a device of one axis."""
        self._y_mm = min(max(y_mm, 0.0), self.shown.scene.canvas.height_mm)
        self.show()
        self.say(f"height: {self.height}")

    def look_from(self, aperture: Aperture) -> None:
        """Show the picture from elsewhere on the canvas, at the same zoom."""
        self.aperture, self._aim = aperture, None
        self.show()
        self.say_aperture()

    def zoom(self, step: int) -> None:
        """Have the picture nearer or farther by a step, about the finger."""
        canvas = self.loaded.scene.canvas
        now = self.aperture.zoom if self._making is None else self._making[0]
        most = MOST_MM / max(canvas.width_mm, canvas.height_mm)
        others = [zoom for zoom in ZOOMS if zoom <= most and (zoom - now) * step > 0]
        if others:
            self.zoom_to(min(others) if step > 0 else max(others))
        else:
            self.refuse(f"zoom: {now:g} is the {'most' if step > 0 else 'least'}")

    def zoom_to(self, zoom: float) -> None:
        """Begin to make the picture at a zoom; what is felt stays until that is done."""
        loaded = self.loaded

        def make() -> tuple[LoadedScene, Program]:
            shown = loaded.zoomed(zoom)
            return shown, self._compose(shown)

        self._making = zoom, self._maker.submit(make)

    def _take_zoom(self) -> None:
        if self._making is None or not self._making[1].done():
            return
        (zoom, made), self._making = self._making, None
        try:
            shown, program = made.result()
        except InputError as error:
            self.say(f"zoom: still {self.aperture.zoom:g}; {error}", Cue.NOT_FOUND)
            return
        pose = self.device.pose
        at_mm = (0.0, 0.0) if pose is None else (pose.x_mm, pose.y_mm)
        share = zoom / self.aperture.zoom
        self._y_mm *= share
        if self.goal is not None:
            name, (x_mm, y_mm) = self.goal
            self.goal = name, (x_mm * share, y_mm * share)
        whole = zoom == 1.0 and self.aperture.zoomed(1.0, at_mm).is_whole
        zoomed = self.aperture.zoomed(zoom, at_mm)
        self.aperture = Aperture(self.aperture.reach_mm) if whole else zoomed
        self._take(shown, program)
        self.show()
        self.say_aperture()

    def switch(self, key: int) -> None:
        """Put a switch of the picture into its next state."""
        signals = self.loaded.scene.signals.values()
        switches = [one for one in signals if isinstance(one, Switch) and one.key == key]
        if not switches:
            self.refuse(f"the picture has no switch {key}")
            return
        self.states[key] = state = (self.states.get(key, 0) + 1) % len(switches[0].levels)
        self._switch()
        name = next((one.states[state] for one in switches if one.states), str(state + 1))
        title = next((one.title for one in switches if one.title), f"switch {key}")
        self.say(f"{title}: {name}")

    def _switch(self) -> None:
        states = packed(self.states, self.loaded.scene.signals)
        self.device.engine.switches = self.index.switches = states
        self._looked_at = (math.nan, math.nan)

    def reload(self) -> None:
        """Read the file again, and show what it holds now; what is wrong with it is said."""
        try:
            loaded = load_scene(self.loaded.opened.path, self.device.model.style)
            check_fits(loaded.scene, self.device.display)
            shown = loaded.zoomed(self.aperture.zoom)
            program = self._compose(shown)
        except InputError as error:
            self.say(f"not reloaded: {error}; the picture is as it was", Cue.NOT_FOUND)
            return
        self.loaded, self.states, self._making = loaded, {}, None
        self._take(shown, program)
        self.show()
        self.say(f"reloaded: {loaded.title}")
        for note in loaded.notes:
            self.say(f"note: {note}")

    # Where the hand is

    def idle(self, now_s: float) -> None:
        """Say what the finger comes to, and the way to what is sought."""
        self._take_zoom()
        if self._watch is not None and self._watch.changed():
            self.reload()
        place = self.place
        if place is None:
            return
        if self._outside:  # unless the finger is on the picture by chance
            self._outside = False
            if self.index.where(*place) is None:
                self.goal = "picture", self.index.inside()
        self._say_way(place, now_s)
        if math.dist(place, self._looked_at) >= _MOVED_MM or math.isnan(self._looked_at[0]):
            self._looked_at = place
            self._look(place)

    def follow(self, ticks: NDArray[np.void]) -> None:  # noqa: ARG002 - the place is known
        """Note that another person holds the hand, and that a hand has gone over all."""
        if self.device.held:  # keys move the hand from where it was left
            self._aim = None
        if self._goes and not self._attended and self.device.hand_done():
            self.done = True

    def _say_way(self, place: Point, now_s: float) -> None:
        if self.goal is None:
            return
        name, to = self.goal
        to = to if self.flat else (to[0], place[1])
        if math.dist(place, to) <= _THERE_MM:
            self.goal = None
            self.say(f"there: {name}")
        elif not self.device.steered and now_s - self._said_s >= _WAY_EVERY_S:
            self._said_s = now_s
            self.say(f"way: {way(place, to)}")

    def _look(self, place: Point) -> None:
        before, self.spot = self.spot, self.index.where(*place)
        spot = self.spot
        if not self.entering or spot == before:
            return
        if before is not None and (spot is None or spot.element is not before.element):
            if not self.index.encloses(before.element, *place):
                self.say(f"leaving: {before.element.name}")
            before = None
        if spot is None:
            return
        if before is not None:
            self.say(f"{spot.where}: {spot.element.name}")
            return
        pattern = spot.element.pattern
        self.say(pattern.words or f"entering: {spot.element.name}")
        if self.sounding and pattern.sound and self._sound is not None:
            self._sound(self.loaded.opened.folder / pattern.sound)

    @property
    def has_sounds(self) -> bool:
        """Tell whether elements have sounds that can be played."""
        sounds = any(element.pattern.sound for element in self.index.elements)
        return sounds and self._sound is not None

    def lead(self, name: str, to: Point) -> None:
        """Have a simulated hand go to a place, or say the way there to a person.

        Where the place is out of reach, the picture is moved so that it is within.
        """
        brought = self.aperture.reaching(*to)
        if brought != self.aperture:
            self.look_from(brought)
        if not self.flat:
            self.choose_height(to[1])
        self.goal, self._said_s = (name, to), -math.inf
        self.glide(to, LED_MM_S)

    def glide(self, to: Point, speed_mm_s: float) -> None:
        """Have a simulated hand glide to a place of the canvas."""
        display = self.device.display
        x_mm, y_mm = self.aperture.of_carriage(*to)
        half_mm = display.span_mm / 2
        x_mm = min(max(x_mm, -half_mm), display.travel_mm - half_mm)
        y_mm = min(max(y_mm, 0.0), display.height_mm)
        self._aim = self.aperture.on_canvas(x_mm, y_mm)
        self.device.give(GlideTo(x_mm, y_mm, speed_mm_s))

    def move(self, right_mm: float, down_mm: float) -> bool:
        """Move a simulated hand; False for a person's."""
        begun = self._aim or self.place
        if not self.device.steered or begun is None:
            return False
        self.goal = None
        self.glide((begun[0] + right_mm, begun[1] + down_mm), KEYED_MM_S)
        return True

    def go_to(self, element: NamedElement) -> None:
        """Go to an element, or say the way there."""
        self.element = self.index.elements.index(element)
        self.say(f"going to: {element.name}" if self.device.steered else element.name)
        self.lead(element.name, self.index.point_on(element))

    # What is said

    def say_picture(self) -> None:
        """Say the title, the size and the description of the picture."""
        scene = self.loaded.scene
        self.say(
            f"{self.loaded.title}, {scene.canvas.width_mm:g} mm × {scene.canvas.height_mm:g} mm"
        )
        if scene.description:
            self.say(f"description: {scene.description}")
        if not self.aperture.is_whole:
            self.say_aperture()

    def say_aperture(self) -> None:
        """Say the zoom, and which part of the picture is within reach."""
        words = self.aperture.words(self.shown.scene.canvas)
        self.say(f"zoom: {self.aperture.zoom:g}, within reach {words}")
