"""Whether somebody sits at a desktop, who would see a browser that opens."""

from __future__ import annotations

import os
import sys
from contextlib import suppress


def has_desktop() -> bool:
    """Whether somebody sits here who would see a browser that opens."""
    desktop = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    with suppress(OSError, ValueError, AttributeError):  # there may be no standard input
        return bool(desktop) and sys.stdin.isatty()
    return False
