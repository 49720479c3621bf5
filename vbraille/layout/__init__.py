"""Cells on a virtual page: lines of any width, and files of them."""

from vbraille.layout.lines import Layout, Line, cells_per_line, lay_out_text, wrap_text
from vbraille.translate.book import Remarks

__all__ = [
    "Layout",
    "Line",
    "Remarks",
    "cells_per_line",
    "lay_out_text",
    "wrap_text",
]
