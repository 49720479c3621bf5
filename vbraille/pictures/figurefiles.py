"""Look of all figures, and their files: the same figure gives the same bytes."""

from __future__ import annotations

import io
import re
import warnings
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import rc_context, style

from vbraille.errors import InputError
from vbraille.files import whole_file

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from matplotlib.figure import Figure

# No date, no version and no reader's own matplotlibrc: the same table gives the same bytes.
METADATA = {
    "png": {"Software": "vbraille"},
    "svg": {"Creator": "vbraille", "Date": None},
    "pdf": {"Creator": "vbraille", "Producer": "vbraille", "CreationDate": None},
}
STYLE = {
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlesize": "medium",
    "figure.constrained_layout.use": True,
    "figure.labelsize": "medium",
    "figure.titlesize": "large",
    "font.sans-serif": ["DejaVu Sans"],  # an SVG names all at each text
    "font.size": 11,
    "hatch.linewidth": 0.7,
    "lines.linewidth": 1.4,
    "pdf.fonttype": 42,  # letters stay letters
    "svg.fonttype": "none",  # text stays text, for search and screen readers
    "svg.hashsalt": "vbraille",
    "text.parse_math": False,  # a dollar in a name is a dollar
}
FAINT, MIDDLE = "0.8", "0.45"
DPI = 150
# Where an SVG has its places; no text is in these, as a "<" in a text is escaped.
_PLACES = re.compile(rb"<(?:path|use|text) [^>]*>")
_NEEDLESS = re.compile(rb"(?<=\.\d\d)\d+| transform=\"rotate\(-0 [^)]*\)\"")


@contextmanager
def styled() -> Iterator[None]:
    """Let figures be made and written in the style that all of them share."""
    with style.context(["default", STYLE]), warnings.catch_warnings():
        # A name in a script that the font has not: SVG keeps it, PNG shows boxes.
        warnings.filterwarnings("ignore", r"Glyph .* missing from font", UserWarning)
        yield


def to_bytes(
    figure: Figure, kind: str, dpi: float = DPI, told: Mapping[str, str] | None = None
) -> bytes:
    """Make the content of a figure's file.

    Parameters
    ----------
    kind
        What the file is, a key of `METADATA`: png, svg or pdf.
    dpi
        Resolution of a PNG, in dots per inch.
    told
        What the file says of itself, by the keywords of its kind; the figure's title if not given.
    """
    content = io.BytesIO()
    # A figure that is laid out already would be so again, and come out otherwise.
    with styled(), rc_context({"figure.constrained_layout.use": False}):
        told = {"Title": figure.get_suptitle().replace("\n", " ")} if told is None else told
        metadata = {**told, **METADATA[kind]}
        if kind == "png":
            _write_png(figure, content, dpi, metadata)
        else:
            figure.savefig(content, format=kind, dpi=dpi, metadata=metadata)
    if kind == "svg":
        # Hundredths of a point will do: that is half as much to load.
        return _PLACES.sub(lambda tag: _shortened(tag[0]), content.getvalue())
    return content.getvalue()


def _shortened(tag: bytes) -> bytes:
    """Leave out of a tag what no eye sees, some lines at a time: an outline may have millions."""
    parts: list[bytes] = []
    first = 0
    while first < len(tag):
        end = tag.find(b"\n", first + 100_000) + 1 or len(tag)
        parts.append(_NEEDLESS.sub(b"", tag[first:end]))
        first = end
    return b"".join(parts)


def _write_png(figure: Figure, content: io.BytesIO, dpi: float, metadata: dict[str, str]) -> None:
    """Write a PNG; one of greys alone has a byte a pixel, and takes a quarter of the time."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from PIL import Image
    from PIL.PngImagePlugin import PngInfo

    usual = figure.dpi
    figure.dpi = dpi
    try:
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        pixels = np.asarray(canvas.buffer_rgba())
    finally:
        figure.dpi = usual
    grey = pixels[..., 0]
    if (pixels[..., 3] == 255).all() and all((grey == pixels[..., at]).all() for at in (1, 2)):
        pixels = grey
    told = PngInfo()
    for key, value in metadata.items():
        told.add_text(key, value)
    Image.fromarray(pixels).save(content, "png", dpi=(dpi, dpi), pnginfo=told)


def save(figure: Figure, path: str | Path) -> None:
    """Write a figure as PNG or SVG, as the path's suffix says; a whole file or none.

    Raises
    ------
    InputError
        If the suffix is another one, or the file cannot be written.
    """
    path = Path(path)
    kind = path.suffix.lower()[1:]
    if kind not in ("png", "svg"):
        raise InputError(f"cannot draw to {path}: end its name in .png or .svg")
    content = to_bytes(figure, kind)
    try:
        with whole_file(path, replace=True) as partial:
            partial.write_bytes(content)
    except OSError as error:
        raise InputError(
            f"cannot write {path} ({error.strerror}): name a file in a folder that you can write to"
        ) from error
