"""Files of scenes: opened, whatever form they have."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

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

    from vbraille.scene.locations import FoundScene
    from vbraille.scene.traversal import Steps

    # Where an element and the parts of it are written, by the keys that lead to these from it.
    _Places = dict[Steps, tuple[ForeignFile | TomlFile, Steps]]
    _Element = tuple[AnyPattern, _Places]

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
        there = str(path)  # whose functions, unlike a path's, take no permission for no
        if os.path.exists(there) and not (os.path.isfile(there) or os.path.isdir(there)):  # noqa: PTH110, PTH112, PTH113
            raise InputError(f"{path} is no ordinary file; give one that is")
        kind = form_of(path)
        if kind == "toml":
            return self.text(read_text(path, "scene", MOST_BYTES), path, way, folder, language)
        found = read_foreign(path, kind, classes)
        self._warnings += [
            f"{path}{'' if one.startswith('line ') else ':'} {one}" for one in found.warnings
        ]
        own = {key: getattr(found.scene, key) for key in Scene.__struct_fields__}
        if own["language"] == _UNSAID_LANGUAGE:
            own["language"] = ""
        form = SceneFile(**own)
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
    """Elements that are put together otherwise than those around them, as one."""
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
