"""Tactile pictures as values: what there is to draw, and the files that describe it.

Nothing here knows an array, a device or the time; `vbraille.render.scene` compiles a scene for a
display.
"""
