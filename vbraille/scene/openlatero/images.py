"""Images of OpenLatero's files: pictures as masks of textures, and where they stand."""

from __future__ import annotations

import math
import re
import warnings
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.scene.filebytes import read_bytes
from vbraille.scene.imagefiles import KINDS, MOST_PIXELS
from vbraille.scene.measures import MOST_MM
from vbraille.scene.openlatero.context import SURFACE_MM, Kinds
from vbraille.scene.openlatero.elements import OFF, ON, NumberField, PlaceField, cleaned
from vbraille.scene.patterns import Group, Image
from vbraille.scene.svg.values import Units
from vbraille.scene.textures import Uniform
from vbraille.sounds import check_sound

if TYPE_CHECKING:
    from vbraille.scene.measures import Point
    from vbraille.scene.openlatero.context import GenContext
    from vbraille.scene.openlatero.elements import GenElement
    from vbraille.scene.patterns import AnyPattern

ROWS = Kinds()
_MOST_BYTES, _MOST_SVG_BYTES = 100 << 20, 10 << 20


@dataclass(frozen=True, slots=True)
class MaskPicture:
    """Facts of a picture, without its pixels.

    Parameters
    ----------
    width_px, height_px
        Size in pixels; of a drawing, as it is rasterised at 96 per inch.
    is_coloured, has_alpha
        Whether it has colours, and whether some of it is transparent.
    """

    width_px: float
    height_px: float
    is_coloured: bool
    has_alpha: bool


def measure(path: Path) -> MaskPicture:
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
            return MaskPicture(width, height, _is_coloured(image), _has_alpha(image))
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
    """Tell whether a picture has an alpha channel of which something is not opaque."""
    if image.mode not in ("RGBA", "LA", "PA") and "transparency" not in image.info:
        return False
    low, _ = image.convert("RGBA").getchannel(3).getextrema()
    return low < 255


def _drawn(path: Path) -> MaskPicture:
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
        Units().length(root.get(name), 0.0) or fallback
        for name, fallback in zip(("width", "height"), seen, strict=True)
    ]
    if min(sizes) <= 0 or max(sizes) > 1e6:
        raise InputError(f"{path} is a drawing without a size")
    return MaskPicture(sizes[0], sizes[1], is_coloured=True, has_alpha=True)


_BLUR_PIXELS = 2.0  # standard deviation; it ends at 4 pixels there
_LEAST_SIZE_MM = 0.1
_EVEN = 0.01  # share by which pixels may be longer than they are wide


MASK = {
    "reference_maximized": ON,
    "blur": OFF,
    "default_alpha": NumberField(0.0, 0.0, 1.0, "share"),
}


@ROWS.row("Image")
def _image(element: GenElement, context: GenContext) -> AnyPattern | None:
    part = element.one("Pattern")
    mask = element.part("mask", MASK)
    if part is None:
        element.forget()
        element.say("it has no texture, and OpenLatero ends at it; left out")
        return None
    texture = context.pattern(part)
    if texture is None:
        mask.forget()
        element.say("there is nothing of its texture to show; left out")
        return None
    if part.attribute("type") != "Texture":
        kind = part.attribute("type")
        if context.as_shown:
            mask.forget()
            element.say(f"it is the mask of a {kind}, which OpenLatero does not show; left out")
            return None
        element.say(f"it is the mask of a {kind}, as the file says; OpenLatero does not show it")
    masked = _masked(mask, context)
    if masked is None:
        return None
    if not context.as_shown:
        mask.say("between pixels it is bilinear here, and the nearest pixel counts there")
    return replace(masked, texture=None if texture == Uniform() else texture)


@ROWS.row("Audio")
def _audio(element: GenElement, context: GenContext) -> AnyPattern | None:
    """Masks that are not felt, each with the sound of those that are in it."""
    found: list[AnyPattern] = []
    for sound in element.every("sound"):
        file, mask = sound.one("audiofile"), sound.part("mask", MASK)
        name = "" if file is None else cleaned(file.text)
        try:
            if not name:
                raise InputError("its sound is not named")
            check_sound(context.folder / name)
        except InputError as error:
            mask.forget()
            sound.say(f"{_in(context.folder, error)}; left out")
            continue
        masked = _masked(mask, context)
        if masked is not None:
            found.append(replace(masked, amplitude=0.0, sound=name, title=Path(name).stem))
    return Group(operation="maximum", parts=tuple(found)) if found else None


