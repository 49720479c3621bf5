"""Colours of SVG, as far as they tell which texture a surface has."""

from __future__ import annotations

import colorsys
import re

_HEX = re.compile(r"#([0-9a-f]{3,4}|[0-9a-f]{6}|[0-9a-f]{8})")
_FUNCTION = re.compile(r"rgba?\(([^()]*)\)|hsla?\(([^()]*)\)")
_SPLIT = re.compile(r"[\s,/]+")

Color = tuple[float, float, float]


def color_of(text: str) -> Color | None:
    """Red, green and blue of a colour, each from 0 to 1; None if it is not understood.

    >>> color_of("#f00"), color_of("rgb(100%, 0, 127.5)"), color_of("url(#wood)")
    ((1.0, 0.0, 0.0), (1.0, 0.0, 0.5), None)
    """
    text = text.strip().lower()
    if found := _HEX.fullmatch(text):
        digits = found[1]
        if len(digits) < 6:
            digits = "".join(2 * digit for digit in digits)
        red, green, blue = (int(digits[at : at + 2], 16) / 255 for at in (0, 2, 4))
        return red, green, blue
    if found := _FUNCTION.fullmatch(text):
        return _of_function(_SPLIT.split((found[1] or found[2]).strip()), hues=found[1] is None)
    return _named(text)


def _of_function(parts: list[str], *, hues: bool) -> Color | None:
    """Colour of the numbers in the brackets of rgb() or hsl()."""
    try:
        numbers = [float(part.rstrip("%").removesuffix("deg")) for part in parts[:3]]
    except ValueError:
        return None
    if len(numbers) < 3:
        return None
    if hues:
        hue, saturation, lightness = numbers
        return colorsys.hls_to_rgb(
            hue / 360 % 1.0, _share(lightness / 100), _share(saturation / 100)
        )
    wholes = [100 if part.endswith("%") else 255 for part in parts[:3]]
    red, green, blue = (_share(n / whole) for n, whole in zip(numbers, wholes, strict=True))
    return red, green, blue


def _share(value: float) -> float:
    return min(max(value, 0.0), 1.0)


def _named(name: str) -> Color | None:
    """Colour of one of the names of CSS."""
    from PIL import ImageColor

    if name not in ImageColor.colormap:
        return None
    red, green, blue = (of / 255 for of in ImageColor.getrgb(name)[:3])
    return red, green, blue


def darkness(color: Color) -> float:
    """How dark a colour is, from 0, white, to 1, black, by luminance (ITU-R 601)."""
    red, green, blue = color
    return 1.0 - (0.299 * red + 0.587 * green + 0.114 * blue)


def hue_of(color: Color) -> str:
    """Hue of a colour in a word.

    >>> hue_of((0.0, 0.0, 1.0)), hue_of((0.2, 0.2, 0.25)), hue_of((1.0, 1.0, 0.95))
    ('blue', 'gray', 'white')
    """
    lightest, darkest = max(color), min(color)
    if darkness(color) < 0.08 and lightest - darkest < 0.2:
        return "white"
    if lightest - darkest < 0.12:
        return "gray"
    hue = 360 * colorsys.rgb_to_hsv(*color)[0]
    for end, name in ((20, "red"), (70, "yellow"), (170, "green"), (260, "blue"), (330, "purple")):
        if hue < end:
            return name
    return "red"
