"""A tactile picture under the hand: what is there, and the way to what is elsewhere."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.pictures.aperture import ZOOMS, Aperture
from vbraille.pictures.composing import compose, viewed
from vbraille.pictures.index import SceneIndex
from vbraille.pictures.loading import FileWatch, check_fits, load_scene
from vbraille.reading.commands import WAYS, Where, both_ways, command
from vbraille.reading.explored import Explored
from vbraille.reading.outputs import Cue
from vbraille.scene.measures import MOST_MM
from vbraille.scene.signals import MOST_KEYS, Switch, packed
from vbraille.scene.traversal import each
from vbraille.simulation.steering import GlideTo, ReadPage

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.pictures.index import Spot
    from vbraille.pictures.loading import LoadedScene
    from vbraille.reading.device import ReadingDevice
    from vbraille.reading.outputs import Output
    from vbraille.scene.scene import Canvas

Point = tuple[float, float]
_KEYED_MM_S, _LED_MM_S = 60.0, 100.0  # as a hand that explores goes, and one that is led
_THERE_MM = 3.0
_MOVED_MM = 0.2  # a hand that moved less is asked about no more
_LINE_MM = 10.0  # between lines, for simulated hands and for the keys up and down
_WAY_EVERY_S = 1.0
_PAN = 0.5  # of what is within reach
_CONTRAST_STEP = 0.1
_BUTTONED = 2  # switches that have a button of the device, too
SAID = ("not said", "said", "said, with sounds")  # elements as the finger comes to them
_NOWHERE = math.nan, math.nan
_PICTURE = "picture"  # a goal that is reached where anything of it is felt
_ANY = Where.PICTURE | Where.FIGURE
_command, _both_ways = partial(command, where=_ANY), partial(both_ways, where=_ANY)


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


def sweep(canvas: Canvas) -> ReadPage:
    """Order for a simulated hand that goes over a canvas, line after line."""
    lines = max(1, round(canvas.height_mm / _LINE_MM))
    return ReadPage(lines, canvas.height_mm / lines, canvas.width_mm)


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
    y_mm
        Height at which an array is that moves along x alone; None for one where the picture is
        felt, near the middle of the canvas.
    saying, sound
        Whether elements are said when the finger comes to them, as in `SAID`, and what plays their
        sounds; None if none is played.
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
        y_mm: float | None = None,
        saying: int = 0,
        sound: Callable[[Path], None] | None = None,
        goes: bool = False,
        attended: bool = True,
        zoom: float = 1.0,
    ) -> None:
        super().__init__(device, outputs, key_set)
        self.where, self._contrast = where, 1.0
        self._sound, self._saying = sound, saying
        self._attended, self._goes = attended, goes and device.steered
        self._watch = FileWatch(Path(loaded.opened.path)) if where is Where.PICTURE else None
        self.aperture = Aperture((device.display.travel_mm, device.display.height_mm), zoom)
        self.spot: Spot | None = None
        self._goal: tuple[str, Point] | None = None  # that the hand is on its way to
        self._said_s = -math.inf
        self._aim: Point | None = None  # where keys have sent the hand
        self._looked_at = _NOWHERE
        self._states: dict[int, int] = {}  # of the picture's switches, by their keys
        self._element = -1  # number of the element that was gone to last
        self._number = 0
        self._take(loaded, zoom)
        self._y_mm = self.index.inside()[1] if y_mm is None else zoom * y_mm

    def begin(self) -> None:
        """Show the picture where something of it is felt, and say what it is."""
        self._show()
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
        return self.display.height_mm > 0

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
            self.device.give(sweep(self.loaded.scene.canvas))
        elif self.device.steered:
            self._glide(self.index.inside(), _LED_MM_S)
        else:
            self._goal = _PICTURE, self.index.inside()

    # What is shown

    def _take(self, loaded: LoadedScene, zoom: float) -> None:
        """Have a picture at a zoom; if it cannot be shown so, all stays as it was."""
        shown, display = loaded.zoomed(zoom), self.display
        self._program = compose(shown, display, rate_hz=display.rate_hz, contrast=self._contrast)
        self.loaded, self.shown = loaded, shown
        self.index = SceneIndex(shown.scene, shown.assets, shown.boxes())
        self.spot = self._aim = None
        self._switch()

    def _switch(self) -> None:
        states = packed(self._states, self.loaded.scene.signals)
        self.device.engine.switches = self.index.switches = states
        self._looked_at = _NOWHERE

    def _show(self) -> None:
        """Show the part within reach; what it replaces fades."""
        self._number += 1
        self._looked_at = _NOWHERE
        origin_mm = self.aperture.left_mm, self.aperture.top_mm
        self.device.put(viewed(self._program, self._y_mm, origin_mm), self._number)

    def _choose_height(self, y_mm: float) -> None:
        """Show the line of the picture at another height, on a device of one axis."""
        self._y_mm = min(max(y_mm, 0.0), self.shown.scene.canvas.height_mm)
        self._show()
        self.say(f"height: {self.height}")

    def _look_from(self, aperture: Aperture) -> None:
        """Show the picture from elsewhere on the canvas, at the same zoom."""
        self.aperture, self._aim = aperture, None
        self._show()
        self.say_zoom()

    def _zoom_to(self, zoom: float) -> None:
        try:
            self._take(self.loaded, zoom)
        except InputError as error:
            self.say(f"zoom: still {self.aperture.zoom:g}; {error}", Cue.NOT_FOUND)
            return
        pose = self.device.pose
        at_mm = (0.0, 0.0) if pose is None else (pose.x_mm, pose.y_mm)
        self._y_mm *= zoom / self.aperture.zoom
        self._goal = None
        whole = Aperture(self.aperture.reach_mm)
        self._look_from(whole if zoom == 1.0 else self.aperture.zoomed(zoom, at_mm))

    # Where the hand is

    def idle(self, now_s: float) -> None:
        """Say what the finger comes to, and the way to what is sought."""
        if self._watch is not None and self._watch.changed():
            self.reload()
        place = self.place
        if place is None:
            return
        if not math.dist(place, self._looked_at) < _MOVED_MM:
            self._looked_at = place
            before, self.spot = self.spot, self.index.where(*place)
            if self._saying and self.spot != before:
                self._say_coming(place, before)
        if self._goal is not None:
            self._say_way(place, now_s, *self._goal)

    def follow(self, ticks: NDArray[np.void]) -> None:  # noqa: ARG002 - the place is known
        """Note that another person holds the hand, and that a hand has gone over all."""
        if self.device.held:  # keys move the hand from where it was left
            self._aim = None
        if self._goes and not self._attended and self.device.hand_done:
            self.done = True

    def _say_way(self, place: Point, now_s: float, name: str, to: Point) -> None:
        to = to if self.flat else (to[0], place[1])
        if math.dist(place, to) <= _THERE_MM or (name == _PICTURE and self.spot is not None):
            self._goal = None
            self.say(f"there: {name}")
        elif not self.device.steered and now_s - self._said_s >= _WAY_EVERY_S:
            self._said_s = now_s
            self.say(f"way: {way(place, to)}")

    def _say_coming(self, place: Point, before: Spot | None) -> None:
        """Say the element that the finger has come to, and the one that it has left."""
        spot = self.spot
        if spot is not None and before is not None and spot.element is before.element:
            self.say(f"{spot.where}: {spot.element.name}")
            return
        if before is not None and not self.index.encloses(before.element, *place):
            self.say(f"leaving: {before.element.name}")
        if spot is not None:
            pattern = spot.element.pattern
            self.say(pattern.words or f"entering: {spot.element.name}")
            if self._saying > 1 and pattern.sound and self._sound is not None:
                self._sound(self.loaded.opened.folder / pattern.sound)

    def _lead(self, name: str, to: Point) -> None:
        """Have a simulated hand go to a place, or say the way there to a person.

        Where the place is out of reach, the picture is moved so that it is within.
        """
        self.say(f"going to: {name}" if self.device.steered else name)
        brought = self.aperture.reaching(*to)
        if brought != self.aperture:
            self._look_from(brought)
        if not self.flat:
            self._choose_height(to[1])
        self._goal, self._said_s = (name, to), -math.inf
        self._glide(to, _LED_MM_S)

    def _glide(self, to: Point, speed_mm_s: float) -> None:
        """Have a simulated hand glide to a place of the canvas."""
        display = self.display
        x_mm, y_mm = self.aperture.of_carriage(*to)
        half_mm = display.span_mm / 2
        x_mm = min(max(x_mm, -half_mm), display.travel_mm - half_mm)
        y_mm = min(max(y_mm, 0.0), display.height_mm)
        self._aim = self.aperture.on_canvas(x_mm, y_mm)
        self.device.give(GlideTo(x_mm, y_mm, speed_mm_s))

    def _go_to(self, number: int) -> None:
        """Go to an element, or say the way there."""
        self._element, element = number, self.index.elements[number]
        self._lead(element.name, self.index.point_on(element))

    # Commands: what is said

    @command("back to the text", "G", "E", where=Where.FIGURE, first=True)
    def leave(self) -> None:
        """Go back to the text."""
        self.done = True

    @_command("stop saying the way to an element", "escape")
    def cancel(self) -> None:
        """Say the way no more; without one, leave a figure."""
        if self._goal is not None:
            self._goal = None
            self.say("way: no longer said")
        elif self.where is Where.FIGURE:
            self.done = True
        else:
            self.refuse("nothing to cancel")

    @_command(
        "say what is under the finger, and where", "i u", also="button:1", first=True, steers=True
    )
    def say_here(self) -> None:
        """Say what is under the finger, and where."""
        place, spot, nearest = self._here()
        if place is None:
            self.say("the place of the finger is not known yet")
            return
        said = f"nothing with a name{nearest}"
        if spot is not None:
            where = {"edge": "edge of ", "inside": "inside "}.get(spot.where, "")
            said = f"{where}{spot.element.name}"
        self.say(f"here: {said}; {self.aperture.placed(*place)}")

    def _here(self) -> tuple[Point | None, Spot | None, str]:
        """Place of the finger, what is there, and words for what is nearest if nothing is."""
        place = self.place
        spot = None if place is None else self.index.where(*place)
        found = None if place is None or spot is not None else self.index.nearest(*place)
        if place is None or found is None:
            return place, spot, ""
        return place, spot, f", nearest {found[0].name}, {way(place, found[1])}"

    @_command("say more of what is under the finger", "w", also="button:2")
    def describe(self) -> None:
        """Say more of what is under the finger."""
        _, spot, nearest = self._here()
        if spot is None:
            self.say(f"nothing here{nearest}")
            return
        element = spot.element
        kind, *inner = dict.fromkeys(one.kind.replace("-", " ") for one in each(element.pattern))
        parts = f" with {', '.join(inner)}" if inner else ""
        looks = f"{kind}, {self.aperture.sized(element.box)}{parts}"
        self.say(f"{element.name}: {element.description or looks}")

    @_command("say what the picture is", "V f5")
    def say_picture(self) -> None:
        """Say the title, the size and the description of the picture."""
        scene = self.loaded.scene
        size = f"{scene.canvas.width_mm:g} mm × {scene.canvas.height_mm:g} mm"
        self.say(f"{self.loaded.title}, {size}")
        if scene.description:
            self.say(f"description: {scene.description}")
        if not self.aperture.is_whole:
            self.say_zoom()

    @_command("list the elements that have a name", "O", first=True)
    def elements(self) -> None:
        """List the elements that have a name."""
        if not self.index.elements:
            self.refuse("no element has a name")
        for element in self.index.elements:
            box = element.box
            middle = (box.left + box.right) / 2, (box.top + box.bottom) / 2
            said = f"{self.aperture.sized(box)}, middle {self.aperture.placed(*middle)}"
            self.say(f"{element.name}: {'outside' if box.is_empty else said}")

    @_command(
        "say each element as the finger comes to it, with its sound, or not", "v f6", steers=True
    )
    def entering(self) -> None:
        """Say elements as the finger comes to them, with sounds if there are any, or not."""
        states = 2 if self._sound is None else 3
        self._saying = (self._saying + 1) % states
        self.say(f"elements: {SAID[self._saying]} as you come to them")

    @_command("say the zoom, and what is within reach", "z")
    def say_zoom(self) -> None:
        """Say the zoom, and which part of the picture is within reach."""
        words = self.aperture.words(self.shown.scene.canvas)
        self.say(f"zoom: {self.aperture.zoom:g}, within reach {words}")

    # Commands: where the hand and the picture go

    @_command("go to an element by its name", "g /", first=True)
    def go_to(self) -> None:
        """Ask for an element, and go there."""

        def answer(typed: str) -> None:
            element = self.index.find(typed)
            if element is None:
                self.say(f"no element {typed!r}; shift-o lists them", Cue.NOT_FOUND)
            else:
                self._go_to(self.index.elements.index(element))

        self.ask("element", answer, [element.name for element in self.index.elements[::-1]])

    @_both_ways("element", "n e | p E", "n e | p", first=True)
    def element(self, step: int) -> None:
        """Go to the next element, or to the one before."""
        count = len(self.index.elements)
        number = count - 1 if self._element < 0 and step < 0 else min(self._element, count) + step
        if 0 <= number < count:
            self._go_to(number)
        else:
            self.refuse_step(step, "element")

    @_command("go to the middle of the picture", "home")
    def middle(self) -> None:
        """Go to the middle of the picture."""
        canvas = self.shown.scene.canvas
        self._lead("middle", (canvas.width_mm / 2, canvas.height_mm / 2))

    def move(self, right_mm: float, down_mm: float) -> None:
        """Move a simulated hand; for a person, the line that is felt, or to another element."""
        begun = self._aim or self.place
        if down_mm and not self.flat:
            self._choose_height(self._y_mm + down_mm)
        elif self.device.steered and begun is not None:
            self._goal = None
            self._glide((begun[0] + right_mm, begun[1] + down_mm), _KEYED_MM_S)
        else:
            self.element(1 if right_mm + down_mm > 0 else -1)

    def pan(self, right: float, down: float) -> None:
        """Show a part of the picture farther on, by shares of what is within reach."""
        if down and not self.flat:
            self.move(0, math.copysign(_LINE_MM, down))
            return
        moved = self.aperture.panned(right, down, self.shown.scene.canvas)
        if moved == self.aperture:
            self.refuse("no more of the picture that way")
        else:
            self._look_from(moved)

    def switch(self, key: int) -> None:
        """Put a switch of the picture into its next state."""
        signals = self.loaded.scene.signals.values()
        switches = [one for one in signals if isinstance(one, Switch) and one.key == key]
        if not switches:
            self.refuse(f"the picture has no switch {key}")
            return
        self._states[key] = state = (self._states.get(key, 0) + 1) % len(switches[0].levels)
        self._switch()
        name = next((one.states[state] for one in switches if one.states), str(state + 1))
        title = next((one.title for one in switches if one.title), f"switch {key}")
        self.say(f"{title}: {name}")

    @_both_ways(
        ("zoom in, about the finger", "zoom out, about the finger"), "+ = | -",
        also="button:6 | button:7", name="zoom-in zoom-out", first=True, steers=True,
    )  # fmt: skip
    def zoom(self, step: int) -> None:
        """Have the picture nearer or farther by a step, about the finger."""
        canvas, now = self.loaded.scene.canvas, self.aperture.zoom
        most = MOST_MM / max(canvas.width_mm, canvas.height_mm)
        others = [zoom for zoom in ZOOMS if zoom <= most and (zoom - now) * step > 0]
        if others:
            self._zoom_to(others[0 if step > 0 else -1])
        else:
            self.refuse_beyond(f"zoom: {now:g}", up=step > 0)

    @_command("show the whole picture, at zoom 1", "0", also="button:8", steers=True)
    def whole(self) -> None:
        """Show the whole picture again."""
        if self.aperture.zoom == 1.0:
            self._look_from(Aperture(self.aperture.reach_mm))
        else:
            self._zoom_to(1.0)

    @_both_ways(("more contrast", "less contrast"), "c | C", name="more-contrast less-contrast")
    def contrast(self, step: int) -> None:
        """Show the picture with another share of the actuators' swing."""
        wanted = self._contrast + step * _CONTRAST_STEP
        contrast = round(min(max(wanted, _CONTRAST_STEP), 1.0), 2)
        if contrast == self._contrast:
            self.refuse_beyond(f"contrast: {contrast:g}", up=step > 0)
            return
        self._contrast = contrast
        self._take(self.loaded, self.aperture.zoom)
        self._show()
        self.say(f"contrast: {contrast:g}")

    @command("read the file of the picture again", "ctrl-r", where=Where.PICTURE)
    def reload(self) -> None:
        """Read the file again, and show what it holds now; what is wrong with it is said."""
        try:
            loaded = load_scene(self.loaded.opened.path, self.device.model.style)
            check_fits(loaded.scene, self.display)
            self._take(loaded, self.aperture.zoom)
        except InputError as error:
            self.say(f"not reloaded: {error}; the picture is as it was", Cue.NOT_FOUND)
            return
        self._states = {}
        self._switch()
        self._show()
        self.say(f"reloaded: {loaded.title}")
        for note in loaded.notes:
            self.say(f"note: {note}")


for (name, (right, down)), bracket, button in zip(
    WAYS.items(), "][}{", (10, 9, 12, 11), strict=True
):
    _command(f"pan the picture {name}", f"ctrl-{name} {bracket}",
             name=f"pan-{name}", also=f"button:{button}", steers=True)(
        partial(Picture.pan, right=_PAN * right, down=_PAN * down)
    )  # fmt: skip
    for prefix, mm in (("", 1.0), ("shift-", 10.0)):
        help_ = f"{mm:g} mm {name}; with the device in your own hand, another element"
        _command(help_, prefix + name, name=f"move-{prefix}{name}")(
            partial(Picture.move, right_mm=mm * right, down_mm=mm * down)
        )
for key in range(1, MOST_KEYS + 1):
    also = f"button:{key + 3}" if key <= _BUTTONED else ""
    _command(f"switch {key} of the picture", str(key), name=f"switch-{key}", also=also)(
        partial(Picture.switch, key=key)
    )
