"""The tactile pictures of a book, read when a line comes that stands for one."""

from __future__ import annotations

import math
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

from vbraille.errors import InputError
from vbraille.reading.commands import Where
from vbraille.translate import MarkKind

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.display import Pose
    from vbraille.layout import Line
    from vbraille.pictures.index import SceneIndex
    from vbraille.pictures.loading import LoadedScene
    from vbraille.reading.picture import Picture
    from vbraille.render.program import Program
    from vbraille.translate import Source

_ROUNDING = 1e-9  # of a line pitch


class BookFigures:
    """The tactile pictures of a book: files beside it, or in its container. Nothing is fetched.

    Parameters
    ----------
    source
        The book.
    folder
        Folder that it stands in; None for a book whose figures are in its container.
    style
        Function that gives how the braille of labels is shown.
    note
        Function that is called with a sentence on each figure that cannot be felt, once.
    """

    def __init__(
        self,
        source: Source,
        folder: Path | None,
        style: Callable[[], Any],
        note: Callable[[str], None],
    ) -> None:
        self._source, self._folder, self._style, self._note = source, folder, style, note
        self._found: dict[str, LoadedScene | InputError] = {}
        self._indices: dict[str, SceneIndex] = {}
        self._maker = ThreadPoolExecutor(1)  # what compiles takes a second to load
        self._making: tuple[int, Future[Program]] | None = None

    def _look(self, line: Line) -> LoadedScene | InputError | None:
        """Figure that ends on a line, or what is wrong with it; None if none does."""
        address = ""
        for mark in line.block.marks:
            ends_here = line.place < line.block.start + mark.end <= line.end
            if mark.kind is MarkKind.IMAGE and ends_here:
                address = address or mark.target
        if address and address not in self._found:
            try:
                self._found[address] = found = self._load(address)
                for note in found.notes[:1]:
                    self._note(f"figure: {note}")
            except (InputError, ValueError) as error:  # as of a name that no file can have
                self._found[address] = InputError(str(error))
                self._note(f"figure not felt: {error}")
        return self._found.get(address)

    def of(self, line: Line) -> LoadedScene | None:
        """Figure that a line stands for; None if it stands for none that can be felt."""
        found = self._look(line)
        return None if isinstance(found, InputError) else found

    def rows_below(self, line: Line, pitch_mm: float, rows: int, travel_mm: float) -> int:
        """Number of rows to keep free below a line for its figure; 0 if it has none there."""
        figure = self.of(line)
        if figure is None or figure.scene.canvas.width_mm > travel_mm:
            return 0
        needed = math.ceil(figure.scene.canvas.height_mm / pitch_mm - _ROUNDING)
        return needed if needed < rows else 0

    def tell(self, line: Line, say: Callable[[str], None], *, below: bool) -> None:
        """Say which figure a line stands for, if it stands for one."""
        figure = self.of(line)
        if figure is not None:
            canvas = figure.scene.canvas
            size = f"{canvas.width_mm:g} mm × {canvas.height_mm:g} mm"
            where = "below this line" if below else "shift-g feels it"
            say(f"figure: {figure.title}, {size}; {where}")

    def on(self, surface: Any) -> Iterator[tuple[LoadedScene, float]]:
        """Figures of a page, each with the place in mm at which it begins."""
        for row, part in enumerate(surface.parts):
            figure = self.of(part.line) if surface.has_free(row) else None
            if figure is not None:
                yield figure, (row + 1) * surface.style.geometry.line_pitch_mm

    def place(self, surface: Any) -> None:
        """Begin to compile a page with its figures, which `take` shows when it is ready."""
        placed, masks, style = list(self.on(surface)), surface.masks, surface.style
        if placed:
            display = surface.display

            def make() -> Program:
                # It loads numba, which a reader who comes to no figure does not need.
                from vbraille.render.compiling import compile_scene
                from vbraille.render.figures import FigureAt, page_with_figures

                figures = [FigureAt(one.scene, (0.0, top), one.assets) for one, top in placed]
                scene, assets = page_with_figures(masks, style, figures)
                return compile_scene(scene, display, assets, rate_hz=display.rate_hz)

            self._making = surface.number, self._maker.submit(make)

    def take(self, surface: Any) -> None:
        """Have the figures of a page join it, once they are compiled."""
        if self._making is None or not self._making[1].done():
            return
        (number, made), self._making = self._making, None
        if number == surface.number:
            try:
                surface.device.put(made.result(), number)
                surface.figured = True
            except (InputError, ValueError) as error:
                self._note(f"figure not felt: {error}")

    def here(self, surface: Any, pose: Pose | None) -> tuple[str, str] | None:
        """Titles of the figure at a pose, and of its element there; None if none is there."""
        if pose is None:
            return None
        for figure, top_mm in self.on(surface):
            canvas, x_mm, y_mm = figure.scene.canvas, pose.x_mm, pose.y_mm - top_mm
            if 0 <= x_mm <= canvas.width_mm and 0 <= y_mm <= canvas.height_mm:
                if figure.title not in self._indices:
                    from vbraille.pictures.index import SceneIndex  # loads numba

                    made = SceneIndex(figure.scene, figure.assets, figure.boxes())
                    self._indices[figure.title] = made
                element = self._indices[figure.title].here(x_mm, y_mm)
                return figure.title, "" if element is None else element.name
        return None

    def feel(self, reader: Any) -> Picture | None:
        """Figure of the line, to be felt alone; None if it has none.

        Raises
        ------
        InputError
            If it cannot be felt.
        """
        from vbraille.pictures.loading import check_fits
        from vbraille.reading.picture import Picture

        figure = self._look(reader.line)
        if figure is None:
            return None
        if isinstance(figure, InputError):
            raise figure
        check_fits(figure.scene, reader.device.display)
        how = reader.device, reader.outputs, reader.key_set
        return Picture(figure, *how, where=Where.FIGURE)

    def _load(self, address: str) -> LoadedScene:
        from vbraille.pictures.loading import load_scene  # most books have no figures

        if self._folder is not None:
            return load_scene(self._folder / unquote(address).lstrip("/"), self._style())
        # What it includes is looked for beside it, which is nowhere: a book's figure is one file.
        with TemporaryDirectory(prefix="vbraille-") as folder:
            path = Path(folder) / Path(address).name[-60:]
            path.write_bytes(self._source.file(address))
            try:
                loaded = load_scene(path, self._style())
            except InputError as error:
                raise InputError(str(error).replace(f"{folder}/", "")) from None
        notes = tuple(note.replace(f"{folder}/", "") for note in loaded.notes)
        return replace(loaded, notes=notes)
