"""Scenes from files of any form, and as they are shown: without names, each use replaced."""

from __future__ import annotations

from collections import Counter
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn

from msgspec.structs import asdict, replace

from vbraille.errors import InputError
from vbraille.files import read_text
from vbraille.scene.geometry import most_dots_of
from vbraille.scene.locations import ForeignFile, Locations, OpenedScene
from vbraille.scene.patterns import AnyPattern, Group, ImageDots, Label, Operation, Pattern, Use
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.signals import MOST_SIGNALS, AnySignal, Switch, made_of, ordered
from vbraille.scene.stock import STOCK, stock_textures
from vbraille.scene.svg.looks import ClassLook
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
from vbraille.toml import Table, TomlFile
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from vbraille.scene.locations import FoundScene
    from vbraille.scene.traversal import Steps

    # Where an element and the parts of it are written, by the keys that lead to these from it.
    _Places = dict[Steps, tuple[ForeignFile | TomlFile, Steps]]
    _Element = tuple[AnyPattern, _Places]


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


# Scenes of 50,000 shapes or so; larger files would take longer to read than anybody waits.
MOST_BYTES = 8_000_000
MOST_FILES = 100
_UNSAID_LANGUAGE = "en"
_SUFFIXES = {".svg": "svg", ".svgz": "svg", ".gen": "gen", ".tx": "gen"}
_HEAD_BYTES = 4096
# Tables of tables, whose faults are said of each by itself.
_NAMED: dict[str, Any] = {"textures": AnyPattern, "signals": AnySignal, "classes": ClassLook}


class SceneFile(Table, frozen=True, kw_only=True):
    """A scene as its file has it: a tactile picture, or a bank of textures that others include.

    Parameters
    ----------
    canvas
        Surface that the picture stands on; only a file that others include can be without.
    title, description
        What it shows, in a word and in sentences.
    language
        Language of its titles and labels, or a table of liblouis; "en" if nothing is said.
    operation
        How its elements are put together: "overwrite", by which each hides what it stands on, as
        in drawings, or one of the others that a group has.
    include
        Names of other scenes' files, seen from this one. Their elements stand before its own, and
        their names can be used here.
    classes
        What shapes of included SVG drawings become, by the name of their class, by the label that
        Inkscape gives them, or by their id.
    signals
        Numbers from 0 to 1 by name, by which patterns answer to the hand, to keys and to time; at
        most 8, where one that is the speed of a motion counts twice.
    textures
        Patterns by name, which are shown where something uses them.
    elements
        The elements in order, the last on top.
    """

    canvas: Canvas | None = None
    title: str = ""
    description: str = ""
    language: str = ""
    operation: Operation = "overwrite"
    include: tuple[str, ...] = ()
    classes: dict[str, ClassLook] = {}  # noqa: RUF012 - msgspec copies an empty default
    signals: dict[str, AnySignal] = {}  # noqa: RUF012 - msgspec copies an empty default
    textures: dict[str, AnyPattern] = {}  # noqa: RUF012 - msgspec copies an empty default
    elements: tuple[AnyPattern, ...] = ()


def open_scene(path: str | Path) -> OpenedScene:
    """Open a scene: a scene file in TOML, a drawing in SVG, or a file of OpenLatero's.

    Parameters
    ----------
    path
        Path of the file. Its suffix says what it is, or else its beginning.

    Raises
    ------
    InputError
        If it or a file that it includes cannot be read or is not right, a name is given twice, or
        files include each other; one sentence says where.
    """
    path, reading = Path(path), _Reading()
    return reading.opened(path, *reading.file(path, (path,), Path(), "", {}))


def open_text(text: str, name: str) -> OpenedScene:
    """Open the text of a scene file in TOML; files that it names are seen from its name's folder.

    Raises
    ------
    InputError
        If it is not right; one sentence says where.
    """
    path, reading = Path(name), _Reading()
    return reading.opened(path, *reading.text(text, path, (path,), Path(), ""))