def _masked(mask: GenElement, context: GenContext) -> Image | None:
    """Picture of a mask where it is; None if there is none."""
    file = mask.one("imgfile")
    found = None if file is None else _found(file, context)
    if file is None or found is None:
        mask.forget()
        if file is None:
            mask.say("its picture is not named; left out")
        return None
    name, picture = found
    width, height = _size(mask, picture)
    place = _place(mask, width, height)
    channel = "alpha" if file.attribute("type") == "alpha" else "gray"
    blur = _blur(mask, picture, width, height, context)
    if context.as_shown and name.lower().endswith(".svg"):
        file.say("its drawing becomes pixels here by other ways than there")
    _say_channel(file, picture, channel)
    return Image(
        file=name,
        place_mm=(_plain(place[0]), _plain(place[1])),
        width_mm=_plain(width),
        height_mm=_plain(height),
        channel=channel,
        blur_mm=_plain(blur),
        outside=mask["default_alpha"],
        nearest=context.as_shown,
    )


def _plain(value_mm: float) -> float:
    """Length to the nanometre, since people read it."""
    return round(value_mm, 6)


def _found(file: GenElement, context: GenContext) -> tuple[str, MaskPicture] | None:
    """Picture that an element names, by its name as it is seen from the file."""
    name = cleaned(file.text)
    # OpenLatero itself writes "/mask.png" for a picture that stands beside the scene.
    beside = name.rpartition("/")[2]
    path = context.folder / name
    try:
        moved = not path.is_file() and name == f"/{beside}" and (context.folder / beside).is_file()
        if moved and not context.as_shown:
            file.say(f"{name} is not there, and {beside} beside this file is taken")
            path, name = context.folder / beside, beside
        picture = measure(path)
    except InputError as error:
        file.say(f"its picture is left out: {_in(context.folder, error)}")
        return None
    except (OSError, ValueError):
        file.say("its picture has no name that a file can have; left out")
        return None
    return name, picture


def _in(folder: Path, error: InputError) -> str:
    """Message about a picture, with its name as it is seen from the file."""
    return str(error).replace(f"{folder}/", "") if str(folder) != "." else str(error)


def _size(mask: GenElement, picture: MaskPicture) -> tuple[float, float]:
    """Width and height of an image on the surface, in mm."""
    mask.skip("lock_aspect_ratio")  # what the program keeps while the user changes the size
    # The largest size that fits on the surface in the picture's shape.
    wide = SURFACE_MM[0] / SURFACE_MM[1] > picture.width_px / picture.height_px
    ratio = picture.width_px / picture.height_px
    largest = (SURFACE_MM[1] * ratio, SURFACE_MM[1]) if wide else (
        SURFACE_MM[0], SURFACE_MM[0] / ratio
    )  # fmt: skip
    whole = largest if mask["reference_maximized"] else SURFACE_MM
    width, height = (
        _extent(mask, name, fitting, reference)
        for name, fitting, reference in zip(("width", "height"), largest, whole, strict=True)
    )
    return width, height


def _extent(mask: GenElement, name: str, fitting: float, reference: float) -> float:
    element = mask.one(name)
    if element is None:
        return fitting
    if element.units() == "%":
        share = NumberField(1.0, _LEAST_SIZE_MM / reference, MOST_MM / reference, "share")
        return share.read(element) * reference
    return NumberField(fitting, _LEAST_SIZE_MM).read(element)


def _place(mask: GenElement, width: float, height: float) -> Point:
    """Top left corner of an image."""
    element = mask.one("position")
    middle = ((SURFACE_MM[0] - width) / 2, (SURFACE_MM[1] - height) / 2)
    if element is None or element.text.strip() == "centered":
        return middle
    return PlaceField(middle).read(element)


def _blur(
    mask: GenElement, picture: MaskPicture, width: float, height: float, context: GenContext
) -> float:
    """Standard deviation of the blur of an image as it is placed, in mm."""
    if not mask["blur"]:
        return 0.0
    pixel = width / picture.width_px, height / picture.height_px
    if context.as_shown:
        return _BLUR_PIXELS * math.sqrt(pixel[0] * pixel[1])
    if abs(pixel[0] / pixel[1] - 1.0) > _EVEN:
        mask.say("its pixels are longer than wide; it is blurred alike both ways here")
    mask.say("its blur is of 2 pixels of the picture, as mm here, and does not end at 4 pixels")
    return _BLUR_PIXELS * math.sqrt(pixel[0] * pixel[1])


def _say_channel(file: GenElement, picture: MaskPicture, channel: str) -> None:
    """Say so if a picture's intensities are others there."""
    if channel == "gray" and picture.is_coloured:
        file.say("its picture has colours: their luminance counts here, and their red there")
    if channel == "gray" and picture.has_alpha:
        file.say("what is transparent in its picture is down here, and its gray counts there")
    if channel == "alpha" and not picture.has_alpha:
        raise ValueError("imgfile has no alpha, which is to be its mask")
