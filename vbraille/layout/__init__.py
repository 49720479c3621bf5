"""Cells on a virtual page: lines of any width, and files of them."""

from vbraille.layout.lines import Layout, Line, wrap_text

__all__ = ["Layout", "Line", "wrap_text"]
