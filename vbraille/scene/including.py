"""Scene files in TOML, together with those that they include."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.scene.patterns import AnyPattern, Group, Image, ImageDots, Label
from vbraille.scene.resolving import said
from vbraille.scene.scene import Scene
from vbraille.scene.scenefile import SceneFile
from vbraille.scene.walking import with_children
from vbraille.toml.textfile import read_text
from vbraille.toml.tomlfile import TomlFile

if TYPE_CHECKING:
    from vbraille.scene.walking import Steps

# A scene of 100,000 shapes; larger ones would take longer to read than anybody waits.
MOST_BYTES = 8_000_000
MOST_FILES = 100


@dataclass(slots=True)
class Gathered:
    """Elements and textures of a file and of those that it includes, and where each is written.

    Parameters
    ----------
    form
        What the file itself says.
    elements, textures
        What it holds together with what it includes.
    origins
        Files, and places in them, of elements and textures by their places in the scene.
    """

    form: SceneFile
    elements: list[AnyPattern] = field(default_factory=list)
    textures: dict[str, AnyPattern] = field(default_factory=dict)
    origins: dict[Steps, tuple[TomlFile, Steps]] = field(default_factory=dict)

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
            language=form.language or "en",
            operation=form.operation,
            elements=tuple(self.elements),
            textures=self.textures,
        )

    def fail(self, steps: Steps, problem: str) -> NoReturn:
        """Refuse the scene for a problem at a place in it, with the file and the line.

        Raises
        ------
        InputError
            In any case.
        """
        for depth in range(len(steps), 0, -1):
            if steps[:depth] in self.origins:
                file, there = self.origins[steps[:depth]]
                file.fail((*there, *steps[depth:]), problem)
        raise InputError(f"{said(steps)} {problem}")

    def places(self) -> tuple[str, ...]:
        """Files and lines of the elements."""
        return tuple(self._place(("elements", number)) for number in range(len(self.elements)))

    def _place(self, steps: Steps) -> str:
        file, there = self.origins.get(steps) or self.origins[(*steps, "parts", 0)]
        return f"{file.where} line {file.lines()[there]}"


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

    def gather(self, path: Path, name: Path, way: tuple[Path, ...]) -> Gathered:
        """Read a file, which others call ``name``, on a way of files that include each other."""
        file = TomlFile(read_text(name, "scene", MOST_BYTES), str(name))
        textures = {
            key: file.read(AnyPattern, under=("textures", key))  # pyright: ignore[reportArgumentType]
            for key in file.names("textures")
        }
        form = file.read(SceneFile)
        gathered = Gathered(form)
        self._read.add(path.resolve())
        for number, included in enumerate(form.include):
            self._include(gathered, file, number, included, name, (*way, path.resolve()))
        for key, texture in textures.items():
            if key in gathered.textures:
                there = gathered.origins["textures", key][0]
                file.fail(("textures", key), f"is in {there.where} too; give it another name")
            gathered.origins["textures", key] = (file, ("textures", key))
            gathered.textures[key] = texture
        for number, element in enumerate(form.elements):
            gathered.origins["elements", len(gathered.elements)] = (file, ("elements", number))
            gathered.elements.append(element)
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
            file.fail(steps, f"is {included!r}; give the name of a file, nothing is fetched")
        path = name.parent / included
        try:
            real = path.resolve()
        except (OSError, ValueError, RuntimeError):
            file.fail(steps, f"is {included!r}, which is no name of a file; mend it")
        if real in way:
            file.fail(steps, f"is {included}, which includes this file itself; leave it out")
        if real in self._read:  # two banks may include a third
            return
        if len(self._read) >= MOST_FILES:
            file.fail(steps, f"is one file more than the {MOST_FILES} that a scene may include")
        try:
            found = self.gather(real, path, way)
        except InputError as error:
            if f"{path}" in str(error) and not str(error).startswith("there is"):
                raise
            file.fail(steps, f"is {included}, and {error}")
        _add(into, found, Path(included).parent)


def _add(into: Gathered, found: Gathered, folder: Path) -> None:
    """Add elements and textures of an included file to those of the one that includes it."""
    for key, texture in found.textures.items():
        file, there = found.origins["textures", key]
        if key in into.textures:
            first = into.origins["textures", key][0]
            file.fail(there, f"is in {first.where} too; give it another name")
        into.textures[key] = _seen_from(texture, folder, found.form.language)
        into.origins["textures", key] = (file, there)
    elements = [_seen_from(element, folder, found.form.language) for element in found.elements]
    start = len(into.elements)
    apart = bool(elements) and found.form.operation != into.form.operation
    for number in range(len(elements)):
        origin = found.origins.get(("elements", number))
        at = ("elements", start, "parts", number) if apart else ("elements", start + number)
        if origin is not None:
            into.origins[at] = origin
    for steps, origin in found.origins.items():
        if steps[0] == "elements" and len(steps) > 2:  # within a group that was made here
            number = int(steps[1])
            at = ("elements", start, "parts", number) if apart else ("elements", start + number)
            into.origins[(*at, *steps[2:])] = origin
    if apart:
        operation = found.form.operation
        into.elements.append(Group(operation=operation, parts=tuple(elements)))
    else:
        into.elements += elements


def _seen_from(pattern: AnyPattern, folder: Path, language: str) -> AnyPattern:
    """Pattern of an included file as one of the including file, in another folder and language."""
    if isinstance(pattern, Image | ImageDots):
        pattern = replace(pattern, file=str(folder / pattern.file))
    elif isinstance(pattern, Label) and language and not pattern.table:
        pattern = replace(pattern, table=language)
    return with_children(pattern, lambda _, part: _seen_from(part, folder, language))
