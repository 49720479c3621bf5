"""Braille under one fingertip, by lateral skin deformation.

``translate`` makes braille cells of a text, ``page`` lays them out on a
surface, ``render`` turns a place on it into deflections, ``devices`` and
``engine`` bring those to a fingertip. Importing this package loads none of
them.
"""

__version__ = "0.1.0"
