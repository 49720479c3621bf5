"""Braille under one fingertip, by lateral skin deformation.

``translate`` makes braille cells of a text, ``page`` lays them out on a
surface, ``render`` turns a place on it into deflections, ``devices`` and
``engine`` bring those to a fingertip. Importing this package loads none of
them.
"""

from vbraille.version import __version__

__all__ = ["__version__"]
