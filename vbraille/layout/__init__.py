"""Cells on a virtual page: lines of any width, and files of them."""

from vbraille.layout.layout import Layout, cells_per_line, lay_out_text, wrap_text
from vbraille.layout.lines import Line

__all__ = ["Layout", "Line", "cells_per_line", "lay_out_text", "wrap_text"]
