"""Sizes of the pictures that OpenLatero's files name."""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass
from io import BytesIO
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError
from vbraille.scene.filebytes import read_bytes
from vbraille.scene.imagefiles import KINDS, MOST_PIXELS

if TYPE_CHECKING:
    from pathlib import Path

_MOST_BYTES, _MOST_SVG_BYTES = 100 << 20, 10 << 20
_LENGTH = re.compile(r"\s*([0-9.]+(?:[eE][+-]?\d+)?)\s*(px|pt|pc|mm|cm|in)?\s*")
_INCH = 96.0  # pixels
_PIXELS = {
    "px": 1.0,
    "": 1.0,
    "pt": _INCH / 72,
    "pc": _INCH / 6,
    "mm": _INCH / 25.4,
    "cm": _INCH / 2.54,
    "in": _INCH,
}


@dataclass(frozen=True, slots=True)
class Picture:
    """What a picture is, without its pixels.

    Parameters
    ----------
    width_px, height_px
        Its size in pixels; of a drawing, as it is rasterised at 96 per inch.
    is_coloured, has_alpha
        Whether it has colours, and whether some of it is transparent.
    """

    width_px: float
    height_px: float
    is_coloured: bool
    has_alpha: bool


def measure(path: Path) -> Picture:
    """Find the size of a picture.

    Raises
    ------
    InputError
        If it cannot be read, is far too large, or is no picture.
    """
    if path.suffix.lower() == ".svg":
        return _drawn(path)
    content = read_bytes(path, _MOST_BYTES)
    from PIL import Image

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            image = Image.open(BytesIO(content), formats=KINDS)
            width, height = image.size
            if width * height > MOST_PIXELS:
                raise InputError(f"{path} has {width} × {height} pixels, which are too many")
            return Picture(width, height, _is_coloured(image), _has_alpha(image))
    except InputError:
        raise
    # Readers of damaged files raise nearly everything, and Pillow promises no fewer kinds.
    except Exception:
        raise InputError(f"{path} is damaged, or no picture") from None


def _is_coloured(image: Any) -> bool:
    from PIL import ImageChops

    if image.mode in ("1", "L", "LA", "I", "F") or image.mode.startswith("I;16"):
        return False
    red, green, blue = image.convert("RGB").split()
    return any(ImageChops.difference(red, other).getbbox() for other in (green, blue))


def _has_alpha(image: Any) -> bool:
    """Whether a picture has an alpha channel of which something is not opaque."""
    if image.mode not in ("RGBA", "LA", "PA") and "transparency" not in image.info:
        return False
    low, _ = image.convert("RGBA").getchannel(3).getextrema()
    return low < 255


def _drawn(path: Path) -> Picture:
    """Size of a drawing."""
    from lxml import etree

    content = read_bytes(path, _MOST_SVG_BYTES)
    parser = etree.XMLParser(
        resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False, recover=True
    )
    try:
        root: Any = etree.fromstring(content, parser)
    except (etree.XMLSyntaxError, ValueError):
        root = None
    if root is None or not str(root.tag).endswith("svg"):
        raise InputError(f"{path} is no SVG file")
    box = [float(part) for part in re.findall(r"[-+0-9.eE]+", root.get("viewBox", ""))[:4]]
    seen = box[2:] if len(box) == 4 else [100.0, 100.0]
    sizes = [
        _pixels(root.get(name)) or fallback
        for name, fallback in zip(("width", "height"), seen, strict=True)
    ]
    if min(sizes) <= 0 or max(sizes) > 1e6:
        raise InputError(f"{path} is a drawing without a size")
    return Picture(sizes[0], sizes[1], is_coloured=True, has_alpha=True)


def _pixels(text: str | None) -> float | None:
    found = _LENGTH.fullmatch(text or "")
    return float(found[1]) * _PIXELS[found[2] or ""] if found else None
