"""Commands for a picture: what is here, what else there is, zoom and switches."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

from vbraille.feeling.aperture import Aperture
from vbraille.reading.commands import Where, both_ways, command
from vbraille.reading.outputs import Cue
from vbraille.reading.picture import way
from vbraille.scene.checking import kind_of
from vbraille.scene.signals import MOST_KEYS
from vbraille.scene.traversal import each

if TYPE_CHECKING:
    from vbraille.feeling.index import NamedElement
    from vbraille.reading.picture import Picture

_WHERE = Where.PICTURE | Where.FIGURE
_command = partial(command, where=_WHERE)
_PAN, _LINE_MM = 0.5, 10.0  # of what is within reach; on a device of one axis
_CONTRAST_STEP = 0.1


@command("back to the text", "G", "E", where=Where.FIGURE, first=True)
def leave(picture: Picture) -> None:
    picture.done = True


@_command("say the way to an element no more", "escape")
def cancel(picture: Picture) -> None:
    if picture.goal is not None:
        picture.goal = None
        picture.say("way: no longer said")
    elif picture.where is Where.FIGURE:
        picture.done = True
    else:
        picture.refuse("nothing to cancel")


@_command(
    "say what is under the finger, and where", "i u", also="button:1", first=True, steers=True
)
def say_here(picture: Picture) -> None:
    place = picture.place
    if place is None:
        picture.say("the place of the finger is not known yet")
        return
    spot = picture.index.where(*place)
    if spot is None:
        said = f"nothing with a name{_nearest(picture, place)}"
    else:
        where = {"edge": "edge of ", "inside": "inside "}.get(spot.where, "")
        said = f"{where}{spot.element.name}"
    picture.say(f"here: {said}; {picture.aperture.placed(*place)}")


def _nearest(picture: Picture, place: tuple[float, float]) -> str:
    found = picture.index.nearest(*place)
    return "" if found is None else f", nearest {found[0].name}, {way(place, found[1])}"


@_command("say more of what is under the finger", "w", also="button:2")
def describe(picture: Picture) -> None:
    place = picture.place
    spot = None if place is None else picture.index.where(*place)
    if spot is not None:
        element = spot.element
        picture.say(f"{element.name}: {element.description or _looks(picture, element)}")
    else:
        picture.say(f"nothing here{'' if place is None else _nearest(picture, place)}")


def _looks(picture: Picture, element: NamedElement) -> str:
    """Words for an element that says nothing of itself: its kind, its size and its textures."""
    kinds = [kind_of(one).replace("-", " ") for one in each(element.pattern)]
    inner = dict.fromkeys(kind for kind in kinds[1:] if kind != "use")
    parts = f" with {', '.join(inner)}" if inner else ""
    return f"{kinds[0]}, {picture.aperture.sized(element.box)}{parts}"


@_command("say what the picture is", "V f5")
def say_picture(picture: Picture) -> None:
    picture.say_picture()


@_command("list the elements that have a name", "O", first=True)
def elements(picture: Picture) -> None:
    if not picture.index.elements:
        picture.refuse("no element has a name")
    for element in picture.index.elements:
        box = element.box
        middle = (box.left + box.right) / 2, (box.top + box.bottom) / 2
        said = f"{picture.aperture.sized(box)}, middle {picture.aperture.placed(*middle)}"
        picture.say(f"{element.name}: {'outside' if box.is_empty else said}")


@_command("go to an element by its name", "g /", first=True)
def go_to(picture: Picture) -> None:
    def answer(typed: str) -> None:
        element = picture.index.find(typed) if typed.strip() else None
        if element is None:
            picture.say(f"no element {typed!r}; shift-o lists them", Cue.NOT_FOUND)
        else:
            picture.go_to(element)

    names = [element.name for element in picture.index.elements]
    picture.ask("element", answer, names[::-1])


@both_ways("element", "n e p E", "n e p", first=True, where=_WHERE)
def element(picture: Picture, step: int) -> None:
    _step(picture, step)


def _step(picture: Picture, step: int) -> None:
    found = picture.index.elements
    number = picture.element + step
    if picture.element < 0 and step < 0:
        number = len(found) - 1
    if 0 <= number < len(found):
        picture.go_to(found[number])
    else:
        picture.refuse(f"no {'next' if step > 0 else 'previous'} element")


@_command("say each element as the finger comes to it, with its sound, or not", "v f6", steers=True)
def entering(picture: Picture) -> None:
    if not picture.entering:
        picture.entering = True
    elif picture.has_sounds and not picture.sounding:
        picture.sounding = True
    else:
        picture.entering = picture.sounding = False
    said = "said, with sounds" if picture.sounding else "said"
    picture.say(f"elements: {said if picture.entering else 'not said'} as you come to them")


@_command("go to the middle of the picture", "home")
def middle(picture: Picture) -> None:
    canvas = picture.shown.scene.canvas
    picture.say("going to: middle")
    picture.lead("middle", (canvas.width_mm / 2, canvas.height_mm / 2))


def _move(picture: Picture, right_mm: float, down_mm: float) -> None:
    if down_mm and not picture.flat:
        place = picture.place
        picture.choose_height((place or (0.0, 0.0))[1] + down_mm)
    elif not picture.move(right_mm, down_mm):  # a person moves the device
        _step(picture, 1 if right_mm + down_mm > 0 else -1)


def _pan(picture: Picture, right: float, down: float) -> None:
    if down and not picture.flat:
        _move(picture, 0, math.copysign(_LINE_MM, down))
        return
    moved = picture.aperture.panned(right, down, picture.shown.scene.canvas)
    if moved == picture.aperture:
        picture.refuse("no more of the picture that way")
    else:
        picture.look_from(moved)


def _add_ways() -> None:
    ways = {
        "right": (1, 0, "]", 10), "left": (-1, 0, "[", 9),
        "down": (0, 1, "}", 12), "up": (0, -1, "{", 11),
    }  # fmt: skip
    for name, (right, down, bracket, button) in ways.items():

        @_command(f"part of the picture farther {name}", f"ctrl-{name} {bracket}",
                 name=f"pan-{name}", also=f"button:{button}", steers=True)  # fmt: skip
        def pan(picture: Picture, by: tuple = (_PAN * right, _PAN * down)) -> None:
            _pan(picture, *by)

        for prefix, mm in (("", 1.0), ("shift-", 10.0)):
            help_ = f"{mm:g} mm {name}; with the device in your own hand, another element"

            @_command(help_, prefix + name, name=f"move-{prefix}{name}")
            def move(picture: Picture, by: tuple = (mm * right, mm * down)) -> None:
                _move(picture, *by)


def _add_switches() -> None:
    for key in range(1, MOST_KEYS + 1):
        button = {1: "button:4", 2: "button:5"}.get(key, "")

        @_command(f"switch {key} of the picture", str(key), name=f"switch-{key}", also=button)
        def switch(picture: Picture, key: int = key) -> None:
            picture.switch(key)


_add_ways()
_add_switches()


@_command("nearer, about the finger", "+ =", also="button:6", first=True, steers=True)
def zoom_in(picture: Picture) -> None:
    picture.zoom(1)


@_command("farther, about the finger", "-", also="button:7", steers=True)
def zoom_out(picture: Picture) -> None:
    picture.zoom(-1)


@_command("the whole picture again, as written", "0", also="button:8", steers=True)
def whole(picture: Picture) -> None:
    if picture.aperture.zoom == 1.0:
        picture.look_from(Aperture(picture.aperture.reach_mm))
    else:
        picture.zoom_to(1.0)


@_command("say the zoom, and what is within reach", "z")
def say_zoom(picture: Picture) -> None:
    picture.say_aperture()


def _contrast(picture: Picture, by: float) -> None:
    contrast = round(min(max(picture.contrast + by, _CONTRAST_STEP), 1.0), 2)
    if contrast == picture.contrast:
        picture.refuse(f"contrast: {contrast:g} is the {'most' if by > 0 else 'least'}")
        return
    picture.set_contrast(contrast)
    picture.say(f"contrast: {contrast:g}")


@_command("more contrast", "c")
def more_contrast(picture: Picture) -> None:
    _contrast(picture, _CONTRAST_STEP)


@_command("less contrast", "C")
def less_contrast(picture: Picture) -> None:
    _contrast(picture, -_CONTRAST_STEP)


@command("read the file of the picture again", "ctrl-r", where=Where.PICTURE)
def reload(picture: Picture) -> None:
    picture.reload()
