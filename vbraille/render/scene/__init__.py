"""Scenes, compiled for a display; `vbraille.scene` has the values that they are made of."""
