"""Cells on a virtual page: lines of any width, and files of them."""

from vbraille.layout.lines import Layout, Line, cells_per_line, wrap_text

__all__ = ["Layout", "Line", "cells_per_line", "wrap_text"]
