"""Look of all figures, and their files: the same figure gives the same bytes."""

from __future__ import annotations

import io
import warnings
from contextlib import contextmanager
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape

from matplotlib import style

from vbraille.pictures.words import plain

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.figure import Figure

# No date, no version and no reader's own matplotlibrc: the same table gives the same bytes.
_METADATA = {
    "png": {"Software": "vbraille"},
    "svg": {"Creator": "vbraille", "Date": None},
    "pdf": {"Creator": "vbraille", "Producer": "vbraille", "CreationDate": None},
}
_STYLE = {
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlesize": "medium",
    "figure.constrained_layout.use": True,
    "figure.labelsize": "medium",
    "figure.titlesize": "large",
    "font.sans-serif": ["DejaVu Sans"],  # an SVG names all at each text
    "font.size": 11,
    "lines.linewidth": 1.4,
    "pdf.fonttype": 42,  # letters stay letters
    "svg.fonttype": "none",  # text stays text, for search and screen readers
    "svg.hashsalt": "vbraille",
    "text.parse_math": False,  # a dollar in a name is a dollar
}
FAINT, MIDDLE = "0.8", "0.45"


@contextmanager
def styled() -> Iterator[None]:
    """Let figures be made and written in the style that all of them share."""
    with style.context(["default", _STYLE]), warnings.catch_warnings():
        # A name in a script that the font has not: SVG keeps it, PNG shows boxes.
        warnings.filterwarnings("ignore", r"Glyph .* missing from font", UserWarning)
        yield


def to_bytes(
    figure: Figure, kind: str, title: str, description: str = "", dpi: float = 150
) -> bytes:
    """Make the content of a figure's file, with its title and description in it.

    Parameters
    ----------
    figure
        The figure.
    kind
        Kind of the file: png, svg or pdf.
    title, description
        What it shows, in a word and in sentences; in an SVG screen readers say them.
    dpi
        Resolution of a PNG, in dots per inch.
    """
    title, description = plain(title), plain(description)
    about = "Subject" if kind == "pdf" else "Description"
    told = {key: text for key, text in (("Title", title), (about, description)) if text.strip()}
    file = io.BytesIO()
    with styled():
        figure.savefig(file, format=kind, dpi=dpi, metadata={**told, **_METADATA[kind]})
    content = file.getvalue()
    if kind != "svg":
        return content
    words = (
        f' role="img" aria-labelledby="title description">\n <title id="title">{escape(title)}'
        f'</title>\n <desc id="description">{escape(description)}</desc>'
    )
    end = content.index(b">", content.index(b"<svg "))
    return content[:end] + words.encode() + content[end + 1 :]
