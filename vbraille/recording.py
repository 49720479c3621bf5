"""Frames and poses in HDF5: one layout for `render` and playback.

`docs/recording.md` describes it.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple, Self

import h5py
import numpy as np

from vbraille.braille.geometry import Geometry
from vbraille.display import Display
from vbraille.errors import InputError
from vbraille.newfile import new_file
from vbraille.render import MAPPINGS, MODELS, Model, Tuning, model_of, single_row
from vbraille.version import __version__

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.newfile import NewFile

FORMAT = 3
CHUNK_FRAMES = 1024
_CHUNK_LINES = 64
_TEXT: Final = h5py.string_dtype()
_MAPPINGS: Final = MAPPINGS | {m.name: m for m in map(single_row, (1, 2, 3))}
NUMBERS: Final = ("t_s", "x_mm", "y_mm", "theta_rad", "line", "part")
_SCENE: Final = ("title", "description", "width_mm", "height_mm")
# What reading a file raises that is HDF5, but not as this module writes it.
UNLIKE: Final = (
    OSError, KeyError, ValueError, TypeError, AttributeError, IndexError, OverflowError,
    RuntimeError, MemoryError,
)  # fmt: skip


class Print(NamedTuple):
    """Print of a line of braille.

    Parameters
    ----------
    text
        Text of the line; empty where its source is braille.
    sources : int32[cells, 2]
        For each cell, where in the text that begins and ends which it stands for; two equal
        numbers where it stands for nothing.
    """

    text: str
    sources: NDArray[np.int32]


class SceneRecorded(NamedTuple):
    """A tactile picture, as a recording of it keeps it.

    Parameters
    ----------
    text
        Bytes of the file.
    title, description
        What it shows.
    width_mm, height_mm
        Size of the canvas.
    map_png
        The deflection map as a PNG that covers the canvas; white is rest.
    """

    text: bytes
    title: str
    description: str
    width_mm: float
    height_mm: float
    map_png: bytes


class Recorder:
    """Append frames and lines to an open file.

    Parameters
    ----------
    file
        An open file, as `new_file` gives it.
    display
        The actuators and the carriage.
    width
        Number of cells in a line.
    """

    def __init__(self, file: NewFile, display: Display, width: int) -> None:
        self._file = file
        kinds = dict.fromkeys(NUMBERS, ("f8",)) | {
            "line": ("i8",),
            "part": ("i8",),
            "frames": ("f4", *display.shape),
            "page/cells": ("u1", width),
            "page/length": ("i8",),
            "page/sources": ("i4", width, 2),
            "page/text": (_TEXT,),
        }
        self._datasets: dict[str, h5py.Dataset] = {}
        for name, (kind, *shape) in kinds.items():
            chunk = _CHUNK_LINES if name.startswith("page/") else CHUNK_FRAMES
            # The filters that every HDF5 library has. Bytes of frames are shared out by their
            # places in a number (shuffle) to no advantage; those of times and places are.
            self._datasets[name] = file.create_dataset(
                name,
                (0, *shape),
                kind,
                maxshape=(None, *shape),
                chunks=(chunk, *shape),
                compression="gzip",
                compression_opts=1,
                shuffle=name != "frames",
            )
        file.attrs["column_offset_mm"] = display.column_offsets_mm()
        file.attrs["row_offset_mm"] = display.row_offsets_mm()
        file.attrs["vbraille_version"] = __version__
        file.attrs["format"] = FORMAT

    def describe(
        self,
        model: Model,
        *,
        rate_hz: float,
        source: str,
        sha256: str,
        first_line: int = 1,
        scene: SceneRecorded | None = None,
        path: str = "",
    ) -> None:
        """Write what was rendered, and how.

        Parameters
        ----------
        model
            Display, and the style of the braille.
        rate_hz
            Frames a second.
        source, sha256
            Name and SHA-256 of the file that was rendered.
        first_line
            Number in the source of the first line.
        scene, path
            Tactile picture that was rendered, which is the recording's one line, without cells; and
            words for the path of the array. None if lines were.
        """
        self._file.attrs.update(
            model=model.name,
            mapping=model.style.mapping.name if scene is None else "",
            display=json.dumps(asdict(replace(model.display, rate_hz=rate_hz))),
            geometry=json.dumps(asdict(model.style.geometry)),
            tuning=json.dumps(asdict(model.style.tuning)),
            rate_hz=rate_hz,
            first_line=first_line,
            source=source,
            source_sha256=sha256,
        )
        if scene is not None:
            self.add_line(np.zeros(0, np.uint8))
            for name, written in (("scene/text", scene.text), ("scene/map", scene.map_png)):
                self._file.create_dataset(name, data=np.frombuffer(written, np.uint8))
            told = {name: getattr(scene, name) for name in _SCENE}
            self._file["scene"].attrs.update(told, path=path)

    def add_line(self, masks: NDArray[np.uint8], printed: Print | None = None) -> int:
        """Append a line of the page with its print, and return its row in ``page/cells``."""
        datasets = self._datasets
        row = datasets["page/length"].shape[0]
        for name in ("page/cells", "page/length", "page/sources", "page/text"):
            datasets[name].resize(row + 1, 0)
        datasets["page/length"][row] = masks.size
        datasets["page/cells"][row, : masks.size] = masks
        if printed is not None:
            # A lone surrogate, as of a damaged book, has no bytes.
            datasets["page/text"][row] = printed.text.encode("utf-8", "replace")
            datasets["page/sources"][row, : masks.size] = printed.sources
        return row

    def add_frames(
        self,
        t_s: NDArray[np.float64],
        x_mm: NDArray[np.float64],
        line: NDArray[np.int64] | int,
        frames: NDArray[np.float32],
        *,
        y_mm: NDArray[np.float64] | float = 0.0,
        theta_rad: NDArray[np.float64] | float = 0.0,
        part: NDArray[np.int64] | int = 0,
    ) -> None:
        """Append frames of one line, or of a page of lines.

        Parameters
        ----------
        t_s, x_mm : float64[n]
            Times, and places of the array's centre.
        line : int64[n] or int
            Number of the row of ``page/cells`` that was under the array.
        frames : float32[n, rows, columns]
            Deflections, 0 … 1.
        y_mm, theta_rad : float64[n]
            The rest of the pose, see `vbraille.display`.
        part : int64[n]
            Which part of a picture that has several was under the array.
        """
        before = self._datasets["t_s"].shape[0]
        rows = (t_s, x_mm, y_mm, theta_rad, line, part, frames)
        for name, values in zip((*NUMBERS, "frames"), rows, strict=True):
            dataset = self._datasets[name]
            dataset.resize(before + t_s.size, 0)
            dataset[before:] = values
        self._file.check()


@dataclass(frozen=True, slots=True, eq=False)
class Recording:
    """Frames along a path, with their times and places, and the cells or the picture below.

    Parameters
    ----------
    t_s : float64[n]
        Times, which never go back.
    x_mm, y_mm, theta_rad : float64[n]
        Places of the array's centre and its angle, as `vbraille.display` has them.
    frames : float32[n, rows, columns]
        Deflections, 0 … 1.
    model
        Display, at the rate of the frames, and the style of the braille.
    cells
        Dot masks of each line.
    line, part : int64[n]
        Number in ``cells`` of the line that was under the array, and of the part of a page.
    source
        Name of what was rendered.
    first_line
        Number in the source of the first of ``cells``.
    scene
        Picture that was rendered; None if lines were.
    prints
        Print of each line; empty where there is none.

    Raises
    ------
    InputError
        If the lengths do not fit each other, or a deflection is not in 0 … 1.
    """

    t_s: NDArray[np.float64]
    x_mm: NDArray[np.float64]
    y_mm: NDArray[np.float64]
    theta_rad: NDArray[np.float64]
    frames: NDArray[np.float32]
    model: Model
    cells: Sequence[NDArray[np.uint8]]
    line: NDArray[np.int64]
    part: NDArray[np.int64]
    source: str = ""
    first_line: int = 1
    scene: SceneRecorded | None = None
    prints: Sequence[Print] = ()

    def __post_init__(self) -> None:
        size = len(self.t_s)
        rows = (self.x_mm, self.y_mm, self.theta_rad, self.line, self.part)
        if any(np.shape(row) != (size,) for row in rows) or not size:
            raise InputError("a recording needs one place, line and part for each time, and a time")
        if self.frames.shape != (size, *self.model.display.shape):
            rows_columns = " × ".join(map(str, self.model.display.shape))
            raise InputError(f"the frames must be {size} × {rows_columns}, one for each time")
        if not ((self.frames >= 0) & (self.frames <= 1)).all():
            raise InputError("a deflection is not from 0 to 1; a recording has none of those")
        cells = [len(row) for row in self.cells]
        if self.prints and [len(one.sources) for one in self.prints] != cells:
            raise InputError("prints need one print for each line, with a source for each cell")
        if not (np.diff(self.t_s) >= 0).all():
            raise InputError("the times of a recording must increase")

    @classmethod
    def open(cls, path: Path | str) -> Self:
        """Read a file that `write` or ``vbraille render`` wrote.

        Raises
        ------
        InputError
            If there is none, or it is something else.
        """
        try:
            with h5py.File(Path(path), "r") as file:
                return cls._read(file)
        except FileNotFoundError:
            raise InputError(f"there is no file {path}; check the name") from None
        except BlockingIOError:
            raise InputError(f"{path} is open in another program; close it there") from None
        except UNLIKE as error:
            raise InputError(f"{path} is no recording; give what vbraille render wrote") from error

    @classmethod
    def _read(cls, file: h5py.File) -> Self:
        check_format(file)
        model = model_in(file)
        numbers = {name: dataset_in(file, name)[:] for name in NUMBERS}
        lengths = dataset_in(file, "page/length")[:].tolist()
        rows = dataset_in(file, "page/cells")[:]
        return cls(
            **numbers,
            frames=dataset_in(file, "frames")[:],
            model=model,
            cells=[row[:length] for row, length in zip(rows, lengths, strict=True)],
            source=str(file.attrs["source"]),
            first_line=int(np.asarray(file.attrs["first_line"])),
            scene=scene_of(file),
            prints=[print_in(file, row, length) for row, length in enumerate(lengths)],
        )

    def write(self, path: Path | str, *, replace: bool = False) -> None:
        """Write the file, which gets its name only once it is whole.

        Parameters
        ----------
        path
            Path of the file, which ends in ``.h5`` by custom.
        replace
            True if it may take the place of a file.

        Raises
        ------
        InputError
            If no file can be made there, or one is there.
        VbrailleError
            If writing fails, as on a full disk.
        """
        rate_hz = self.model.display.rate_hz
        with new_file(path, replace=replace) as file:
            recorder = Recorder(file, self.model.display, max(1, *map(len, self.cells), 1))
            digest = "" if self.scene is None else hashlib.sha256(self.scene.text).hexdigest()
            recorder.describe(
                self.model, rate_hz=rate_hz, source=self.source, sha256=digest,
                first_line=self.first_line, scene=self.scene,
            )  # fmt: skip
            if self.scene is None:
                for row, masks in enumerate(self.cells):
                    recorder.add_line(masks, self.prints[row] if self.prints else None)
            recorder.add_frames(
                self.t_s, self.x_mm, self.line, self.frames, y_mm=self.y_mm,
                theta_rad=self.theta_rad, part=self.part,
            )  # fmt: skip


def model_in(file: h5py.File) -> Model:
    """Read what display a recording is of, and the style of its braille.

    Returns
    -------
    Model
        Model without a name where the file names none, or no mapping, of this program: the style is
        then one that such a display is usually read in.

    Raises
    ------
    ValueError
        If the display is of another shape than the frames.
    """
    told = {name: json.loads(str(file.attrs[name])) for name in ("display", "geometry", "tuning")}
    display = Display(**told["display"])
    if display.shape != dataset_in(file, "frames").shape[1:]:
        raise ValueError("the frames are of another display")
    name = str(file.attrs["model"])
    model, mapping = MODELS.get(name), _MAPPINGS.get(str(file.attrs["mapping"]))
    if model is None or (mapping is None and "scene" not in file):
        return replace(model_of(display), name="", title=name, display=display)
    style = model.style
    if mapping is not None:
        geometry, tuning = Geometry(**told["geometry"]), Tuning(**told["tuning"])
        style = replace(style, mapping=mapping, geometry=geometry, tuning=tuning)
        style.rows_on(display)
    return replace(model, display=display, style=style)


def scene_of(file: h5py.File) -> SceneRecorded | None:
    """Read the tactile picture of a recording; None if lines of braille were recorded.

    Raises
    ------
    InputError
        If it is of another format.
    """
    check_format(file)
    if "scene" not in file:
        return None
    text, drawn = (dataset_in(file, name)[:].tobytes() for name in ("scene/text", "scene/map"))
    title, description, width_mm, height_mm = (np.asarray(file["scene"].attrs[n]) for n in _SCENE)
    return SceneRecorded(
        text, str(title), str(description), float(width_mm), float(height_mm), drawn
    )


def print_in(file: h5py.File, row: int, length: int) -> Print:
    """Read the print of a line: a row of ``page/cells``, and its number of cells.

    A recording of braille has none.
    """
    texts, sources = file["page/text"], dataset_in(file, "page/sources")
    assert isinstance(texts, h5py.Dataset)
    text = texts[row]
    text = text.decode("utf-8", "replace") if isinstance(text, bytes) else str(text)
    return Print(text, np.clip(sources[row, :length], 0, len(text)).astype(np.int32))


def check_format(file: h5py.File) -> None:
    """Refuse a recording of another format.

    Raises
    ------
    InputError
        If its attribute ``format`` is not `FORMAT`.
    KeyError
        If it has none, and is HDF5 of something else.
    """
    found = int(np.asarray(file.attrs["format"]))
    if found != FORMAT:
        raise InputError(
            f"{file.filename} is a recording of format {found}, and this vbraille reads format "
            f"{FORMAT}; play it with the vbraille that wrote it, or render it again"
        )


def dataset_in(file: h5py.File, name: str) -> h5py.Dataset:
    """Find a dataset of numbers.

    Raises
    ------
    KeyError
        If there is none.
    TypeError
        If it is something else.
    """
    found = file[name]
    if not isinstance(found, h5py.Dataset) or found.dtype.kind not in "iuf":
        raise TypeError
    return found
