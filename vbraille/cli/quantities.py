"""Counts and durations as a person would say them."""

from __future__ import annotations


def count(number: int, noun: str) -> str:
    """A number with its noun: "1 line", "0 lines", "2 lines"."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def duration(seconds: float) -> str:
    """About how long, in seconds, minutes or hours: "9 s", "12 min", "3.5 h"."""
    if seconds < 99.5:
        return f"{seconds:.0f} s"
    if seconds < 99.5 * 60:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.3g} h"
