"""Braille on pages: blocks of cells wrapped into lines."""
