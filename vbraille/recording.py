"""Frames and poses in HDF5: one layout for `render` and playback.

`docs/recording.md` describes it.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import TYPE_CHECKING, NamedTuple

import h5py
import numpy as np

from vbraille.errors import InputError
from vbraille.version import __version__

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.newfile import NewFile
    from vbraille.render.braille.models import Model

FORMAT = 3
CHUNK_FRAMES = 1024
_CHUNK_LINES = 64


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
        rows, columns = display.shape

        def growing(name: str, dtype: str, *shape: int, chunk: int = CHUNK_FRAMES) -> h5py.Dataset:
            # The filters that every HDF5 library has. Bytes of frames are shared out by their
            # places in a number (shuffle) to no advantage; those of times and places are.
            return file.create_dataset(
                name,
                (0, *shape),
                dtype,
                maxshape=(None, *shape),
                chunks=(chunk, *shape),
                compression="gzip",
                compression_opts=1,
                shuffle=name != "frames",
            )

        self._time = growing("t_s", "f8")
        self._pose = [growing(name, "f8") for name in ("x_mm", "y_mm", "theta_rad")]
        self._line = growing("line", "i8")
        self._part = growing("part", "i8")
        self._frames = growing("frames", "f4", rows, columns)
        self._cells = growing("page/cells", "u1", width, chunk=_CHUNK_LINES)
        self._length = growing("page/length", "i8", chunk=_CHUNK_LINES)
        file.attrs["column_offset_mm"] = display.column_offsets_mm()
        file.attrs["row_offset_mm"] = display.row_offsets_mm()
        file.attrs["vbraille_version"] = __version__
        file.attrs["format"] = FORMAT

    def describe(
        self, *, model: Model, rate_hz: float, first_line: int, source: str, sha256: str
    ) -> None:
        """Write what was rendered, and how, as attributes."""
        self._file.attrs.update(
            model=model.name,
            mapping=model.style.mapping.name,
            geometry=json.dumps(asdict(model.style.geometry)),
            tuning=json.dumps(asdict(model.style.tuning)),
            rate_hz=rate_hz,
            first_line=first_line,
            source=source,
            source_sha256=sha256,
            calibration=json.dumps(None),
        )

    def describe_scene(
        self,
        scene: SceneRecorded,
        *,
        model: Model,
        rate_hz: float,
        source: str,
        sha256: str,
        path: str,
    ) -> None:
        """Write which tactile picture was rendered; it is the recording's one line, without cells.

        Parameters
        ----------
        scene
            The picture.
        model
            Display, and the style of the braille in the picture.
        rate_hz
            Frames a second.
        source, sha256
            Name and SHA-256 of the picture's file.
        path
            Words for the path of the array.
        """
        self.add_line(np.zeros(0, np.uint8))
        for name, written in (("scene/text", scene.text), ("scene/map", scene.map_png)):
            self._file.create_dataset(name, data=np.frombuffer(written, np.uint8))
        self._file["scene"].attrs.update(
            title=scene.title,
            description=scene.description,
            width_mm=scene.width_mm,
            height_mm=scene.height_mm,
            path=path,
        )
        self.describe(model=model, rate_hz=rate_hz, first_line=1, source=source, sha256=sha256)
        self._file.attrs["mapping"] = ""  # which belongs to lines

    @property
    def stored_bytes(self) -> int:
        """Tell how many bytes the frames and their places take on the disk so far, compressed."""
        kept = (self._time, *self._pose, self._line, self._part, self._frames)
        return sum(dataset.id.get_storage_size() for dataset in kept)

    def add_line(self, masks: NDArray[np.uint8]) -> int:
        """Append a line of the page, and return its row in ``page/cells``."""
        row = self._length.shape[0]
        self._cells.resize(row + 1, 0)
        self._cells[row, : masks.size] = masks
        self._length.resize(row + 1, 0)
        self._length[row] = masks.size
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
        before = self._time.shape[0]
        after = before + t_s.size
        for dataset, values in (
            (self._time, t_s),
            *zip(self._pose, (x_mm, y_mm, theta_rad), strict=True),
            (self._line, line),
            (self._part, part),
            (self._frames, frames),
        ):
            dataset.resize(after, 0)
            dataset[before:after] = values
        self._file.check()


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
    text, drawn = (_bytes(file, f"scene/{name}") for name in ("text", "map"))
    told = file["scene"].attrs
    return SceneRecorded(
        text,
        str(told["title"]),
        str(told["description"]),
        float(np.asarray(told["width_mm"])),
        float(np.asarray(told["height_mm"])),
        drawn,
    )


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


def _bytes(file: h5py.File, name: str) -> bytes:
    dataset = file[name]
    assert isinstance(dataset, h5py.Dataset)
    return dataset[:].tobytes()
