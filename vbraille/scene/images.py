"""Images of a scene as bitmaps: placed, averaged, blurred: Lévesque 2009, 8.4.2."""

from __future__ import annotations

import math
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.errors import InputError, needing_extras
from vbraille.scene.bitmap import WHOLE, Bitmap, pixel_size_mm
from vbraille.scene.imagefiles import intensities_of
from vbraille.scene.patterns import Image
from vbraille.scene.traversal import each

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from vbraille.scene.patterns import ImageDots
    from vbraille.scene.scene import Scene

# The source asks for 5 to 10 pixels per mm; more than the larger is averaged away.
MOST_PER_MM = 10.0
# A Gauss of more pixels is as smooth with fewer (bilinear between them: within 0.002), and the
# time that a blur takes grows with them.
_WIDEST_BLUR = 5.0  # pixels
_BLUR_REACH = 4.0  # standard deviations
MOST_PIXELS = 16_000_000  # of a bitmap; larger images have fewer per mm
MOST_TOGETHER = 64_000_000  # of a scene's bitmaps


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
                        f"{named(image)}: the images of the scene have more than "
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


def named(image: Image | ImageDots) -> str:
    """Name of an element with an image file, for messages."""
    return f"element {image.id}" if image.id else f"image {image.file}"


@contextmanager
def naming(image: Image | ImageDots) -> Iterator[None]:
    """Put the name of an element before what is said of its file."""
    try:
        yield
    except InputError as error:
        message = str(error)
        if message.startswith(named(image)):
            raise
        raise InputError(f"{named(image)}: {message}") from None


def size_mm(
    image: Image | ImageDots, columns: int, rows: int, own_mm: tuple[float, float] | None = None
) -> tuple[float, float]:
    """Width and height of an image on the canvas.

    If one is not given, it follows from the shape of the image's pixels; if neither is, they are
    those that a drawing has itself.

    Raises
    ------
    InputError
        If neither is given nor known, or what follows is below 0.1 mm or above 10 m.
    """
    width, height = image.width_mm, image.height_mm
    if width is None and height is None and own_mm is not None:
        width, height = own_mm
    if width is None and height is None:
        raise InputError(f"{named(image)} has no size; give width_mm or height_mm")
    if width is None:
        width = (height or 0.0) * columns / rows
    if height is None:
        height = width * rows / columns
    for what, value in (("width", width), ("height", height)):
        if not 0.1 <= value <= 10_000.0:
            raise InputError(
                f"{named(image)} would have a {what} of {value:g} mm by the picture's shape; "
                "give both width_mm and height_mm"
            )
    return width, height


def shape_of(width_mm: float, height_mm: float, per_mm: float) -> tuple[int, int]:
    """Columns and rows of a bitmap at a density in pixels per mm, or fewer if it is vast."""
    most = math.sqrt(MOST_PIXELS / (width_mm * height_mm))
    per_mm = min(per_mm, most)
    # A band of 10 m by 0.1 mm has a row, too.
    return max(int(width_mm * per_mm), 1), max(int(height_mm * per_mm), 1)


def _laid(image: Image, folder: Path) -> Bitmap:
    """Bitmap of an image at the origin, which its blur makes larger."""
    size = (0.0, 0.0)
    # Whose own pixels count has all of them.
    per_mm = math.inf if image.nearest else MOST_PER_MM
    if image.blur_mm and not image.nearest:
        per_mm = min(per_mm, _WIDEST_BLUR / image.blur_mm)

    def shape(columns: int, rows: int, own: tuple[float, float] | None) -> tuple[int, int]:
        nonlocal size
        size = size_mm(image, columns, rows, own)
        if image.blur_mm > min(size):
            raise InputError(
                f"{named(image)} has a blur of {image.blur_mm:g} mm, which is more than its width "
                "or height; make it smaller"
            )
        most_columns, most_rows = shape_of(*size, per_mm)
        return min(columns, most_columns), min(rows, most_rows)

    with naming(image):
        intensities = intensities_of(Path(folder, image.file), image.channel, shape)
    if image.inverted_source:
        intensities = WHOLE - intensities
    laid = Bitmap(intensities, (0.0, 0.0), *size)
    if not image.blur_mm:
        return laid
    return _blurred_pixels(laid, image) if image.nearest else _blurred(laid, image)


def _blurred(laid: Bitmap, image: Image) -> Bitmap:
    """Blur an image, which then reaches farther."""
    import numpy as np

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
    import numpy as np

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
