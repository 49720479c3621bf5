"""Scenes as they are shown: each use replaced by what it names, and each image of dots by dots."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.scene.dotting import most_dots_of
from vbraille.scene.locations import Locations
from vbraille.scene.patterns import Group, ImageDots, Use
from vbraille.scene.signals import MOST_SIGNALS, Switch, circle, made_of
from vbraille.scene.stock import STOCK, stock_textures
from vbraille.scene.traversal import (
    LISTS,
    SEVERAL,
    each,
    moved,
    placed_children,
    signals_of,
    with_children,
)
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.scene import Scene
    from vbraille.scene.traversal import Steps

# Uses of uses of uses can stand for more than any memory holds.
MOST_PATTERNS, MOST_POINTS = 200_000, 4_000_000
MOST_DOTS = 200_000  # along shapes, which no author has written down
MOST_DEPTH = 32


def resolve(scene: Scene, folder: Path | None = None, locations: Locations | None = None) -> Scene:
    """Scene as it is shown, without names.

    Each `Use` is replaced by the pattern that it names, moved by value. Changes of its own stand
    in a `Group` around it, and its title and description count before those of what it names.
    Each `ImageDots` is replaced by its dots. The scene that is given back has no named textures,
    and what stands in a copy has no id.

    Parameters
    ----------
    scene
        The scene.
    folder
        Folder that the names of image files are seen from; None for the present one.
    locations
        Where its elements are written, for messages; None if it comes from no file.

    Raises
    ------
    InputError
        If a name is not known or given twice, uses or signals lead back to themselves, patterns or
        uses nest more than 32 deep, there are more than 200,000 patterns, 4,000,000 points, 200,000
        dots along shapes or 8 signals, something is moved too far, or an image of dots cannot be
        read.
    """
    return _Resolving(scene, folder or Path(), locations or Locations()).scene()


@dataclass(frozen=True, slots=True)
class _Body:
    """Pattern that a name stands for, without names, and how much it is."""

    pattern: AnyPattern
    patterns: int
    points: int
    dots: int
    depth: int


class _Resolving:
    """A scene that is being resolved, and how much it has become so far."""

    def __init__(self, scene: Scene, folder: Path, locations: Locations) -> None:
        self._written, self._folder, self._locations = scene, folder, locations
        self._named: dict[str, tuple[Steps, AnyPattern]] = {}
        self._bodies: dict[str, _Body] = {}
        self._open: list[str] = []  # names whose uses are being replaced, outermost first
        self._patterns = self._points = self._dots = 0

    def scene(self) -> Scene:
        """Resolve the whole scene."""
        textures = self._written.textures
        for name, pattern in textures.items():
            self._name(("textures", name), name, pattern)
        for steps, pattern in self._all():
            self._count(steps, 1, points_of(pattern), most_dots_of(pattern))
            if pattern.id:
                self._name(steps, pattern.id, pattern)
        self._check_signals()
        for name in textures:  # also those that nothing uses are to be right
            self._body(name, ("textures", name))
        elements = tuple(
            self._resolved(element, ("elements", number))
            for number, element in enumerate(self._written.elements)
        )
        return replace(self._written, textures={}, elements=elements)

    def _check_signals(self) -> None:
        """Refuse signals that lead back to themselves or are not there, and too many of them."""
        signals = self._written.signals
        for name, signal in signals.items():
            for one in made_of(signal):
                self._check_signal(("signals", name), one)
            if isinstance(signal, Switch):
                self._check_levels(name, signal)
        way = circle(signals)
        if way:
            self._fail(("signals", way[0]), f"is made of itself: {', '.join(way)}; leave one out")
        for steps, pattern in self._all():
            for more, name in signals_of(pattern):
                self._check_signal((*steps, *more), name)
        if len(signals) > MOST_SIGNALS:
            last = list(signals)[MOST_SIGNALS]
            self._fail(
                ("signals", last), f"is one signal more than the {MOST_SIGNALS} there can be"
            )

    def _check_levels(self, name: str, switch: Switch) -> None:
        """Refuse switches of one key that have not the same number of states."""
        for other, one in self._written.signals.items():
            if isinstance(one, Switch) and one.key == switch.key:
                if len(one.levels) == len(switch.levels):
                    return
                self._fail(
                    ("signals", name),
                    f"has {len(switch.levels)} levels, and {other}, of the same key "
                    f"{switch.key}, {len(one.levels)}; give both as many",
                )

    def _check_signal(self, steps: Steps, name: str) -> None:
        signals = self._written.signals
        if name not in signals:
            self._fail(steps, f"is {name!r}, which is no signal here{nearest(name, signals)}")

    def _all(self) -> Iterator[tuple[Steps, AnyPattern]]:
        """All patterns of the scene as it is written, in order, with the keys that lead to them."""
        left: list[tuple[Steps, AnyPattern, int]] = [
            *((("textures", name), one, 1) for name, one in self._written.textures.items()),
            *((("elements", n), one, 1) for n, one in enumerate(self._written.elements)),
        ][::-1]
        while left:
            steps, pattern, depth = left.pop()
            if depth > MOST_DEPTH:
                self._fail(steps, f"nests more than {MOST_DEPTH} deep; make it flatter")
            yield steps, pattern
            inside = [((*steps, *more), part, depth + 1) for more, part in placed_children(pattern)]
            left += inside[::-1]

    def _name(self, steps: Steps, name: str, pattern: AnyPattern) -> None:
        if name.startswith(STOCK):
            self._fail(steps, f"is called {name}; only the program's own names begin with {STOCK}")
        if name in self._named and self._named[name][0] != steps:
            first = self._locations.place(self._named[name][0])
            self._fail(steps, f"is called {name}, as is {first}; give it another name")
        self._named[name] = steps, pattern

    def _count(self, steps: Steps, patterns: int, points: int, dots: int) -> None:
        """Refuse what no memory holds, before it is made."""
        self._patterns += patterns
        self._points += points
        self._dots += dots
        if self._dots > MOST_DOTS:
            self._fail(
                steps,
                f"makes it more than {MOST_DOTS} dots along shapes; set them farther apart, or "
                "use fewer",
            )
        if self._patterns > MOST_PATTERNS:
            self._fail(steps, f"makes it more than {MOST_PATTERNS} patterns; use fewer")
        if self._points > MOST_POINTS:
            self._fail(steps, f"makes it more than {MOST_POINTS} points; use fewer")

    def _resolved(self, pattern: AnyPattern, steps: Steps) -> AnyPattern:
        if isinstance(pattern, Use):
            return self._used(pattern, steps)
        if isinstance(pattern, ImageDots):
            from vbraille.scene.blobs import dots_of  # loads the reading of images

            try:
                return dots_of(pattern, self._folder)
            except InputError as error:
                self._fail(steps, f": {error}")
        return with_children(pattern, lambda more, part: self._resolved(part, (*steps, *more)))

    def _used(self, use: Use, steps: Steps) -> AnyPattern:
        """Tell what a use stands for, with its changes."""
        body = self._body(use.name, steps)
        self._count(steps, body.patterns, body.points, body.dots)
        try:
            pattern = moved(body.pattern, use.move_mm)
        except ValueError as error:
            self._fail(steps, f"cannot be moved so far: {error}")
        title = use.title or pattern.title
        description = use.description or pattern.description
        changed = use.amplitude != 1.0 or use.inverted or use.vibration or use.factor
        heard = use.words or use.sound
        if not (changed or heard) and use.zoom_from is None and use.zoom_to is None:
            return _called(pattern, use.id, title, description)
        return Group(
            operation="maximum",
            parts=(_called(pattern, "", "", ""),),
            words=use.words or pattern.words,
            sound=use.sound or pattern.sound,
            amplitude=use.amplitude,
            inverted=use.inverted,
            vibration=use.vibration,
            factor=use.factor,
            zoom_from=use.zoom_from,
            zoom_to=use.zoom_to,
            id=use.id,
            title=title,
            description=description,
        )

    def _body(self, name: str, steps: Steps) -> _Body:
        """Tell what a name stands for, made once."""
        if name in self._bodies:
            return self._bodies[name]
        if name in self._open:
            way = ", ".join([*self._open[self._open.index(name) :], name])
            self._fail(steps, f"uses itself: {way}; leave one of these uses out")
        if len(self._open) >= MOST_DEPTH:
            self._fail(steps, f"uses uses more than {MOST_DEPTH} deep; make it flatter")
        if name.startswith(STOCK):
            stock = stock_textures()
            if name.removeprefix(STOCK) not in stock:
                self._fail_unknown(name, steps, [f"{STOCK}{one}" for one in stock])
            pattern = stock[name.removeprefix(STOCK)]
        elif name in self._named:
            there, written = self._named[name]
            self._open.append(name)
            pattern = self._resolved(written, there)
            self._open.pop()
        else:
            stock = [f"{STOCK}{one}" for one in stock_textures()]
            self._fail_unknown(name, steps, [*self._named, *stock])
        body = _measured(_nameless(pattern))
        if body.depth > MOST_DEPTH:
            self._fail(steps, f"nests more than {MOST_DEPTH} deep by what it uses; make it flatter")
        self._bodies[name] = body
        return body

    def _fail(self, steps: Steps, problem: str) -> NoReturn:
        self._locations.fail(steps, problem)

    def _fail_unknown(self, name: str, steps: Steps, names: Iterable[str]) -> NoReturn:
        self._fail(steps, f"name is {name!r}, which nothing here is called{nearest(name, names)}")


def points_of(pattern: AnyPattern) -> int:
    """Number of points that a pattern has itself."""
    several = sum(len(getattr(pattern, name)) for name in SEVERAL if hasattr(pattern, name))
    lists = (getattr(pattern, name) for name in LISTS if hasattr(pattern, name))
    return several + sum(len(one) for contours in lists for one in contours)


def _nameless(pattern: AnyPattern) -> AnyPattern:
    """Pattern without ids, since each is the name of one thing."""
    inside = with_children(pattern, lambda _, part: _nameless(part))
    return _called(inside, "", inside.title, inside.description)


def _called(pattern: AnyPattern, name: str, title: str, description: str) -> AnyPattern:
    """Pattern with another id, title and description; made anew, and checked, only if need be."""
    if (pattern.id, pattern.title, pattern.description) == (name, title, description):
        return pattern
    return replace(pattern, id=name, title=title, description=description)


def _measured(pattern: AnyPattern) -> _Body:
    patterns = points = dots = depth = 0
    for one in each(pattern):
        patterns += 1
        points += points_of(one)
        dots += most_dots_of(one)
    level = [pattern]
    while level:
        depth += 1
        level = [part for one in level for _, part in placed_children(one)]
    return _Body(pattern, patterns, points, dots, depth)
