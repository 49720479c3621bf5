"""A picture under the hand: what is felt there, and the commands obeyed meanwhile."""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Final

from vbraille.cli.old.reading.keys import Context
from vbraille.cli.old.reading.view import Cue, Prompt, View
from vbraille.errors import InputError
from vbraille.feeling.aperture import ZOOMS, Aperture
from vbraille.feeling.composing import compose, viewed
from vbraille.feeling.index import SceneIndex
from vbraille.feeling.loading import FileWatch, check_fits, load_scene
from vbraille.scene.checking import kind_of
from vbraille.scene.measures import MOST_MM
from vbraille.scene.signals import Switch, packed
from vbraille.scene.traversal import each
from vbraille.simulation.steering import GlideTo, ReadPage
from vbraille.wording import spelled

if TYPE_CHECKING:
    from collections.abc import Callable
    from concurrent.futures import Future

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.cli.old.reading.device import OpenDevice
    from vbraille.cli.old.reading.keys import Bound
    from vbraille.display import Display
    from vbraille.feeling.index import NamedElement, Spot
    from vbraille.feeling.loading import LoadedScene
    from vbraille.render.program import Program
    from vbraille.scene.patterns import AnyPattern

_EVERY_S: Final = 1.0
_NS_PER_S: Final = 1_000_000_000
_LINE_MM: Final = 10.0  # between the lines that a hand goes along which goes by itself
_THERE_MM: Final = 3.0


class Guide:
    """Says the way to a place once a second, until the finger is there.

    Parameters
    ----------
    name
        What is there.
    at_mm
        The place.
    down
        Whether the hand can go up and down.

    Attributes
    ----------
    there : bool
        Whether the finger has come to the place.
    at_mm : tuple[float, float]
        The place.
    """

    def __init__(self, name: str, at_mm: tuple[float, float], *, down: bool = True) -> None:
        self.there = False
        self.at_mm = at_mm
        self._name = name
        self._down = down
        self._said_s = -math.inf

    def sentence(self, place: tuple[float, float], now_s: float) -> str:
        """Words for the way from a place in mm; empty if nothing is to be said now."""
        to = self.at_mm if self._down else (self.at_mm[0], place[1])
        if math.dist(to, place) <= _THERE_MM:
            self.there = True
            return f"there: {self._name}"
        if now_s - self._said_s < _EVERY_S:
            return ""
        self._said_s = now_s
        return f"way: {_way(place, to)}"


def _way(place: tuple[float, float], to: tuple[float, float]) -> str:
    """Words for the way from a place to another, in mm."""
    ways = [
        f"{abs(mm):.0f} mm {forward if mm > 0 else back}"
        for mm, forward, back in (
            (to[0] - place[0], "right", "left"),
            (to[1] - place[1], "down", "up"),
        )
        if abs(mm) >= 1
    ]
    return ", ".join(ways) or "less than 1 mm"


def _looks(element: NamedElement, aperture: Aperture) -> str:
    """Words for an element that says nothing of itself: its kind, its size and its textures."""
    pattern = element.pattern
    kinds = [kind_of(one).replace("-", " ") for one in each(pattern)]
    inner = dict.fromkeys(kind for kind in kinds[1:] if kind != "use")
    parts = f"{' with ' + ', '.join(inner) if inner else ''}"
    return f"{kinds[0]}, {aperture.sized(element.box)}{parts}"


# Ours: as a hand that explores goes, and one that is led somewhere.
KEYED_MM_S: Final = 60.0
LED_MM_S: Final = 100.0
_CONTRAST_STEP: Final = 0.1
_MOVED_MM: Final = 0.2  # a hand that moved less is asked about no more


