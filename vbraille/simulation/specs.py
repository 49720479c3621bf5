"""Simulated devices and their hands by their specs, as options and devices name them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any
from urllib.parse import urlencode

from vbraille.errors import InputError
from vbraille.simulation.hand import DEVICE, FLUENT, HumanHand, Still, Sweep
from vbraille.wording import setting

if TYPE_CHECKING:
    from vbraille.simulation.hand import Hand

HABITS = {"slow": DEVICE, "device": DEVICE, "fluent": FLUENT}
STILL = "still"  # name of the hand that only moves in the live view


def parse_hand(spec: str, seed: int = 1, *, pointed: bool = False) -> Hand:
    """Return the hand that a spec describes.

    Parameters
    ----------
    spec
        ``sweep:SPEED`` in mm/s, ``slow`` (or ``device``), ``fluent``, ``recorded:FILE``,
        ``wide``, ``wide:SPACING``, ``spot:X,Y`` in mm, or ``still``.
    seed
        Seed of a hand that is drawn at random.
    pointed
        Whether a person can move the hand in the live view, without which none may be still.

    Raises
    ------
    InputError
        If there is no such hand, a number is out of range, or the file cannot be used.
    """
    kind, _, rest = spec.partition(":")
    numbers = [_number(text) for text in rest.split(",")] if rest else []
    if spec == STILL and pointed:
        return Still()
    if spec == STILL:
        raise InputError(
            f"a still hand moves only in the live view; add {setting('monitor')} where there is "
            f"that option, or give another hand"
        )
    try:
        if spec in HABITS:
            return HumanHand(HABITS[spec], seed)
        if kind == "sweep":
            return Sweep(_number(rest))
        if kind == "recorded" and rest:
            from vbraille.simulation.recorded import load_recorded

            return load_recorded(rest)
        if kind in ("wide", "spot"):
            from vbraille.simulation.exploring import Spot, Wide

            if kind == "wide" and len(numbers) < 2:
                return Wide(*numbers)
            if kind == "spot" and len(numbers) in (0, 2):
                return Spot((numbers[0], numbers[1]) if numbers else None)
            raise InputError(f"the hand is {spec!r}; write wide:SPACING or spot:X,Y, in mm")
    except ValueError as error:
        raise InputError(str(error)) from None
    raise InputError(
        f"unknown hand {spec!r}; give sweep:SPEED in mm/s, slow, fluent or recorded:FILE, "
        f"or wide or spot:X,Y to go over a picture"
    )


def _number(text: str) -> Any:
    """Number that a text is, or the text, which the hand refuses."""
    try:
        return float(text)
    except ValueError:
        return text


def is_simulated(device: str) -> bool:
    """Tell whether a spec is that of the simulated device, which follows the settings."""
    return device.rstrip(":") == "sim"


def refuse_hand(device: str, **given: object) -> None:
    """Raise InputError if settings of the simulated hand are given for another device.

    Parameters
    ----------
    device
        The spec of the device.
    given
        Values of the settings by their names; None where they were not given.
    """
    for name, value in given.items():
        if value is not None and not is_simulated(device):
            raise InputError(
                f"{setting(name)} is for the simulated device, and {device} is moved by a person; "
                f"leave {setting(name)} out, or leave {setting('device')} out"
            )


def device_spec(device: str, hand: str | None, seed: int) -> str:
    """Spec of a device; that of the simulated one has its hand added."""
    if not is_simulated(device) or hand is None:
        return device
    return f"sim:?{urlencode({'hand': hand, 'seed': seed})}"
