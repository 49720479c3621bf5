"""Images of a scene: files read, placed, averaged and blurred as bitmaps, or made into dots.

Lévesque 2009, 8.4.2; dots in the places of blobs are of 6.3.1, and those of a grid of 5.3. Pillow
reads the files. Only the kinds of files that are asked for are given to it, since it knows many
more, whose readers few people test.
"""

from __future__ import annotations

import math
import warnings
from collections import defaultdict
from contextlib import contextmanager
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import msgspec
import numpy as np

from vbraille.errors import InputError, needing_extras
from vbraille.files import read_bytes
from vbraille.scene.bitmap import WHOLE, Bitmap, pixel_size_mm
from vbraille.scene.patterns import Dots, Group, Image, Pattern
from vbraille.scene.traversal import each

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray
    from PIL import Image as Pillow

    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import AnyPattern, ImageDots
    from vbraille.scene.scene import Scene


_MOST_FILE_BYTES = 100_000_000
# What Pillow may take a file for, whatever its name ends with.
KINDS = ("PNG", "GIF", "BMP", "JPEG")
# More than the largest cameras have; a picture of four channels takes 240 MB then, for a moment.
_MOST_FILE_PIXELS = 60_000_000
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
        content = read_bytes(path, "picture", _MOST_FILE_BYTES)
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
        if columns * rows > _MOST_FILE_PIXELS:
            raise InputError(
                f"{path} has {columns} × {rows} pixels; make it smaller, "
                f"at most {_MOST_FILE_PIXELS // 1_000_000} million"
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


# The source asks for 5 to 10 pixels per mm; more than the larger is averaged away.
MOST_PER_MM = 10.0
# A Gauss of more pixels is as smooth with fewer (bilinear between them: within 0.002), and the
# time that a blur takes grows with them.
_WIDEST_BLUR = 5.0  # pixels
_BLUR_REACH = 4.0  # standard deviations
MOST_PIXELS = 16_000_000  # of a bitmap; larger images have fewer per mm
MOST_TOGETHER = 64_000_000  # of a scene's bitmaps
MOST_DOTS = 20_000
# Dots share a pattern if they look the same: no finger tells these steps, nor does an 8-bit image
# have finer ones.
_RADIUS_MM = 0.01
_LEVELS = 255
_LEAST_RADIUS_MM = 0.05


def load_bitmaps(scene: Scene, folder: Path, places: Sequence[str] = ()) -> dict[Image, Bitmap]:
    """Read the image files of a scene.

    An image has at most 10 pixels per mm, and at most 16 million; what is more is averaged. Images
    of the same file, shape and blur share their intensities. A blurred image reaches beyond its
    place by four standard deviations, so that there is no sharp edge there either: its bitmap is
    larger than it.

    Parameters
    ----------
    scene
        A resolved scene.
    folder
        Folder from which the names of files are seen.
    places
        File and line of each element, for messages; none if they are not known.

    Returns
    -------
    dict
        A bitmap for each image of the scene, wherever it stands in it.

    Raises
    ------
    InputError
        If a file cannot be read or is no image, the size of an image is not known, or the scene's
        images have more than 64 million pixels together.
    """
    bitmaps: dict[Image, Bitmap] = {}
    kept: dict[tuple[object, ...], Bitmap] = {}
    for number, element in enumerate(scene.elements):
        place = f"{places[number]}: " if places and places[number] else ""
        for image in each(element):
            if not isinstance(image, Image) or image in bitmaps:
                continue
            outside = image.outside if image.blur_mm else 0.0
            looks = (image.channel, image.inverted_source, image.blur_mm, outside, image.nearest)
            source = (image.file, image.width_mm, image.height_mm, *looks)
            try:
                if source not in kept:
                    kept[source] = _laid(image, folder)
                if sum(one.intensities.size for one in kept.values()) > MOST_TOGETHER:
                    raise InputError(
                        f"{_named(image)}: the images of the scene have more than "
                        f"{MOST_TOGETHER // 1_000_000} million pixels together; make some smaller"
                    )
            except InputError as error:
                raise InputError(f"{place}{error}") from None
            laid = kept[source]
            left, top = (a + b for a, b in zip(image.place_mm, laid.place_mm, strict=True))
            bitmaps[image] = replace(
                laid, place_mm=(left, top), outside=image.outside, nearest=image.nearest
            )
    return bitmaps


def _named(image: Image | ImageDots) -> str:
    """Name of an element with an image file, for messages."""
    return f"element {image.id}" if image.id else f"image {image.file}"


def _read(image: Image | ImageDots, folder: Path, per_mm: float) -> Bitmap:
    """Intensities of the file of an element, at the origin, with a number of pixels per mm."""
    channel = image.channel if isinstance(image, Image) else "gray"
    blur_mm = image.blur_mm if isinstance(image, Image) else 0.0
    try:
        file = ImageFile(Path(folder, image.file))
        width, height = _size_mm(image, file)
        if blur_mm > min(width, height):
            raise ValueError(
                f"a blur of {blur_mm:g} mm, which is more than its width or height; make it smaller"
            )
        # Vast images have fewer pixels per mm, and a band of 10 m by 0.1 mm has a row, too.
        per_mm = min(per_mm, math.sqrt(MOST_PIXELS / (width * height)))
        columns = min(file.columns, max(int(width * per_mm), 1))
        rows = min(file.rows, max(int(height * per_mm), 1))
        return Bitmap(file.intensities(channel, columns, rows), (0.0, 0.0), width, height)
    except ValueError as error:
        raise InputError(f"{_named(image)} has {error}") from None
    except InputError as error:
        raise InputError(f"{_named(image)}: {error}") from None


def _size_mm(image: Image | ImageDots, file: ImageFile) -> tuple[float, float]:
    """Width and height of an image on the canvas.

    If one is not given, it follows from the shape of the image's pixels; if neither is, they are
    those that a drawing has itself.
    """
    width, height = image.width_mm, image.height_mm
    if width is None and height is None:
        width, height = file.size_mm or (None, None)
    if width is None and height is None:
        raise ValueError("no size; give width_mm or height_mm")
    width = (height or 0.0) * file.columns / file.rows if width is None else width
    height = width * file.rows / file.columns if height is None else height
    if not 0.1 <= min(width, height) <= max(width, height) <= 10_000.0:
        raise ValueError(
            f"a size of {width:g} × {height:g} mm by the picture's shape; "
            "give both width_mm and height_mm"
        )
    return width, height


def _laid(image: Image, folder: Path) -> Bitmap:
    """Bitmap of an image at the origin, which its blur makes larger."""
    # Whose own pixels count has all of them.
    per_mm = math.inf if image.nearest else MOST_PER_MM
    if image.blur_mm and not image.nearest:
        per_mm = min(per_mm, _WIDEST_BLUR / image.blur_mm)
    laid = _read(image, folder, per_mm)
    if image.inverted_source:
        laid = replace(laid, intensities=WHOLE - laid.intensities)
    if not image.blur_mm:
        return laid
    return _blurred_pixels(laid, image) if image.nearest else _blurred(laid, image)


def _blurred(laid: Bitmap, image: Image) -> Bitmap:
    """Blur an image, which then reaches farther."""
    with needing_extras():
        from scipy.ndimage import gaussian_filter
    pixel_mm = pixel_size_mm(laid)
    sigmas = [image.blur_mm / of for of in pixel_mm]
    wide, high = (math.ceil(_BLUR_REACH * sigma) for sigma in sigmas)
    outside = round(image.outside * WHOLE)
    padded = np.pad(laid.intensities, ((high, high), (wide, wide)), constant_values=outside)
    blurred = gaussian_filter(
        padded.astype(np.float32),
        (sigmas[1], sigmas[0]),
        mode="constant",
        cval=outside,
        truncate=_BLUR_REACH,
    )
    whole = np.clip(np.rint(blurred), 0, WHOLE).astype(np.uint16)
    beside, above = wide * pixel_mm[0], high * pixel_mm[1]
    size = laid.width_mm + 2 * beside, laid.height_mm + 2 * above
    return Bitmap(whole, (-beside, -above), *size)


def _blurred_pixels(laid: Bitmap, image: Image) -> Bitmap:
    """Blur the pixels of an image as ImageMagick does, by whose values OpenLatero shows it.

    A Gauss that ends at twice its deviation is sampled at thirds of a pixel, along and then down,
    where the outermost pixels go on beyond the edges. What is less than an 8-bit step falls away,
    of opacity as of what is transparent.
    """
    with needing_extras():
        from scipy.ndimage import convolve1d
    sigma = round(image.blur_mm / math.sqrt(math.prod(pixel_size_mm(laid))), 3)
    width = 2 * math.ceil(2 * sigma) + 1
    thirds = np.arange(3 * width) - (3 * width - 1) / 2
    weights = np.exp(-0.5 * (thirds / (3 * sigma)) ** 2).reshape(width, 3).sum(axis=1)
    weights /= weights.sum()
    made = laid.intensities.astype(np.float64)
    for axis in (1, 0):
        made = np.rint(convolve1d(made, weights, axis=axis, mode="nearest"))
    step = WHOLE // 255
    levels = np.ceil(made / step) if image.channel == "alpha" else np.floor(made / step)
    return replace(laid, intensities=(levels * step).astype(np.uint16))


class _Dot(NamedTuple):
    center_mm: Point
    radius_mm: float
    amplitude: float


def dots_of(pattern: ImageDots, folder: Path) -> AnyPattern:
    """Dots of an image.

    Without a grid of cells, pixels above the threshold that touch, also at a corner, are a blob.
    Its dot stands at its centre of mass, by gray, and is as high as its brightest pixel.

    Parameters
    ----------
    pattern
        Image, and how its dots look. The amplitude of that counts together with the gray.
    folder
        Folder from which the name of its file is seen.

    Returns
    -------
    Dots or Group
        The dots; a group, by the maximum, if not all look the same.

    Raises
    ------
    InputError
        If the file cannot be read, nothing in it is above the threshold, there are more than
        20,000 dots, or one is farther away than 10 m.
    """
    read = _read(pattern, folder, MOST_PER_MM)
    try:
        dots = _blobs(pattern, read) if pattern.cell_mm is None else _cells(pattern, read)
        if not dots:
            raise ValueError(
                "no dot: nothing in its image is above the threshold of "
                f"{pattern.threshold:g}; make that smaller"
            )
        return _drawn(pattern, dots)
    except ValueError as error:
        raise InputError(f"{_named(pattern)} has {error}") from None


def _blobs(pattern: ImageDots, read: Bitmap) -> list[_Dot]:
    """Find a dot for each connected set of pixels above the threshold."""
    with needing_extras():
        from scipy import ndimage
    gray, (wide, high) = read.intensities, pixel_size_mm(read)
    labeled: Any = ndimage.label(gray > pattern.threshold * WHOLE, np.ones((3, 3)))
    labels, count = labeled  # a pair unless the labels are to be written elsewhere
    _check_count(count, "blobs")
    numbers = np.arange(1, count + 1)
    centers: Any = ndimage.center_of_mass(gray.astype(np.float64), labels, numbers)
    largest = ndimage.maximum(gray, labels, numbers) if count else ()
    areas = np.bincount(labels.ravel(), minlength=count + 1)[1:] * wide * high
    left, top = pattern.place_mm
    return [
        _Dot(
            (left + (column + 0.5) * wide, top + (row + 0.5) * high),
            math.sqrt(area / math.pi) if pattern.by_area else pattern.dot.radius_mm,
            float(high_gray) / WHOLE,
        )
        for (row, column), area, high_gray in zip(centers, areas, largest, strict=True)
    ]


def _cells(pattern: ImageDots, read: Bitmap) -> list[_Dot]:
    """Find a dot for each cell of a grid whose mean gray is above the threshold."""
    from PIL import Image as Pillow

    wide, high = pattern.cell_mm or (0.0, 0.0)
    # Whole cells only, as in the source: 113 by 60 mm have 94 by 33.
    columns, rows = int(read.width_mm / wide + 1e-9), int(read.height_mm / high + 1e-9)
    if not columns or not rows:
        raise ValueError("an image smaller than a cell; make the cells smaller")
    _check_count(columns * rows, "cells")
    pixel_mm = pixel_size_mm(read)
    covered = (0.0, 0.0, columns * wide / pixel_mm[0], rows * high / pixel_mm[1])
    means = Pillow.fromarray(read.intensities.astype(np.float32)).resize(
        (columns, rows), Pillow.Resampling.BOX, box=covered
    )
    left, top = pattern.place_mm
    radius = min(pattern.dot.radius_mm, wide / 2, high / 2)
    return [
        _Dot((left + (column + 0.5) * wide, top + (row + 0.5) * high), radius, mean / WHOLE)
        for row, line in enumerate(np.asarray(means).tolist())
        for column, mean in enumerate(line)
        if mean > pattern.threshold * WHOLE
    ]


def _check_count(count: int, what: str) -> None:
    if count > MOST_DOTS:
        raise ValueError(
            f"{count} {what}, and no more than {MOST_DOTS} can be dots; take a simpler image"
        )


def _drawn(pattern: ImageDots, dots: list[_Dot]) -> AnyPattern:
    """Draw dots, those that look the same as one pattern."""
    alike: dict[Point, list[Point]] = defaultdict(list)
    for dot in dots:
        radius, level = round(dot.radius_mm / _RADIUS_MM), round(dot.amplitude * _LEVELS)
        alike[radius, level].append(dot.center_mm)
    own = {name: getattr(pattern, name) for name in Pattern.__struct_fields__}
    parts = [
        Dots(
            centers_mm=tuple(centers),
            dot=msgspec.structs.replace(
                pattern.dot,
                radius_mm=max(radius * _RADIUS_MM, _LEAST_RADIUS_MM),
                amplitude=pattern.dot.amplitude * level / _LEVELS,
            ),
        )
        for (radius, level), centers in sorted(alike.items())
    ]
    if len(parts) == 1:
        return msgspec.structs.replace(parts[0], **own)
    return Group(operation="maximum", parts=tuple(parts), **own)
