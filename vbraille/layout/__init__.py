"""Cells on a virtual page: lines of any width, and files of them."""

from vbraille.layout.lines import Layout, Line, wrap

__all__ = ["Layout", "Line", "wrap"]
