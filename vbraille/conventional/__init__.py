"""Conventional braille displays, whose pins rise and fall: a line of cells beside the virtual one.

`ConventionalDisplay` is one, driven by a process of its own, which is told what stands on it and
tells which of its keys were pressed; nobody ever waits for it. What drives it is a `CellDriver`:
any display that BRLTTY knows, through its library (`vbraille.conventional.brlapi`), a Dot Pad
(`vbraille.conventional.dotpad`), or a display with USB's own protocol for braille
(`vbraille.conventional.hid`). The last two were never tried on hardware.
"""
