"""Cells on a virtual page: lines of any width, and files of them."""

from vbraille.layout.layout import Layout, cells_per_line, lay_out_text, wrap_text
from vbraille.layout.lines import Line
from vbraille.translate.book import Remarks

__all__ = ["Layout", "Line", "Remarks", "cells_per_line", "lay_out_text", "wrap_text"]
