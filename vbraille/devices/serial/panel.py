"""Buttons and knobs of a device, by what its STATEs say of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from vbraille.devices.events import Button, Knob
from vbraille.devices.wire.messages import KNOB_STEP, KNOB_TOP

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.devices.wire.messages import State

_BITS: Final = 8  # of a knob's position


class Panel:
    """Buttons and knobs as they were when they were last told.

    Attributes
    ----------
    buttons_fitted, knobs_fitted : int
        Number of buttons and of knobs that the device says it has; bits and bytes of others are not
        read.
    buttons : int or None
        Bits of the buttons that are pressed; None before the first STATE of all, and of a device
        that was unplugged.
    knobs : int or None
        Positions of the knobs when they were last told, a byte each; None before the first STATE
        of all.
    """

    def __init__(self) -> None:
        self.buttons_fitted = self.knobs_fitted = 0
        self.buttons: int | None = None
        self.knobs: int | None = None

    def fit(self, buttons: int, knobs: int) -> None:
        """Take so many buttons and knobs to be there."""
        self.buttons_fitted, self.knobs_fitted = buttons, knobs

    def take(self, state: State, now_ns: int) -> Iterator[Button | Knob]:
        """Tell what has changed by a new STATE; the first of all changes nothing."""
        yield from self._press(state.buttons, now_ns)
        yield from self._turn(state.knobs)

    def let_go(self, now_ns: int) -> Iterator[Button]:
        """Tell the buttons that were pressed: nobody holds those of a device that is not there."""
        if self.buttons:
            yield from self._press(0, now_ns)
        self.buttons = None

    def _press(self, told: int, now_ns: int) -> Iterator[Button]:
        before, self.buttons = self.buttons, told & ((1 << self.buttons_fitted) - 1)
        changed = 0 if before is None else before ^ self.buttons
        for bit in range(self.buttons_fitted if changed else 0):
            if changed >> bit & 1:
                yield Button(bit + 1, pressed=bool(self.buttons >> bit & 1), at_ns=now_ns)

    def _turn(self, told: int) -> Iterator[Knob]:
        if self.knobs is None:
            self.knobs = told
        if told == self.knobs:
            return
        for knob in range(self.knobs_fitted):
            shift = knob * _BITS
            before, now = self.knobs >> shift & KNOB_TOP, told >> shift & KNOB_TOP
            if turned(before, now):
                self.knobs += (now - before) << shift
                yield Knob(knob + 1, now / KNOB_TOP)


def turned(before: int, now: int) -> bool:
    """Whether a knob was turned between two of its positions, and does not just jitter.

    Its ends are told however little is left to them: a knob can be turned as far as it goes.
    """
    return abs(now - before) >= KNOB_STEP or (now != before and now in (0, KNOB_TOP))
