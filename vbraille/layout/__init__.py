"""Braille on pages: paragraphs of cells wrapped into lines."""
