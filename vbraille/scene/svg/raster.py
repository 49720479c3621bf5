"""Drawings in SVG as images, by resvg, in a process of its own that ends if it takes too much.

A drawing may tell a renderer to do work without end, with filters, masks in masks or markers on
markers. What counts is not what stands in the file, so only a limit of time and memory helps.
"""

from __future__ import annotations

import subprocess
import sys
from importlib.util import find_spec
from typing import TYPE_CHECKING

from vbraille.errors import InputError, VbrailleError, lacking
from vbraille.scene.svg.document import PX_MM, link_of, name_of, read_tree, view_box_of
from vbraille.scene.svg.drawing import SvgDrawing

if TYPE_CHECKING:
    from pathlib import Path

    from vbraille.scene.svg.document import Element

MOST_S = 10
_MOST_BYTES = 2 << 30
# Widths and heights of drawings are exact to this share of them.
_STEPS = 1_000_000
# What could look up something else, holds a picture of its own, or depends on the machine's fonts.
_LEFT_OUT = frozenset(("image", "feImage", "script", "foreignObject", "text"))
_CHILD = """
import resource, sys
seconds, memory = map(int, sys.argv[1:])
resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
import resvg_py
text = sys.stdin.buffer.read().decode()
png = resvg_py.svg_to_bytes(svg_string=text, skip_system_fonts=True, dpi=96)
sys.stdout.buffer.write(bytes(png))
"""


class RasterDrawing:
    """An SVG file that is to be drawn as pixels.

    Texts are left out, since they would depend on the fonts of the machine and cannot be felt, and
    so are images within it.

    Attributes
    ----------
    size_mm : tuple of float
        Width and height, which an SVG file has itself.
    columns, rows : int
        Width and height in fine steps.

    Raises
    ------
    InputError
        If the file is none that `read_tree` reads, or has no size.
    """

    def __init__(self, path: Path) -> None:
        self._path, self._root = path, read_tree(path)
        width, height = self._size = SvgDrawing(str(path), self._root, {}).size_px
        self.size_mm = (width * PX_MM, height * PX_MM)
        fine = _STEPS / max(width, height)
        self.columns, self.rows = max(round(width * fine), 1), max(round(height * fine), 1)

    def png(self, columns: int, rows: int) -> bytes:
        """Draw it as a PNG file, clear where nothing is drawn.

        Raises
        ------
        InputError
            If it cannot be drawn, takes longer than 10 s, or resvg-py is not installed.
        VbrailleError
            If no process can be started.
        """
        root, (width, height) = self._root, self._size
        _make_plain(root)
        if view_box_of(root.get("viewBox")) is None:
            root.set("viewBox", f"0 0 {width!r} {height!r}")
        root.set("preserveAspectRatio", "none")
        root.set("width", str(columns))
        root.set("height", str(rows))
        return _drawn(root, self._path)


def _make_plain(root: Element) -> None:
    """Take out of a drawing what is not to be drawn."""
    for element in list(root.iter()):
        outside = name_of(element) == "use" and not link_of(element).startswith("#")
        parent = element.getparent()
        if parent is not None and (outside or name_of(element) in _LEFT_OUT):
            parent.remove(element)


def _drawn(root: Element, path: Path) -> bytes:
    from lxml import etree

    if find_spec("resvg_py") is None:
        raise InputError(f"{path} is an SVG, and to be an image {lacking('resvg_py')}")
    limits = str(MOST_S), str(_MOST_BYTES)
    try:
        done = subprocess.run(
            [sys.executable, "-I", "-c", _CHILD, *limits],
            input=etree.tostring(root, encoding="utf-8"),
            capture_output=True,
            timeout=6 * MOST_S,  # the machine may be busy
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise InputError(f"{path} takes longer than {MOST_S} s to draw; simplify it") from None
    except OSError as error:
        raise VbrailleError(f"{path} cannot be drawn: {error.strerror}") from None
    if done.returncode < 0:  # it was ended at a limit
        raise InputError(
            f"{path} takes longer than {MOST_S} s or more memory than it may; simplify it"
        )
    if done.returncode or not done.stdout:
        said = done.stderr.decode("utf-8", "replace").strip().rpartition("\n")[2]
        plain = "".join(c if c.isprintable() else " " for c in said.partition(": ")[2] or said)
        raise InputError(f"{path} cannot be drawn as an image: {plain[:120]}; simplify it")
    return done.stdout
