"""Drawings in SVG as scenes: files, values and styles, outlines, and the walk through them."""
