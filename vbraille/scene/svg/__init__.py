"""Drawings in SVG as tactile pictures: what drawing programs write, as patterns.

Nothing of a drawing is run, and nothing that it refers to is looked up.
"""
