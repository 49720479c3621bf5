"""Image files as intensities, read so that no file costs much memory or time.

Pillow reads them. Only the kinds of files that are asked for are given to it, since it knows many
more, whose readers few people test.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from contextlib import contextmanager
from typing import TYPE_CHECKING, Literal

from vbraille.errors import InputError
from vbraille.scene.bitmap import WHOLE
from vbraille.scene.filebytes import read_bytes

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    import numpy as np
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

Channel = Literal["gray", "alpha"]
# From an image's columns and rows, and from the size in mm that it gives itself if it does, to how
# many columns and rows are wanted.
ShapeOf = Callable[[int, int, "tuple[float, float] | None"], "tuple[int, int]"]


def intensities_of(path: Path, channel: Channel, shape_of: ShapeOf) -> NDArray[np.uint16]:
    """Intensities of an image file.

    A gray is the luminance of its colour (ITU-R 601, from the values as they are in the file), laid
    over black where the image is transparent, so that what is white and opaque is up. PNG files of
    16 bits of gray keep them; other files have 8. An image is turned as its EXIF data say, and
    of a GIF file that moves the first picture counts.

    Parameters
    ----------
    path
        PNG, GIF, BMP, JPEG or SVG file. Of an SVG file texts and images within it are left out.
    channel
        What counts: "gray", or "alpha", by which what is opaque is up.
    shape_of
        Function that says from the image's columns and rows, once it is turned, and from the size
        in mm that an SVG has, how many columns and rows are wanted; where they are fewer, pixels
        are averaged.

    Returns
    -------
    uint16[rows, columns]
        Intensities, of which 65,535 is up.

    Raises
    ------
    InputError
        If the file cannot be read, is no such image, is damaged, is far too large, or has no
        alpha where that is asked for.
    """
    from io import BytesIO

    content = read_bytes(path, _MOST_FILE_BYTES)
    drawn = _is_svg(content)
    if drawn:
        from vbraille.scene.svg.raster import png_of  # loads lxml

        content = png_of(path, shape_of)
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
        shape = image.size if drawn else shape_of(*image.size, None)
        return _intensities(image, channel, shape, path)


def _is_svg(content: bytes) -> bool:
    """Tell whether bytes begin as an SVG does, or as a compressed one."""
    begins = content.removeprefix(b"\xef\xbb\xbf").lstrip()[:1] == b"<"
    return begins or content[:2] in (b"\xff\xfe", b"\xfe\xff", b"\x1f\x8b")


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


def _intensities(
    image: Pillow.Image, channel: Channel, shape: tuple[int, int], path: Path
) -> NDArray[np.uint16]:
    import numpy as np
    from PIL import Image

    is_deep = image.mode == "I" or image.mode.startswith("I;16")
    has_alpha = image.mode in ("RGBA", "LA", "PA") or "transparency" in image.info
    if channel == "alpha" and (is_deep or not has_alpha):
        raise InputError(f'{path} has no alpha channel; write channel = "gray"')
    if is_deep:  # Pillow averages these as floating point alone
        values = np.asarray(image).astype(np.float32)
        clear = image.info.get("transparency")
        if isinstance(clear, int):
            values[values == clear] = 0.0
        averaged = np.asarray(_smaller(Image.fromarray(values), shape))
        return np.clip(np.rint(averaged), 0, WHOLE).astype(np.uint16)
    if has_alpha:
        # Colours times alpha, so that averaging is right at transparent edges.
        image = image if image.mode == "RGBA" else image.convert("RGBA")
        *colors, alpha = _smaller(image.convert("RGBa"), shape).split()
        image = alpha if channel == "alpha" else Image.merge("RGB", colors).convert("L")
    else:
        if image.mode not in ("L", "RGB", "1"):
            image = image.convert("RGB")
        image = _smaller(image.convert("L"), shape)
    return np.asarray(image).astype(np.uint16) * (WHOLE // 255)


def _smaller(image: Pillow.Image, shape: tuple[int, int]) -> Pillow.Image:
    """Average pixels to a smaller number of columns and rows."""
    from PIL import Image

    return image if image.size == shape else image.resize(shape, Image.Resampling.BOX)
