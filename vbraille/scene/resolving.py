"""Scenes as they are shown: each use replaced by what it names, and each image of dots by dots."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, NoReturn

from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.scene.geometry import most_dots_of
from vbraille.scene.locations import Locations
from vbraille.scene.patterns import Group, ImageDots, Pattern, Use
from vbraille.scene.signals import MOST_SIGNALS, Switch, made_of, ordered
from vbraille.scene.stock import STOCK, stock_textures
from vbraille.scene.traversal import (
    children,
    each,
    mapped,
    moved,
    placed_children,
    points_of,
    signals_of,
    with_children,
)
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.scene import Scene
    from vbraille.scene.traversal import Steps

# Uses of uses of uses can stand for more than any memory holds.
MOST_PATTERNS, MOST_POINTS = 200_000, 4_000_000
MOST_DOTS = 200_000  # along shapes, which no author has written down
MOST_DEPTH = 32
_MOST = {
    "dots along shapes; set them farther apart, or use fewer": MOST_DOTS,
    "patterns; use fewer": MOST_PATTERNS,
    "points; use fewer": MOST_POINTS,
}
_TOO_DEEP = f"nests more than {MOST_DEPTH} deep by what it uses; make it flatter"


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


class _Body(NamedTuple):
    """Pattern that a name stands for, without names, how deep it nests, and how much it is."""

    pattern: AnyPattern
    depth: int
    amounts: Counter[str]


class _Resolving:
    """A scene that is being resolved, and how much it has become so far."""

    def __init__(self, scene: Scene, folder: Path, locations: Locations) -> None:
        self._written, self._folder, self._locations = scene, folder, locations
        self._named: dict[str, tuple[Steps, AnyPattern]] = {}
        self._bodies: dict[str, _Body] = {}
        self._open: list[str] = []  # names whose uses are being replaced, outermost first
        self._amounts: Counter[str] = Counter()

    def scene(self) -> Scene:
        """Resolve the whole scene."""
        written = self._written
        elements = [(("elements", number), one) for number, one in enumerate(written.elements)]
        textures = [(("textures", name), one) for name, one in written.textures.items()]
        for steps, pattern in textures:
            self._name(steps, steps[1], pattern)
        for steps, pattern in (*textures, *elements):
            self._look_at(steps, pattern, 1)
        self._check_signals()
        for steps, _ in textures:  # also those that nothing uses are to be right
            self._body(steps[1], steps, 1)
        resolved = tuple(self._resolved(pattern, steps, 1) for steps, pattern in elements)
        return replace(written, textures={}, elements=resolved)

    def _look_at(self, steps: Steps, pattern: AnyPattern, depth: int) -> None:
        """Take in the names and the amount of a pattern as it is written, and its parts."""
        if depth > MOST_DEPTH:
            self._fail(steps, f"nests more than {MOST_DEPTH} deep; make it flatter")
        self._count(steps, _amounts(pattern))
        if pattern.id:
            self._name(steps, pattern.id, pattern)
        for more, name in signals_of(pattern):
            self._check_signal((*steps, *more), name)
        for more, part in placed_children(pattern):
            self._look_at((*steps, *more), part, depth + 1)

    def _check_signals(self) -> None:
        """Refuse signals that lead back to themselves or are not there, and too many of them."""
        signals = self._written.signals
        keys: dict[int, tuple[str, int]] = {}
        for number, (name, signal) in enumerate(signals.items()):
            steps = ("signals", name)
            if number == MOST_SIGNALS:
                self._fail(steps, f"is one signal more than the {MOST_SIGNALS} there can be")
            for one in made_of(signal):
                self._check_signal(steps, one)
            if isinstance(signal, Switch):
                levels = len(signal.levels)
                other, others = keys.setdefault(signal.key, (name, levels))
                if levels != others:
                    self._fail(
                        steps,
                        f"has {levels} levels, and {other}, of the same key {signal.key}, "
                        f"{others}; give both as many",
                    )
        try:
            ordered(signals)
        except ValueError as error:
            way = ", ".join(error.args)
            self._fail(("signals", error.args[0]), f"is made of itself: {way}; leave one out")

    def _check_signal(self, steps: Steps, name: str) -> None:
        signals = self._written.signals
        if name not in signals:
            self._fail(steps, f"is {name!r}, which is no signal here{nearest(name, signals)}")

    def _name(self, steps: Steps, name: str, pattern: AnyPattern) -> None:
        if name.startswith(STOCK):
            self._fail(steps, f"is called {name}; only the program's own names begin with {STOCK}")
        there, _ = self._named.setdefault(name, (steps, pattern))
        if there != steps:
            first = self._locations.place(there)
            self._fail(steps, f"is called {name}, as is {first}; give it another name")

    def _count(self, steps: Steps, amounts: Mapping[str, int]) -> None:
        """Refuse what no memory holds, before it is made."""
        self._amounts.update(amounts)
        for what, most in _MOST.items():
            if self._amounts[what] > most:
                self._fail(steps, f"makes it more than {most} {what}")

    def _resolved(self, pattern: AnyPattern, steps: Steps, depth: int) -> AnyPattern:
        if depth > MOST_DEPTH:
            self._fail(steps, _TOO_DEEP)
        if isinstance(pattern, Use):
            return self._used(pattern, steps, depth)
        if isinstance(pattern, ImageDots):
            from vbraille.scene.images import dots_of  # loads the reading of images

            try:
                return dots_of(pattern, self._folder)
            except InputError as error:
                self._fail(steps, f": {error}")
        return with_children(
            pattern, lambda more, part: self._resolved(part, (*steps, *more), depth + 1)
        )

    def _used(self, use: Use, steps: Steps, depth: int) -> AnyPattern:
        """Return what a use stands for, with its changes."""
        body = self._body(use.name, steps, depth)
        self._count(steps, body.amounts)
        try:
            pattern = moved(body.pattern, use.move_mm)
        except ValueError as error:
            self._fail(steps, f"cannot be moved so far: {error}")
        own = {key: getattr(use, key) for key in Pattern.__struct_fields__}
        for key in ("title", "description", "words", "sound"):
            own[key] = own[key] or getattr(pattern, key)
        called = {"id": use.id, "title": own["title"], "description": own["description"]}
        if replace(use, **called) == Use(name=use.name, move_mm=use.move_mm, **called):
            return replace(pattern, **called)
        inner = replace(pattern, id="", title="", description="")
        return Group(operation="maximum", parts=(inner,), **own)

    def _body(self, name: str, steps: Steps, depth: int) -> _Body:
        """Return what a name stands for, made once; it is to stand at a depth."""
        if name not in self._bodies:
            if name in self._open:
                way = ", ".join([*self._open[self._open.index(name) :], name])
                self._fail(steps, f"uses itself: {way}; leave one of these uses out")
            if len(self._open) >= MOST_DEPTH:
                self._fail(steps, f"uses uses more than {MOST_DEPTH} deep; make it flatter")
            there, written = self._of_name(name, steps)
            self._open.append(name)
            pattern = mapped(
                self._resolved(written, there, depth),
                lambda one: replace(one, id="") if one.id else one,  # each is of one thing
            )
            self._open.pop()
            amounts: Counter[str] = Counter()
            for one in each(pattern):
                amounts.update(_amounts(one))
            self._bodies[name] = _Body(pattern, _depth(pattern), amounts)
        body = self._bodies[name]
        if depth + body.depth > MOST_DEPTH + 1:
            self._fail(steps, _TOO_DEEP)
        return body

    def _of_name(self, name: str, steps: Steps) -> tuple[Steps, AnyPattern]:
        """Return the place of the pattern that has a name, and the pattern as it is written."""
        if name in self._named:
            return self._named[name]
        stock = {f"{STOCK}{one}": pattern for one, pattern in stock_textures().items()}
        if name not in stock:
            known = stock if name.startswith(STOCK) else [*self._named, *stock]
            self._fail(
                steps, f"name is {name!r}, which nothing here is called{nearest(name, known)}"
            )
        return steps, stock[name]

    def _fail(self, steps: Steps, problem: str) -> NoReturn:
        self._locations.fail(steps, problem)


def _amounts(pattern: AnyPattern) -> dict[str, int]:
    """Tell how much a pattern is without what stands in it, by the words of the limits."""
    return dict(zip(_MOST, (most_dots_of(pattern), 1, len(points_of(pattern))), strict=True))


def _depth(pattern: AnyPattern) -> int:
    return 1 + max(map(_depth, children(pattern)), default=0)
