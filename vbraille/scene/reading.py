"""Files of scenes: opened, whatever form they have."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.files import read_text
from vbraille.scene.locations import ForeignFile, Locations, OpenedScene
from vbraille.scene.patterns import AnyPattern, Group, Label, Operation
from vbraille.scene.resolving import MOST_PATTERNS, resolve
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.signals import AnySignal
from vbraille.scene.svg.looks import ClassLook
from vbraille.scene.traversal import mapped
from vbraille.toml import Table, TomlFile

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from vbraille.scene.locations import FoundScene, SceneSource
    from vbraille.scene.traversal import Steps


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
    return reading.opened(path, *reading.file(path, _Within((path,)), {}))


def open_text(text: str, name: str) -> OpenedScene:
    """Open the text of a scene file in TOML; files that it names are seen from its name's folder.

    Raises
    ------
    InputError
        If it is not right; one sentence says where.
    """
    path, reading = Path(name), _Reading()
    return reading.opened(path, *reading.text(text, path, _Within((path,))))


class _Located(NamedTuple):
    """An element, and where it and the parts of it are written, by the keys that lead to these."""

    pattern: AnyPattern
    places: dict[Steps, tuple[SceneSource, Steps]]


class _Within(NamedTuple):
    """Files of which each includes the next, and what the last is seen from the first.

    Parameters
    ----------
    way
        The files.
    folder
        Folder of the last, seen from that of the first.
    language
        Language of its labels; empty for that of the scene.
    """

    way: tuple[Path, ...]
    folder: Path = Path()
    language: str = ""

    def speaking(self, form: SceneFile) -> _Within:
        """The same with the language that an included file says."""
        return self._replace(language=form.language or self.language) if self.way[1:] else self

    def seen(self, pattern: AnyPattern) -> AnyPattern:
        """Pattern of the last file as one of the first."""

        def change(one: AnyPattern) -> AnyPattern:
            if isinstance(one, Label) and not one.table:
                one = replace(one, table=self.language)
            return with_files(one, lambda name: str(self.folder / name))

        return mapped(pattern, change) if self.way[1:] else pattern


class _Reading:
    """A scene's file and those that it includes, each read once."""

    def __init__(self) -> None:
        self._named: dict[str, dict[str, Any]] = {"textures": {}, "signals": {}}
        self._locations = Locations()
        self._warnings: list[str] = []
        self._read: set[Path] = set()

    def opened(self, path: Path, form: SceneFile, elements: Sequence[_Located]) -> OpenedScene:
        """Put together the scene that was read."""
        if form.canvas is None:
            raise InputError(
                f"{path} has no canvas; write [canvas] with width_mm and height_mm, "
                "or include it in a scene that has one"
            )
        for number, element in enumerate(elements):
            for steps, place in element.places.items():
                self._locations.places["elements", number, *steps] = place
        own: dict[str, Any] = {key: getattr(form, key) for key in Scene.__struct_fields__}
        own |= self._named
        own["language"] = form.language or _UNSAID_LANGUAGE
        own["elements"] = tuple(element.pattern for element in elements)
        scene = Scene(**own)
        resolved = resolve(scene, path.parent, self._locations)
        warnings = tuple(self._warnings)
        return OpenedScene(path, path.parent, scene, resolved, self._locations, warnings)

    def file(
        self, path: Path, within: _Within, classes: Mapping[str, ClassLook]
    ) -> tuple[SceneFile, list[_Located]]:
        """Read a file, and the elements of it and of what it includes.

        If it is a drawing, ``classes`` are those of the file that includes it.
        """
        there = str(path)  # whose functions, unlike a path's, take no permission for no
        if os.path.exists(there) and not (os.path.isfile(there) or os.path.isdir(there)):  # noqa: PTH110, PTH112, PTH113
            raise InputError(f"{path} is no ordinary file; give one that is")
        kind = form_of(path)
        if kind == "toml":
            return self.text(read_text(path, "scene", MOST_BYTES), path, within)
        found = read_foreign(path, kind, classes)
        self._warnings += [
            f"{path}{'' if one.startswith('line ') else ':'} {one}" for one in found.warnings
        ]
        own = {key: getattr(found.scene, key) for key in Scene.__struct_fields__}
        if own["language"] == _UNSAID_LANGUAGE:
            own["language"] = ""
        form = SceneFile(**own)
        return form, self._own(ForeignFile(str(path), found.lines), form, within.speaking(form))

    def text(self, text: str, path: Path, within: _Within) -> tuple[SceneFile, list[_Located]]:
        """Read the text of a scene file in TOML, and what it includes."""
        if text.count("kind") > MOST_PATTERNS:  # each has one
            raise InputError(f"{path} has more than {MOST_PATTERNS} patterns; use fewer")
        file = TomlFile(text, str(path))
        for key, kind in _NAMED.items():
            for name in file.names(key):
                file.read(kind, under=(key, name))
        form = file.read(SceneFile)
        within = within.speaking(form)
        elements: list[_Located] = []
        for number in range(len(form.include)):
            elements += self._included(file, ("include", number), form, path.parent, within)
        return form, elements + self._own(file, form, within)

    def _included(
        self, file: TomlFile, steps: Steps, form: SceneFile, folder: Path, within: _Within
    ) -> list[_Located]:
        """Read an included file; two may include a third, which is there once."""
        name: str = file.at(steps)
        if "://" in name or not name.strip():
            file.fail(steps, f"is {name!r}; give the name of a file, since nothing is fetched")
        path = folder / name
        try:
            real = path.resolve()
            there = path.is_file()
        except (OSError, ValueError, RuntimeError):
            there, real = False, path
        if not there:
            file.fail(steps, f"is {name!r}, which is no file; check the name")
        if real in (one.resolve() for one in within.way):
            file.fail(steps, f"is {name!r}, which includes this file itself; leave it out")
        if real in self._read:
            return []
        if len(self._read) + 1 >= MOST_FILES:
            file.fail(steps, f"is one file more than the {MOST_FILES} that a scene can include")
        self._read.add(real)
        inside = within._replace(way=(*within.way, real), folder=within.folder / Path(name).parent)
        inner, elements = self.file(path, inside, form.classes)
        if not elements or inner.operation == form.operation:
            return elements
        places: dict[Steps, tuple[SceneSource, Steps]] = {
            ("parts", number, *steps): place
            for number, element in enumerate(elements)
            for steps, place in element.places.items()
        }
        places[()] = elements[0].places[()]
        parts = tuple(element.pattern for element in elements)
        return [_Located(Group(operation=inner.operation, parts=parts), places)]

    def _own(self, file: SceneSource, form: SceneFile, within: _Within) -> list[_Located]:
        """Take in the textures and signals of a file, and find its elements."""
        textures = {name: within.seen(one) for name, one in form.textures.items()}
        for kind, named in (("textures", textures), ("signals", form.signals)):
            for name, one in named.items():
                if name in self._named[kind]:
                    first = self._locations.place((kind, name))
                    problem = f"is called {name}, as is {first}; give it another name"
                    file.fail((kind, name), problem)
                self._named[kind][name] = one
                self._locations.places[kind, name] = file, (kind, name)
        return [
            _Located(within.seen(element), {(): (file, ("elements", number))})
            for number, element in enumerate(form.elements)
        ]


def form_of(path: Path) -> str:
    """Form of a scene's file by its suffix, or else by its beginning: "toml", "svg" or "gen"."""
    form = _SUFFIXES.get(path.suffix.lower())
    if form is not None:
        return form
    try:
        with path.open("rb") as file:
            head = file.read(_HEAD_BYTES)
    except (OSError, ValueError):
        return "toml"  # whose reader says what is wrong
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
