"""Conventional braille displays, whose pins rise and fall: a line of cells beside the virtual one.

`ConventionalDisplay` is one that BRLTTY drives. A thread of its own speaks with BRLTTY, through its
library; it is told what stands on the display.
"""
