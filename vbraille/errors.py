"""Everything that vbraille tells a user it cannot do.

The message is one sentence that says what to do. `main` prints it on stderr
and leaves with ``exit_code``; a traceback reaches nobody.
"""


class VbrailleError(Exception):
    """A fault at run time: a device, a disk, a library."""

    exit_code = 1


class InputError(VbrailleError):
    """The user gave something that cannot be used."""

    exit_code = 2


class DeviceError(VbrailleError):
    """A device did not do what it was asked, or was asked what it must not do."""


def check_range(what: str, value: float | None, low: float, high: float, unit: str = "") -> None:
    """Check that a number is in a range; None passes.

    Raises
    ------
    ValueError
        If it is not in the range, or is no number; the message names the value and the range.

    >>> check_range("gap", 61.0, 0, 60, " s")
    Traceback (most recent call last):
    ValueError: gap is 61 s; it must be 0 to 60 s
    """
    if value is not None and not low <= value <= high:
        raise ValueError(f"{what} is {value:g}{unit}; it must be {low:g} to {high:g}{unit}")
