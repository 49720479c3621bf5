"""Image files as intensities, read so that no file costs much memory or time.

Pillow reads them. Only the kinds of files that are asked for are given to it, since it knows many
more, whose readers few people test.
"""

from __future__ import annotations

import warnings
from contextlib import contextmanager
from io import BytesIO
from typing import TYPE_CHECKING, Literal

import numpy as np

from vbraille.errors import InputError
from vbraille.scene.bitmap import WHOLE
from vbraille.scene.filebytes import read_bytes

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray
    from PIL import Image as Pillow

_MOST_FILE_BYTES = 100 << 20
# What Pillow may take a file for, whatever its name ends with.
KINDS = ("PNG", "GIF", "BMP", "JPEG")
# More than the largest cameras have; a picture of four channels takes 240 MB then, for a moment.
MOST_PIXELS = 60_000_000
# Each scan of a progressive JPEG goes over all of it again; programs write about ten.
_MOST_SCANS = 100
_SCAN = b"\xff\xda"


class ImageFile:
    """A picture in a file, which is turned as its EXIF data say.

    Of a GIF file that moves the first picture counts.

    Parameters
    ----------
    path
        PNG, GIF, BMP, JPEG or SVG file. Of an SVG file texts and images within it are left out.

    Attributes
    ----------
    columns, rows : int
        Pixels along it; of an SVG file very many.
    size_mm : tuple of float or None
        Width and height that an SVG file gives itself.

    Raises
    ------
    InputError
        If the file cannot be read, is no such image, is damaged, or is far too large.
    """

    def __init__(self, path: Path) -> None:
        self._path, self.size_mm, self._drawing, self._image = path, None, None, None
        content = read_bytes(path, _MOST_FILE_BYTES)
        begins = content.removeprefix(b"\xef\xbb\xbf").lstrip()[:1] == b"<"
        if begins or content[:2] in (b"\xff\xfe", b"\xfe\xff", b"\x1f\x8b"):
            from vbraille.scene.svg.raster import RasterDrawing  # loads lxml

            self._drawing = RasterDrawing(path)
            self.size_mm = self._drawing.size_mm
            self.columns, self.rows = self._drawing.columns, self._drawing.rows
        else:
            self._image = _opened(content, path)
            self.columns, self.rows = self._image.size

    def intensities(
        self, channel: Literal["gray", "alpha"], columns: int, rows: int
    ) -> NDArray[np.uint16]:
        """Intensities of the picture.

        A gray is the luminance of its colour (ITU-R 601, from the values as they are in the file),
        laid over black where the image is transparent, so that what is white and opaque is up. PNG
        files of 16 bits of gray keep them; other files have 8.

        Parameters
        ----------
        channel
            What counts: "gray", or "alpha", by which what is opaque is up.
        columns, rows
            Pixels that are wanted; where they are fewer than the picture has, it is averaged.

        Returns
        -------
        uint16[rows, columns]
            Intensities, of which 65,535 is up.

        Raises
        ------
        InputError
            If there is no alpha where that is asked for, or an SVG file cannot be drawn.
        """
        from PIL import Image

        drawing = self._drawing
        image = _opened(drawing.png(columns, rows), self._path) if drawing else self._image
        assert image is not None
        is_deep = image.mode == "I" or image.mode.startswith("I;16")
        has_alpha = image.mode in ("RGBA", "LA", "PA") or "transparency" in image.info
        if channel == "alpha" and (is_deep or not has_alpha):
            raise InputError(f'{self._path} has no alpha channel; write channel = "gray"')

        def smaller(image: Pillow.Image) -> Pillow.Image:
            shape = columns, rows
            return image if image.size == shape else image.resize(shape, Image.Resampling.BOX)

        if is_deep:  # Pillow averages these as floating point alone
            values = np.asarray(image).astype(np.float32)
            clear = image.info.get("transparency")
            if isinstance(clear, int):
                values[values == clear] = 0.0
            averaged = np.asarray(smaller(Image.fromarray(values)))
            return np.clip(np.rint(averaged), 0, WHOLE).astype(np.uint16)
        with _refusing(self._path):
            if has_alpha:
                # Colours times alpha, so that averaging is right at transparent edges.
                image = image if image.mode == "RGBA" else image.convert("RGBA")
                *colors, alpha = smaller(image.convert("RGBa")).split()
                image = alpha if channel == "alpha" else Image.merge("RGB", colors).convert("L")
            else:
                image = image if image.mode in ("L", "RGB", "1") else image.convert("RGB")
                image = smaller(image.convert("L"))
        return np.asarray(image).astype(np.uint16) * (WHOLE // 255)


def _opened(content: bytes, path: Path) -> Pillow.Image:
    """Picture that Pillow reads, whole and turned."""
    with _refusing(path):
        from PIL import Image, ImageOps

        try:
            image = Image.open(BytesIO(content), formats=KINDS)
        except Image.UnidentifiedImageError:
            raise InputError(
                f"{path} is no PNG, GIF, BMP, JPEG or SVG file; save it as one of these"
            ) from None
        columns, rows = image.size
        if columns * rows > MOST_PIXELS:
            raise InputError(
                f"{path} has {columns} × {rows} pixels; make it smaller, "
                f"at most {MOST_PIXELS // 1_000_000} million"
            )
        if image.format in ("JPEG", "MPO") and content.count(_SCAN) > _MOST_SCANS:
            raise InputError(f"{path} has far too many scans for a JPEG file; save it again")
        image.load()
        ImageOps.exif_transpose(image, in_place=True)
        return image


@contextmanager
def _refusing(path: Path) -> Iterator[None]:
    """Make one sentence of whatever Pillow raises or warns of."""
    try:
        with warnings.catch_warnings():
            # It warns of images of 90 million pixels, and of odd but harmless data in them.
            warnings.simplefilter("ignore")
            yield
    except InputError:
        raise
    # Readers of damaged files raise nearly everything, and Pillow promises no fewer kinds.
    except Exception as error:
        kind = type(error).__name__
        if kind == "DecompressionBombError":
            raise InputError(f"{path} has far too many pixels; make it smaller") from None
        said = " ".join(str(error).split()) or kind
        raise InputError(f"{path} is damaged: {said[:120]}; save it again") from None
