"""The tactile pictures that a text shows, read when a line comes that stands for one."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Thread
from typing import TYPE_CHECKING, Any, Final
from urllib.parse import unquote

import numpy as np

from vbraille.cli.old.reading.commands.scene import BOUND_FROM_TEXT
from vbraille.errors import InputError
from vbraille.feeling.loading import LoadedScene, check_fits, load_scene
from vbraille.render.figures import FigureAt, page_with_figures

EpubBook = None
from vbraille.wording import count, printable, spelled

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from vbraille.cli.old.reading.device import OpenDevice
    from vbraille.cli.old.reading.sceneview import SceneView
    from vbraille.cli.old.reading.view import Cue
    from vbraille.feeling.index import SceneIndex
    from vbraille.render.braille.style import BrailleStyle
    from vbraille.render.program import Program
    from vbraille.translate import Source

_MOST_KEPT: Final = 8  # figures that stay read
_LONGEST_NAME: Final = 60  # characters of a file's, at its end


class BookFigure:
    """A tactile picture that a text shows.

    Parameters
    ----------
    loaded
        The picture.
    style
        How the braille of its labels is shown.

    Attributes
    ----------
    title : str
        Title of the picture, or the name of its file.
    width_mm, height_mm : float
        Size of its canvas.
    """

    def __init__(self, loaded: LoadedScene, style: BrailleStyle) -> None:
        self.loaded = loaded
        self.style = style
        self.title = loaded.title
        canvas = loaded.scene.canvas
        self.width_mm, self.height_mm = canvas.width_mm, canvas.height_mm
        self._index: SceneIndex | None = None

    def name_at(self, x_mm: float, y_mm: float) -> str:
        """Name of the element at a place of its canvas, in mm; empty if none has one there."""
        if self._index is None:
            # It loads numba, which a reader who comes to no figure does not need.
            from vbraille.feeling.index import SceneIndex

            loaded = self.loaded
            self._index = SceneIndex(loaded.scene, loaded.assets, loaded.boxes())
        found = self._index.here(x_mm, y_mm)
        return "" if found is None else found.name


class BookFigures:
    """The tactile pictures of a text: files beside it, or in its container. Nothing is fetched.

    Parameters
    ----------
    source
        The text.
    folder
        Folder that it stands in.
    device
        Device that it is read on.
    note
        Function that is called with a sentence on each figure that cannot be felt.
    rate_hz
        Frames a second.
    room
        Bytes of the largest program that the engine has room for.
    sound, sounding
        Sounds of a figure that is felt alone, as for a `SceneView`.
    """

    def __init__(
        self,
        source: Source,
        folder: Path,
        device: OpenDevice,
        note: Callable[[str], None],
        *,
        rate_hz: float,
        room: int,
        sound: Callable[[Path], None] | None = None,
        sounding: bool = False,
    ) -> None:
        self._source, self._folder, self._device, self._note = source, folder, device, note
        self._rate_hz, self._room = rate_hz, room
        self._sound, self._sounding = sound, sounding
        self._found: dict[str, BookFigure | None] = {}
        self._why: dict[str, str] = {}  # some figures cannot be felt
        self._noted: set[str] = set()
        self._warming: Thread | None = None

    @property
    def ready(self) -> bool:
        """Tell whether a page can be made without waiting for the compiler to be loaded."""
        return self._warming is None or not self._warming.is_alive()

    def find(self, address: str) -> BookFigure | None:
        """Give the figure of an address; None if it cannot be felt, which is said once."""
        style, known = self._device.style, self._found.get(address)
        if address in self._found and (
            known is None or known.style == style or not known.loaded.assets.written
        ):
            return known
        try:
            loaded = self._load(address, style)
        except (InputError, ValueError) as error:  # as of a name that no file can have
            self._why[address] = str(error)
            self._say(address, str(error))
            found = None
        else:
            found = BookFigure(loaded, style)
            self._warm_up(found)
            if loaded.notes:
                more = len(loaded.notes) - 1
                also = f"; vbraille scene check has {count(more, 'more remark')}" if more else ""
                self._say(address, f"{loaded.notes[0]}{also}", "figure")
        if len(self._found) >= _MOST_KEPT:
            del self._found[next(iter(self._found))]
        self._found[address] = found
        return found

    def page(
        self,
        lines: Sequence[NDArray[np.uint8]],
        start_mm: float,
        style: BrailleStyle,
        placed: Sequence[tuple[Any, float]],
    ) -> Program | None:
        """Make one picture of a page and its figures; see `FiguresLike`."""
        try:
            program = self._compile(lines, start_mm, style, placed)
        except (InputError, ValueError) as error:
            self._say(placed[0][0].title, f"{placed[0][0].title}: {error}")
            return None
        if program.nbytes > self._room:
            self._say(placed[0][0].title, f"{placed[0][0].title}: it is too large for a page")
            return None
        return program

    def _compile(
        self,
        lines: Sequence[NDArray[np.uint8]],
        start_mm: float,
        style: BrailleStyle,
        placed: Sequence[tuple[Any, float]],
    ) -> Program:
        # It loads numba, which a reader who comes to no figure does not need.
        from vbraille.render.compiling import compile_scene

        figures = [
            FigureAt(figure.loaded.scene, (0.0, top_mm), figure.loaded.assets)
            for figure, top_mm in placed
        ]
        scene, assets = page_with_figures(lines, style, figures, start_mm=start_mm)
        return compile_scene(scene, self._device.display, assets, rate_hz=self._rate_hz)

    def feel(
        self, address: str, say: Callable[[str], None], cue: Callable[[Cue], None]
    ) -> SceneView:
        """Put a figure alone under the hand, in place of the text; see `FiguresLike`."""
        # As above.
        from vbraille.cli.old.reading.sceneview import SceneView
        from vbraille.feeling.composing import compose

        device = self._device
        figure = self.find(address)
        if figure is None:
            raise InputError(self._why[address])
        loaded = figure.loaded
        check_fits(loaded.scene, device.display)
        program = compose(loaded, device.display, rate_hz=self._rate_hz)
        if program.nbytes > self._room:
            raise InputError(f"{loaded.title} is too large; feel it by vbraille feel")
        feeler = SceneView(
            loaded,
            device,
            rate_hz=self._rate_hz,
            say=say,
            bound=BOUND_FROM_TEXT,
            room=self._room,
            cue=cue,
            sound=self._sound,
            sounding=self._sounding,
        )
        feeler.start(program)
        return feeler

    def _warm_up(self, figure: BookFigure) -> None:
        """Load what compiles pages, while reading goes on; it takes about a second."""
        if self._warming is None:
            self._warming = Thread(
                target=self._rehearse, args=(figure, self._device.style), daemon=True
            )
            self._warming.start()

    def _rehearse(self, figure: BookFigure, style: BrailleStyle) -> None:
        with suppress(InputError, ValueError):  # which is said when the page itself is made
            self._compile([np.ones(1, np.uint8)], 0.0, style, [(figure, 0.0)])

    def _load(self, address: str, style: BrailleStyle) -> LoadedScene:
        """Read a figure.

        Raises
        ------
        InputError
            If it is not there, or cannot be used.
        """
        if not isinstance(self._source, EpubBook):
            return load_scene(self._folder / unquote(address).lstrip("/"), style)
        member = address.removeprefix("#")
        # What it includes is looked for beside it, which is nowhere: a book's figure is one file.
        with TemporaryDirectory(prefix="vbraille-") as folder:
            path = Path(folder) / Path(member).name[-_LONGEST_NAME:]
            path.write_bytes(self._source.member(member))
            try:
                loaded = load_scene(path, style)
            except InputError as error:
                raise InputError(str(error).replace(f"{folder}/", "")) from None
        notes = tuple(note.replace(f"{folder}/", "") for note in loaded.notes)
        return replace(loaded, notes=notes)

    def _say(self, what: str, why: str, begins: str = "figure not felt") -> None:
        if what not in self._noted:
            self._noted.add(what)
            self._note(f"{begins}: {printable(spelled(why))}")
