"""Files of scenes: opened, whatever form they have."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.files import read_text
from vbraille.scene.locations import LocatedFile, Locations, OpenedScene
from vbraille.scene.patterns import AnyPattern, Group, Image, ImageDots, Label, Operation
from vbraille.scene.resolving import MOST_PATTERNS, resolve
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.signals import AnySignal
from vbraille.scene.svg.looks import ClassLook
from vbraille.scene.traversal import with_children
from vbraille.toml import Table, TomlFile

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vbraille.scene.locations import FoundScene
    from vbraille.scene.traversal import Steps


# Scenes of 50,000 shapes or so; larger files would take longer to read than anybody waits.
MOST_BYTES = 8_000_000
MOST_FILES = 100
UNSAID_LANGUAGE = "en"
_SUFFIXES = {".svg": "svg", ".svgz": "svg", ".gen": "gen", ".tx": "gen"}
_HEAD_BYTES = 4096


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


@dataclass(frozen=True, slots=True)
class Gathered:
    """Content of a file together with what it includes.

    Parameters
    ----------
    form
        What the file itself says.
    elements, textures, signals
        Elements, named textures and signals of the file and of those that it includes.
    locations
        Where each of them is written.
    warnings
        What was ignored, or means something else here.
    """

    form: SceneFile
    elements: list[AnyPattern] = field(default_factory=list)
    textures: dict[str, AnyPattern] = field(default_factory=dict)
    signals: dict[str, AnySignal] = field(default_factory=dict)
    locations: Locations = field(default_factory=Locations)
    warnings: list[str] = field(default_factory=list)

    def scene(self, path: Path) -> Scene:
        """Scene of the file and what it includes.

        Raises
        ------
        InputError
            If the file has no canvas.
        """
        form = self.form
        if form.canvas is None:
            raise InputError(
                f"{path} has no canvas; write [canvas] with width_mm and height_mm, "
                "or include it in a scene that has one"
            )
        return Scene(
            canvas=form.canvas,
            title=form.title,
            description=form.description,
            language=form.language or UNSAID_LANGUAGE,
            operation=form.operation,
            elements=tuple(self.elements),
            textures=self.textures,
            signals=self.signals,
        )

    def add(
        self,
        elements: tuple[AnyPattern, ...] | list[AnyPattern],
        textures: dict[str, AnyPattern],
        signals: dict[str, AnySignal],
        locations: Locations,
        operation: Operation,
    ) -> None:
        """Add elements, textures and signals after those that are there.

        Elements that are put together in another way than this file's become one group.
        """
        for kind, own, given in (
            ("textures", self.textures, textures),
            ("signals", self.signals, signals),
        ):
            for name, one in given.items():
                origin, there = locations.places[kind, name]
                if name in own:
                    first = self.locations.place((kind, name))
                    origin.fail(there, f"is called {name}, as is {first}; give it another name")
                own[name] = one  # pyright: ignore[reportArgumentType]
                self.locations.places[kind, name] = (origin, there)
        start = len(self.elements)
        apart = bool(elements) and operation != self.form.operation
        for steps, origin in locations.places.items():
            if steps[0] == "elements":
                number = int(steps[1])
                above = (start, "parts", number) if apart else (start + number,)
                self.locations.places["elements", *above, *steps[2:]] = origin
        if apart:
            self.elements.append(Group(operation=operation, parts=tuple(elements)))
        else:
            self.elements.extend(elements)


def gather(path: Path) -> Gathered:
    """Read a scene's file and all that it includes.

    Raises
    ------
    InputError
        If a file cannot be read or is not right, a name is given twice, or files include each
        other.
    """
    return _Gathering().gather(path, path, ())


class _Gathering:
    """Files that are being read, each once."""

    def __init__(self) -> None:
        self._read: set[Path] = set()

    def gather(
        self,
        name: Path,
        real: Path,
        way: tuple[Path, ...],
        classes: Mapping[str, ClassLook] | None = None,
    ) -> Gathered:
        """Read a file, at the end of a way of files of which each includes the next.

        If it is a drawing, ``classes`` are those of the file that includes it.
        """
        self._read.add(real)
        if _may_wait(name):
            raise InputError(f"{name} is no ordinary file; give one that is")
        form = form_of(name)
        if form != "toml":
            return _foreign(name, form, classes or {})
        return self.of_text(read_text(name, "scene", MOST_BYTES), name, (*way, real))

    def of_text(self, text: str, name: Path, way: tuple[Path, ...]) -> Gathered:
        """Read the text of a scene file in TOML, at the end of a way of files that ends with it."""
        if text.count("kind") > MOST_PATTERNS:  # each has one
            raise InputError(f"{name} has more than {MOST_PATTERNS} patterns; use fewer")
        file = TomlFile(text, str(name))
        textures = {
            key: file.read(AnyPattern, under=("textures", key))  # pyright: ignore[reportArgumentType]
            for key in file.names("textures")
        }
        for key in file.names("signals"):
            file.read(AnySignal, under=("signals", key))  # pyright: ignore[reportArgumentType]
        for key in file.names("classes"):  # whose faults are then said as those of a table
            file.read(ClassLook, under=("classes", key))
        gathered = Gathered(file.read(SceneFile))
        for number, included in enumerate(gathered.form.include):
            self._include(gathered, file, number, included, name, way)
        elements = gathered.form.elements
        form = gathered.form
        located = LocatedFile(file.where, file.lines, file.fail)
        locations = _all_from(located, elements, textures, form.signals)
        gathered.add(elements, textures, form.signals, locations, form.operation)
        return gathered

    def _include(
        self,
        into: Gathered,
        file: TomlFile,
        number: int,
        included: str,
        name: Path,
        way: tuple[Path, ...],
    ) -> None:
        """Add what an included file holds."""
        steps = ("include", number)
        if "://" in included or not included.strip():
            file.fail(steps, f"is {included!r}; give the name of a file, since nothing is fetched")
        path = name.parent / included
        try:
            real = path.resolve()
            there = path.is_file()
        except (OSError, ValueError, RuntimeError):
            there, real = False, path
        if not there:
            file.fail(steps, f"is {included!r}, which is no file; check the name")
        if real in way:
            file.fail(steps, f"is {included!r}, which includes this file itself; leave it out")
        if real in self._read:  # two scenes may include a third
            return
        if len(self._read) >= MOST_FILES:
            file.fail(steps, f"is one file more than the {MOST_FILES} that a scene can include")
        found = self.gather(path, real, way, into.form.classes)
        folder, language = Path(included).parent, found.form.language
        into.add(
            [_seen_from(element, folder, language) for element in found.elements],
            {key: _seen_from(one, folder, language) for key, one in found.textures.items()},
            found.signals,
            found.locations,
            found.form.operation,
        )
        into.warnings.extend(found.warnings)


def _may_wait(path: Path) -> bool:
    """Tell whether reading might wait forever: a pipe or a device is there."""
    there = str(path)  # whose functions, unlike a path's, take no permission for no
    return os.path.exists(there) and not (os.path.isfile(there) or os.path.isdir(there))  # noqa: PTH110, PTH112, PTH113


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


def _foreign(path: Path, form: str, classes: Mapping[str, ClassLook]) -> Gathered:
    """Read a file of another format."""
    found = _read_foreign(path, form, classes)
    scene = found.scene
    gathered = Gathered(
        SceneFile(
            canvas=scene.canvas,
            title=scene.title,
            description=scene.description,
            language="" if scene.language == UNSAID_LANGUAGE else scene.language,
            operation=scene.operation,
        ),
        warnings=[
            f"{path}{'' if one.startswith('line ') else ':'} {one}" for one in found.warnings
        ],
    )
    locations = _all_from(
        LocatedFile(str(path), lambda: found.lines), scene.elements, scene.textures, scene.signals
    )
    gathered.add(scene.elements, scene.textures, scene.signals, locations, scene.operation)
    return gathered


def _about(path: Path, warning: str) -> str:
    """Warning with the file that it is about; some begin with a line."""
    return f"{path} {warning}" if warning.startswith("line ") else f"{path}: {warning}"


def _read_foreign(path: Path, form: str, classes: Mapping[str, ClassLook]) -> FoundScene:
    if form == "svg":
        from vbraille.scene.svg.drawing import read_svg  # loads the library for SVG

        return read_svg(path, classes)
    from vbraille.scene.openlatero import read_gen  # loads the library for XML

    return read_gen(path)


def _all_from(
    file: LocatedFile,
    elements: tuple[AnyPattern, ...],
    textures: dict[str, AnyPattern],
    signals: dict[str, AnySignal],
) -> Locations:
    """Places of elements, textures and signals of a file, which are all its own."""
    steps: list[Steps] = [("textures", name) for name in textures]
    steps += [("signals", name) for name in signals]
    steps += [("elements", number) for number in range(len(elements))]
    return Locations({one: (file, one) for one in steps})


def _seen_from(pattern: AnyPattern, folder: Path, language: str) -> AnyPattern:
    """Pattern of an included file as one of the including file, in another folder and language."""
    if pattern.sound:
        pattern = replace(pattern, sound=str(folder / pattern.sound))
    if isinstance(pattern, Image | ImageDots):
        pattern = replace(pattern, file=str(folder / pattern.file))
    elif isinstance(pattern, Label) and language and not pattern.table:
        pattern = replace(pattern, table=language)
    return with_children(pattern, lambda _, part: _seen_from(part, folder, language))


def open_scene(path: str | Path) -> OpenedScene:
    """Open a scene: a scene file in TOML, a drawing in SVG, or a file of OpenLatero's.

    Parameters
    ----------
    path
        Path of the file. Its suffix says what it is, or else its beginning.

    Raises
    ------
    InputError
        If it cannot be read, or is not right; one sentence says where.
    """
    path = Path(path)
    return _opened(gather(path), path)


def open_text(text: str, name: str) -> OpenedScene:
    """Open the text of a scene file in TOML; files that it names are seen from its name's folder.

    Raises
    ------
    InputError
        If it is not right; one sentence says where.
    """
    path = Path(name)
    return _opened(_Gathering().of_text(text, path, (path,)), path)


def _opened(gathered: Gathered, path: Path) -> OpenedScene:
    scene = gathered.scene(path)
    return OpenedScene(
        path=path,
        folder=path.parent,
        written=scene,
        resolved=resolve(scene, path.parent, gathered.locations),
        locations=gathered.locations,
        warnings=tuple(gathered.warnings),
    )
