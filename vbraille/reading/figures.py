"""The tactile pictures of a book, read when a line comes that stands for one."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

from vbraille.errors import InputError
from vbraille.translate import MarkKind

if TYPE_CHECKING:
    from vbraille.layout import Line
    from vbraille.pictures.loading import LoadedScene
    from vbraille.translate import Source

_REMEMBERED = 4


class BookFigures:
    """The tactile pictures of a book: files beside it, or in its container. Nothing is fetched.

    Parameters
    ----------
    source
        The book.
    folder
        Folder that it stands in; None for a book whose figures are in its container.
    style
        How the braille of labels is shown.
    """

    def __init__(self, source: Source, folder: Path | None, style: Any) -> None:
        self._source, self._folder, self._style = source, folder, style
        self._load = lru_cache(_REMEMBERED)(self._read)

    def of(self, line: Line) -> LoadedScene | None:
        """Figure that ends on a line; None if none does.

        Raises
        ------
        InputError
            If it cannot be read.
        """
        for mark in line.block.marks:
            ends_here = line.place < line.block.start + mark.end <= line.end
            if mark.kind is MarkKind.IMAGE and mark.target and ends_here:
                return self._load(mark.target)
        return None

    def said(self, line: Line) -> str:
        """Sentence on the figure of a line; empty if it has none."""
        try:
            figure = self.of(line)
        except InputError as error:
            return f"figure not felt: {error}"
        if figure is None:
            return ""
        canvas = figure.scene.canvas
        size = f"{canvas.width_mm:g} mm × {canvas.height_mm:g} mm"
        return f"figure: {figure.title}, {size}; shift-g feels it"

    def _read(self, address: str) -> LoadedScene:
        from vbraille.pictures.loading import load_scene  # most books have no figures

        with TemporaryDirectory(prefix="vbraille-") as temporary:
            # What a figure of a container includes is looked for beside it, which is nowhere.
            folder, name = self._folder, unquote(address).lstrip("/")
            try:
                if folder is None:
                    folder, name = Path(temporary), Path(address).name[-60:]
                    (folder / name).write_bytes(self._source.file(address))
                loaded = load_scene(folder / name, self._style)
            except (InputError, ValueError) as error:  # as of a name that no file can have
                raise InputError(str(error).replace(f"{temporary}/", "")) from None
        notes = tuple(note.replace(f"{temporary}/", "") for note in loaded.notes)
        return replace(loaded, notes=notes)
