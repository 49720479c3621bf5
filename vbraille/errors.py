"""Everything that vbraille tells a user it cannot do, a package of an extra that is missing too.

The message is one sentence that says what to do. `main` prints it on stderr
and leaves with ``exit_code``; no user sees a traceback.
"""

from __future__ import annotations

from contextlib import contextmanager

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from collections.abc import Iterator


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
    try:
        if value is None or low <= value <= high:
            return
        shown = f"{value:g}"
    except (TypeError, ValueError):  # no number at all
        shown = f"{value!r:.40}, not a number"
    raise ValueError(f"{what} is {shown}{unit}; it must be {low:g} to {high:g}{unit}")


# Extras of pyproject.toml by the modules that they bring; two modules come with two of them.
EXTRAS = {
    "contourpy": "pictures",
    "joblib": "analysis",
    "matplotlib": "all",
    "pandas": "analysis",
    "resvg_py": "pictures",
    "scipy": "all",
    "sounddevice": "sound",
}


# Modules of Python that a system other than Linux may not have.
_OF_THE_SYSTEM = ("fcntl", "pty", "resource", "termios", "tty")


@contextmanager
def needing_extras() -> Iterator[None]:
    """Raise an error of one sentence for a module that is missing.

    Raises
    ------
    InputError
        If an extra brings it; the sentence says how to install it.
    VbrailleError
        If the system has none.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        name = (error.name or "").partition(".")[0]
        if name in _OF_THE_SYSTEM:
            raise VbrailleError(only_linux(name)) from None
        if name not in EXTRAS:
            raise
        raise InputError(f"this {lacking(name)}") from None


def only_linux(name: str) -> str:
    """Say that the system has no such thing, and what works without."""
    return (
        f"this needs Linux: the system has no {name}, by which devices are driven; "
        f"page, structure, render, map, scene, analyse and import vbraille work without"
    )


def lacking(name: str) -> str:
    """Say that a module of an extra is needed, and what installs it."""
    return (
        f"needs {name}, which is not installed: `make setup` installs it in a checkout, "
        f"and `pip install 'vbraille[{EXTRAS[name]}]'` elsewhere"
    )