class SceneView(View):
    """The view of a scene on a device; `vbraille.cli.old.reading.commands.scene` calls its methods.

    Parameters
    ----------
    loaded
        The scene.
    device
        Device that it is felt on, whose engine is started.
    rate_hz
        Frames a second.
    say
        Function that says a sentence.
    cue
        Function that gives a cue.
    bound
        Commands with their keys.
    room
        Bytes of the largest program that the engine has room for.
    at_mm
        Height at which an array is that moves along x alone; None for one where the picture is
        felt, near the middle of the canvas.
    entering
        Whether each element is said when the finger comes to it.
    watched
        Whether the picture is read again when its file has changed.
    goes
        Whether a simulated hand goes over the picture by itself; without anybody at a keyboard
        that is all.
    zoom
        Zoom to begin with.
    sound
        Function that plays a file of sound; None where nothing plays them.
    sounding
        Whether the sounds of elements are played beside their words.

    Attributes
    ----------
    aperture : Aperture
        Zoom, and which part of the picture is within reach.
    contrast : float
        Factor of all deflections, from 0 to 1.
    loaded : LoadedScene
        The scene as its file has it.
    shown : LoadedScene
        The scene at its zoom.
    under : NamedElement or None
        Element that was under the finger when that was last looked for.
    """

    does, doing = "feel", "feeling"

    def __init__(
        self,
        loaded: LoadedScene,
        device: OpenDevice,
        *,
        rate_hz: float,
        say: Callable[[str], None],
        bound: Bound,
        room: int,
        cue: Callable[[Cue], None] = lambda _: None,
        at_mm: float | None = None,
        entering: bool = False,
        watched: bool = False,
        goes: bool = False,
        zoom: float = 1.0,
        sound: Callable[[Path], None] | None = None,
        sounding: bool = False,
    ) -> None:
        super().__init__(device.engine, say, bound, cue)
        self.loaded = loaded
        self.shown = loaded.zoomed(zoom)
        reach_mm = device.engine.display.travel_mm, device.engine.display.height_mm
        self.aperture = Aperture(reach_mm, zoom)
        self.contrast = 1.0
        self.entering = entering or sounding
        self.sounding = sounding
        self._sound = sound
        self.under: NamedElement | None = None
        self._device = device
        self._room = room
        self._rate_hz = rate_hz
        # Of the canvas at its zoom, as all places here but those that are said.
        self._at_mm = zoom * (loaded.scene.canvas.height_mm / 2 if at_mm is None else at_mm)
        self._chosen = at_mm is not None
        self._outside = False  # whether it is to be seen if a person's finger is on the picture
        self._aim: tuple[float, float] | None = None  # where keys have sent the hand
        self._looked_at = (math.nan, math.nan)
        self._guide: Guide | None = None
        self._names: list[str] = []  # of elements that were typed
        self._spot: Spot | None = None  # what the finger was on when that was last looked for
        self._element = -1  # number of the element that was gone to last
        self._states: dict[int, int] = {}  # of the picture's switches, by their keys
        self._index = self._index_of(self.shown)
        self._whole: tuple[LoadedScene, float, Program] | None = None  # at a contrast
        self._maker = ThreadPoolExecutor(1)  # makes the picture at another zoom meanwhile
        self._making: Future[tuple[LoadedScene, Program]] | None = None
        self._zoom_wanted = zoom
        self._watch = FileWatch(Path(loaded.opened.path)) if watched else None
        self._goes = goes and device.steering is not None

    @property
    def display(self) -> Display:
        """Display of the device."""
        return self.engine.display

    @property
    def place(self) -> tuple[float, float] | None:
        """Place of the array's centre on the canvas, in mm; None before it is known."""
        pose = self._device.pose
        return None if pose is None else self.aperture.on_canvas(pose.x_mm, pose.y_mm)

    def start(self, program: Program) -> None:
        """Put the scene under the hand, where something of it is felt, and say what it is.

        The program is that of the scene as its file has it.
        """
        self._set_switches()
        if not (self.display.height_mm or self._chosen):
            self._at_mm = self._index.inside()[1]
        self._whole = self.loaded, self.contrast, program
        self._show(program if self.shown is self.loaded else self._compose(self.shown))
        self.steer()
        self.say_scene()
        if not self.display.height_mm:
            self.say(
                "one axis: this device's carriage goes along x only, so that one line of the "
                f"picture is felt at a time, now at {self._height()}; "
                f"{self.key('DOWN', 'down')} and {self.key('UP', 'up')} choose another"
            )

    def steer(self) -> None:
        """Have a hand that goes by itself go over the whole picture, another begin inside it."""
        steering = self._device.steering
        if self._goes and steering is not None:
            canvas = self.loaded.scene.canvas
            lines = max(1, round(canvas.height_mm / _LINE_MM))
            steering.give(ReadPage(lines, canvas.height_mm / lines, canvas.width_mm))
        elif steering is not None:
            self._glide(self._index.inside(), LED_MM_S)
        else:
            self._outside = self.display.height_mm > 0 or not self._chosen

    def step(self, ticks: NDArray[np.void]) -> None:
        """Look where the hand is, and whether the file has changed or the hand is done."""
        if self._device.held:  # keys move the hand from where another person has left it
            self._aim = None
        self.attend(float(ticks["time_ns"][-1]) / _NS_PER_S)
        if self._watch is not None and self._watch.changed():
            self.reload()
        steering = self._device.steering
        if self._goes and steering is not None and not self._device.attended:
            self.done = self.done or steering.done_at(int(ticks["device_ns"][-1]))

    def attend(self, now_s: float) -> None:
        """Do what is done by time: say what the finger comes to, and the way to what is sought."""
        self._take_zoom()
        place = self.place
        if place is None:
            return
        if self._outside:  # unless the finger is on the picture by chance
            self._outside = False
            if self._index.where(*place) is None:
                down = self.display.height_mm > 0
                self._guide = Guide("picture", self._index.inside(), down=down)
        if self._guide is not None:
            sentence = self._guide.sentence(place, now_s)
            if sentence:
                self.say(sentence)
            if self._guide.there:
                self._guide = None
        if math.dist(place, self._looked_at) < _MOVED_MM:
            return
        self._looked_at = place
        before, self._spot = self._spot, self._index.where(*place)
        spot = self._spot
        self.under = None if spot is None or spot.where == "inside" else spot.element
        if not self.entering or spot == before:
            return
        if before is not None and (spot is None or spot.element is not before.element):
            if not self._index.encloses(before.element, *place):
                self.say(f"leaving: {before.element.name}")
            before = None
        if spot is not None and before is None:
            self._enter(spot.element.pattern, spot.element.name)
        elif spot is not None:
            self.say(f"{spot.where}: {spot.element.name}")

    def _enter(self, pattern: AnyPattern, name: str) -> None:
        """Say that the finger comes to an element, and play its sound."""
        self.say(pattern.words or f"entering: {name}")
        if self.sounding and pattern.sound and self._sound is not None:
            self._sound(self.loaded.opened.folder / pattern.sound)

    # What is asked for

    def say_scene(self) -> None:
        """Say the title and the description of the picture."""
        scene = self.loaded.scene
        self.say(f"picture: {self.loaded.title}")
        if scene.description:
            self.say(f"description: {scene.description}")
        self.say(f"size: {scene.canvas.width_mm:g} mm × {scene.canvas.height_mm:g} mm")
        if not self.aperture.is_whole:
            self.say_aperture()

    def say_aperture(self) -> None:
        """Say the zoom, and which part of the picture is within reach."""
        words = self.aperture.words(self.shown.scene.canvas)
        self.say(f"zoom: {self.aperture.zoom:g}, within reach {words}")

    def say_here(self) -> None:
        """Say what is under the middle of the array, and where that is."""
        place = self.place
        if place is None:
            self.say("place: not known yet")
            return
        spot = self._index.where(*place)
        if spot is None:
            self._say_nearest(place)
        else:
            where = {"edge": "edge of ", "inside": "inside "}.get(spot.where, "")
            self.say(f"here: {where}{spot.element.name}")
        self.say(f"place: {self.aperture.placed(*place)}")

    def _say_nearest(self, place: tuple[float, float]) -> None:
        """Say that nothing is here, and which element is nearest."""
        self.say("here: nothing with a name")
        found = self._index.nearest(*place)
        if found is not None:
            element, to = found
            self.say(f"nearest: {element.name}, {_way(place, to)}")

    def describe_here(self) -> None:
        """Say what is under the middle of the array: its description, or else its look."""
        place = self.place
        spot = None if place is None else self._index.where(*place)
        if spot is not None:
            element = spot.element
            self.say(f"{element.name}: {element.description or _looks(element, self.aperture)}")
        elif place is None:
            self.say("place: not known yet")
        else:
            self._say_nearest(place)

    def say_elements(self) -> None:
        """Say the elements that have a name."""
        if not self._index.elements:
            self.say("elements: none has a name")
        for element in self._index.elements:
            box = element.box
            middle = (box.left + box.right) / 2, (box.top + box.bottom) / 2
            said = f"{self.aperture.sized(box)}, middle {self.aperture.placed(*middle)}"
            place = "outside" if box.is_empty else said
            self.say(f"element: {element.name}, {place}")

    def ask_element(self) -> None:
        """Ask for the name of an element, and go there."""
        self.prompt = Prompt("element", self.go_to, others=self._names)
        self.context = Context.PROMPT
        self.say("go to an element: type its title or id, then enter")

    def go_to(self, name: str) -> None:
        """Go to an element by its name, or say the way there to the person who moves the device."""
        found = self._index.find(name)
        if found is None:
            self.cue(Cue.NOT_FOUND)
            self.say(f"element: none is called {name}; {self.key('ELEMENTS', 'e')} says them all")
        else:
            self._go_to(found)

    def step_element(self, step: int) -> None:
        """Go to the next element that has a name, or to the one before."""
        number = self._element + step
        if self._element < 0 and step < 0:
            number = len(self._index.elements) - 1
        if 0 <= number < len(self._index.elements):
            if self._device.steering is None:
                self.say(f"element: {self._index.elements[number].name}")
            self._go_to(self._index.elements[number])
        else:
            self.cue(Cue.LIMIT)
            self.say(f"element: no {'more' if step > 0 else 'others before'}")

    def _go_to(self, element: NamedElement) -> None:
        self._element = self._index.elements.index(element)
        if self._device.steering is not None:
            self.say(f"going to: {element.name}")
        self._lead(element.name, self._index.point_on(element))

    def cancel(self) -> None:
        """Say the way no more."""
        if self._guide is not None:
            self._guide = None
            self.say("way: no longer said")

    def toggle_entering(self) -> None:
        """Say each element when the finger comes to it, then with its sound, then no longer."""
        has_sounds = self._sound is not None and any(
            element.pattern.sound for element in self._index.elements
        )
        self.entering, self.sounding = (
            not self.entering or (has_sounds and not self.sounding),
            self.entering and has_sounds and not self.sounding,
        )
        said = "said, with sounds" if self.sounding else "said"
        self.say(f"entering: {said if self.entering else 'not said'}")

    # What is changed

    def move(self, right_mm: float, down_mm: float) -> None:
        """Move a simulated hand; on a device of one axis, choose another height.

        A person moves the device by hand: to them it says the way to the next element.
        """
        if not self.display.height_mm and down_mm:
            self._choose_height(self._at_mm + down_mm)
            return
        if self._device.steering is None:
            self.step_element(1 if right_mm + down_mm > 0 else -1)
            return
        begun = self._aim or self.place
        if begun is not None:
            self._glide((begun[0] + right_mm, begun[1] + down_mm), KEYED_MM_S)

    def go_to_middle(self) -> None:
        """Go to the middle of the canvas."""
        canvas = self.shown.scene.canvas
        self._lead("middle", (canvas.width_mm / 2, canvas.height_mm / 2))

    def turn_contrast(self, step: int) -> None:
        """Show the picture with more or less of the actuators' swing."""
        contrast = round(min(max(self.contrast + step * _CONTRAST_STEP, _CONTRAST_STEP), 1.0), 2)
        if contrast == self.contrast:
            self.cue(Cue.LIMIT)
        else:
            self.contrast = contrast
            self._show(self._compose(self.shown))
            self._make_again()
        self.say(f"contrast: {self.contrast:g}")

    def switch(self, key: int) -> None:
        """Put a switch of the picture into its next state."""
        switches = [
            one
            for one in self.loaded.scene.signals.values()
            if isinstance(one, Switch) and one.key == key
        ]
        if not switches:
            self.cue(Cue.LIMIT)
            self.say(f"switch {key}: this picture has none")
            return
        self._states[key] = (self._states.get(key, 0) + 1) % len(switches[0].levels)
        self._set_switches()
        state = self._states[key]
        name = next((one.states[state] for one in switches if one.states), str(state + 1))
        title = next((one.title for one in switches if one.title), f"switch {key}")
        self.say(f"{title}: {name}")

    def _set_switches(self) -> None:
        states = packed(self._states, self.loaded.scene.signals)
        self.engine.switches = self._index.switches = states
        self._looked_at = (math.nan, math.nan)

    def reload(self) -> None:
        """Read the file again, and show what it holds now; what is wrong with it is said."""
        try:
            loaded = load_scene(self.loaded.opened.path, self._device.style)
            check_fits(loaded.scene, self.display)
            shown = loaded.zoomed(self.aperture.zoom)
            program = self._compose(shown)
            if program.nbytes > self._room:
                raise InputError("the picture has become too large; begin anew with it")
        except InputError as error:
            self.cue(Cue.NOT_FOUND)
            self.say(f"not reloaded: {spelled(str(error))}")
            self.say("picture: as it was")
            return
        self._show(program)  # what can wait comes after it
        self.loaded, self.shown = loaded, shown
        self._make_again()
        self._element = -1
        self._states = {}
        self._look_anew()
        self.say(f"reloaded: {loaded.title}")
        for note in loaded.notes:
            self.say(f"note: {note}")

    def _choose_height(self, y_mm: float) -> None:
        """Show the line of the picture at another height."""
        self._at_mm = min(max(y_mm, 0.0), self.shown.scene.canvas.height_mm)
        self._show(self._program)
        self.say(f"height: {self._height()}")

    def _height(self) -> str:
        return f"{self._at_mm / self.aperture.zoom:.0f} mm from the top"

    # Zoom and pan

    def zoom(self, step: int) -> None:
        """Have the picture nearer or farther by a step, about the finger."""
        canvas, now = self.loaded.scene.canvas, self._zoom_wanted
        most = MOST_MM / max(canvas.width_mm, canvas.height_mm)
        others = [zoom for zoom in ZOOMS if zoom <= most and (zoom - now) * step > 0]
        if others:
            self._want_zoom(min(others) if step > 0 else max(others))
        else:
            self.cue(Cue.LIMIT)
            self.say(f"zoom: {now:g}, no {'nearer' if step > 0 else 'farther'}")

    def _want_zoom(self, zoom: float) -> None:
        """Begin to make the picture at a zoom; what is felt stays until that is done."""
        loaded = self.loaded

        def make() -> tuple[LoadedScene, Program]:
            shown = loaded.zoomed(zoom)
            return shown, self._compose(shown)

        self._stop_making()
        self._zoom_wanted = zoom
        self._making = self._maker.submit(make)

    def _stop_making(self) -> None:
        """Make no picture at another zoom any more."""
        if self._making is not None:
            self._making.cancel()  # unless it has begun
        self._making, self._zoom_wanted = None, self.aperture.zoom

    def _make_again(self) -> None:
        """Begin anew with a picture that is being made of what was felt before."""
        wanted, is_made = self._zoom_wanted, self._making is not None
        self._stop_making()
        if is_made:
            self._want_zoom(wanted)

    def _take_zoom(self) -> None:
        """Show the picture at the zoom that is wanted, once it is made."""
        if self._making is None or not self._making.done():
            return
        making = self._making
        try:
            shown, program = making.result()
            if program.nbytes > self._room:
                raise InputError("the picture would be too large there")
        except InputError as error:
            self._stop_making()
            self.cue(Cue.NOT_FOUND)
            self.say(f"zoom: still {self.aperture.zoom:g}; {spelled(str(error))}")
            return
        pose = self._device.pose
        at_mm = (0.0, 0.0) if pose is None else (pose.x_mm, pose.y_mm)
        self._show_zoomed(shown, program, self.aperture.zoomed(shown.zoom, at_mm))

    def _show_zoomed(self, shown: LoadedScene, program: Program, aperture: Aperture) -> None:
        """Show the picture at another zoom."""
        share = aperture.zoom / self.aperture.zoom
        self._at_mm *= share
        self.aperture = aperture
        self._show(program)  # what can wait comes after it
        self._stop_making()
        self.shown = shown
        if self._guide is not None:
            self._guide.at_mm = self._guide.at_mm[0] * share, self._guide.at_mm[1] * share
        self._look_anew()
        self.say_aperture()

    def show_whole(self) -> None:
        """Show the picture as it is written, from its top left corner on."""
        whole = Aperture(self.aperture.reach_mm)
        if self.shown.zoom == 1.0:
            self._stop_making()
            self._look_from(whole)
            return
        if self._whole is None or self._whole[:2] != (self.loaded, self.contrast):
            self._whole = self.loaded, self.contrast, self._compose(self.loaded)
        self._show_zoomed(self.loaded, self._whole[2], whole)

    def pan(self, right: float, down: float) -> None:
        """Move the part that is within reach, by shares of that."""
        if down and not self.display.height_mm:
            self._choose_height(self._at_mm + math.copysign(_LINE_MM, down))
            return
        moved = self.aperture.panned(right, down, self.shown.scene.canvas)
        if moved == self.aperture:
            self.cue(Cue.LIMIT)
        self._look_from(moved)

    def _look_from(self, aperture: Aperture) -> None:
        """Show the picture from elsewhere on the canvas, at the same zoom."""
        if aperture != self.aperture:
            self.aperture = aperture
            self._aim = None
            self._looked_at = (math.nan, math.nan)
            self._show(self._program)
        self.say_aperture()

    def _look_anew(self) -> None:
        """Look for elements in what is shown from now on."""
        before = self._index.elements[self._element].name if self._element >= 0 else ""
        self._index = self._index_of(self.shown)
        names = [element.name for element in self._index.elements]
        self._element = names.index(before) if before in names else -1
        self._spot = self._aim = None
        self._set_switches()

    def _lead(self, name: str, to: tuple[float, float]) -> None:
        """Have a simulated hand go to a place, or say the way there; one axis takes its height.

        Where the place is out of reach, the picture is moved so that it is within.
        """
        brought = self.aperture.reaching(*to)
        if brought != self.aperture:
            self._look_from(brought)
        if not self.display.height_mm:
            self._choose_height(to[1])
        if self._device.steering is not None:
            self._glide(to, LED_MM_S)
        else:
            self._guide = Guide(name, to, down=self.display.height_mm > 0)

    def _glide(self, to: tuple[float, float], speed_mm_s: float) -> None:
        display = self.display
        x_mm, y_mm = self.aperture.of_carriage(*to)
        x_mm = min(max(x_mm, -display.span_mm / 2), display.travel_mm - display.span_mm / 2)
        y_mm = min(max(y_mm, 0.0), display.height_mm)
        self._aim = self.aperture.on_canvas(x_mm, y_mm)
        steering = self._device.steering
        if steering is not None:
            steering.give(GlideTo(x_mm, y_mm, speed_mm_s))

    def _compose(self, loaded: LoadedScene) -> Program:
        return compose(
            loaded,
            self.display,
            rate_hz=self._rate_hz,
            contrast=self.contrast,
        )

    def _show(self, program: Program) -> None:
        self._program = program
        origin_mm = self.aperture.left_mm, self.aperture.top_mm
        self.engine.show(viewed(program, self._at_mm, origin_mm), 1)

    def _index_of(self, loaded: LoadedScene) -> SceneIndex:
        return SceneIndex(loaded.scene, loaded.assets, loaded.boxes())