class _Reading:
    """A scene's file and those that it includes, each read once."""

    def __init__(self) -> None:
        self._named: dict[str, dict[str, Any]] = {"textures": {}, "signals": {}}
        self._locations = Locations()
        self._warnings: list[str] = []
        self._read: set[Path] = set()

    def opened(self, path: Path, form: SceneFile, elements: Sequence[_Element]) -> OpenedScene:
        """Put together the scene that was read."""
        if form.canvas is None:
            raise InputError(
                f"{path} has no canvas; write [canvas] with width_mm and height_mm, "
                "or include it in a scene that has one"
            )
        for number, (_, places) in enumerate(elements):
            for steps, place in places.items():
                self._locations["elements", number, *steps] = place
        own: dict[str, Any] = {key: getattr(form, key) for key in Scene.__struct_fields__}
        own |= self._named
        own["language"] = form.language or _UNSAID_LANGUAGE
        own["elements"] = tuple(pattern for pattern, _ in elements)
        scene = Scene(**own)
        resolved = resolve(scene, path.parent, self._locations)
        warnings = tuple(self._warnings)
        return OpenedScene(path, path.parent, scene, resolved, self._locations, warnings)

    def file(
        self,
        path: Path,
        way: tuple[Path, ...],
        folder: Path,
        language: str,
        classes: Mapping[str, ClassLook],
    ) -> tuple[SceneFile, list[_Element]]:
        """Read a file, and the elements of it and of what it includes.

        Parameters
        ----------
        path
            The file.
        way
            The files of which each includes the next, from the first to this one.
        folder
            Folder of the file, seen from that of the first.
        language
            Language of its labels; empty for that of the scene.
        classes
            Looks of classes, if it is a drawing, by the file that includes it.
        """
        kind = form_of(path)
        if kind == "toml":
            return self.text(read_text(path, "scene", MOST_BYTES), path, way, folder, language)
        found = read_foreign(path, kind, classes)
        self._warnings += [
            f"{path}{'' if one.startswith('line ') else ':'} {one}" for one in found.warnings
        ]
        form = SceneFile(**asdict(found.scene))
        if form.language == _UNSAID_LANGUAGE:
            form = replace(form, language="")
        source = ForeignFile(str(path), found.lines)
        return form, self._own(source, form, way, folder, form.language or language)

    def text(
        self, text: str, path: Path, way: tuple[Path, ...], folder: Path, language: str
    ) -> tuple[SceneFile, list[_Element]]:
        """Read the text of a scene file in TOML, and what it includes; see `file`."""
        if text.count("kind") > MOST_PATTERNS:  # each has one
            raise InputError(f"{path} has more than {MOST_PATTERNS} patterns; use fewer")
        file = TomlFile(text, str(path))
        for key, kind in _NAMED.items():
            for name in file.names(key):
                file.read(kind, under=(key, name))
        form = file.read(SceneFile)
        if way[1:]:
            language = form.language or language
        elements: list[_Element] = []
        for number, name in enumerate(form.include):
            inner = path.parent / name
            real = self._checked(file, number, name, inner, way)
            if real in self._read:  # by another file that includes it
                continue
            self._read.add(real)
            there = folder / Path(name).parent
            included, found = self.file(inner, (*way, real), there, language, form.classes)
            if found and included.operation != form.operation:
                found = [_grouped(included.operation, found)]
            elements += found
        return form, elements + self._own(file, form, way, folder, language)

    def _checked(
        self, file: TomlFile, number: int, name: str, path: Path, way: tuple[Path, ...]
    ) -> Path:
        """Path of an included file without links, if it can be included."""
        try:
            real, there = path.resolve(), path.is_file()
        except (OSError, ValueError, RuntimeError):
            real, there = path, False
        problem = ""
        if "://" in name or not name.strip():
            problem = f"is {name!r}; give the name of a file, since nothing is fetched"
        elif not there:
            problem = f"is {name!r}, which is no file; check the name"
        elif real in (one.resolve() for one in way):
            problem = f"is {name!r}, which includes this file itself; leave it out"
        elif real not in self._read and len(self._read) + 1 >= MOST_FILES:
            problem = f"is one file more than the {MOST_FILES} that a scene can include"
        if problem:
            file.fail(("include", number), problem)
        return real

    def _own(
        self,
        file: ForeignFile | TomlFile,
        form: SceneFile,
        way: tuple[Path, ...],
        folder: Path,
        language: str,
    ) -> list[_Element]:
        """Take in the textures and signals of a file, and find its elements."""

        def seen(one: AnyPattern) -> AnyPattern:
            if isinstance(one, Label) and not one.table:
                one = replace(one, table=language)
            return with_files(one, lambda name: str(folder / name))

        textures, elements = form.textures, list(form.elements)
        if way[1:]:
            textures = {name: mapped(one, seen) for name, one in textures.items()}
            elements = [mapped(one, seen) for one in elements]
        for kind, named in (("textures", textures), ("signals", form.signals)):
            for name, one in named.items():
                steps = (kind, name)
                first = self._locations.place(steps)
                is_known = steps in self._locations
                self._locations[steps] = file, steps
                if is_known:
                    problem = f"is called {name}, as is {first}; give it another name"
                    self._locations.fail(steps, problem)
                self._named[kind][name] = one
        return [(one, {(): (file, ("elements", number))}) for number, one in enumerate(elements)]


def _grouped(operation: Operation, elements: Sequence[_Element]) -> _Element:
    """Group of elements with an operation of their own."""
    places: _Places = {(): elements[0][1][()]}
    for number, (_, inner) in enumerate(elements):
        places |= {("parts", number, *steps): place for steps, place in inner.items()}
    parts = tuple(pattern for pattern, _ in elements)
    return Group(operation=operation, parts=parts), places


def form_of(path: Path) -> str:
    """Form of a scene's file by its suffix, or else by its beginning: "toml", "svg" or "gen"."""
    form = _SUFFIXES.get(path.suffix.lower())
    if form is not None:
        return form
    head = b""
    with suppress(OSError, ValueError):
        if path.is_file():  # or else the reader of TOML says what is wrong
            with path.open("rb") as file:
                head = file.read(_HEAD_BYTES)
    if not head.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"<"):
        return "toml"
    return "svg" if b"<svg" in head or b":svg" in head else "gen"


def read_foreign(
    path: Path,
    form: str,
    classes: Mapping[str, ClassLook] | None = None,
    *,
    as_shown: bool = False,
) -> FoundScene:
    """Read a file of another format, by its form; its reader's library is loaded then."""
    if form == "svg":
        from vbraille.scene.svg.drawing import read_svg

        return read_svg(path, classes)
    from vbraille.scene.openlatero import read_gen

    return read_gen(path, as_shown=as_shown)


def with_files(pattern: AnyPattern, name_of: Callable[[str], str]) -> AnyPattern:
    """Pattern whose image and sound have the names that a function gives them."""
    names = {key: getattr(pattern, key, "") for key in ("file", "sound")}
    changes = {key: name_of(name) for key, name in names.items() if name}
    return replace(pattern, **changes) if changes else pattern
