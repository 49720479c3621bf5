"""Packages that come with an extra of vbraille, and the sentence for one that is not installed."""

from __future__ import annotations

from contextlib import contextmanager

from vbraille.errors import InputError

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from collections.abc import Iterator

# Extras of pyproject.toml by the modules that they bring; scipy comes with two of them.
EXTRAS = {
    "contourpy": "pictures",
    "joblib": "analysis",
    "matplotlib": "pictures",
    "pandas": "analysis",
    "resvg_py": "pictures",
    "scipy": "all",
    "sounddevice": "sound",
}


@contextmanager
def needing_extras() -> Iterator[None]:
    """Raise InputError, which says how to install it, for a module of an extra that is missing."""
    try:
        yield
    except ModuleNotFoundError as error:
        name = (error.name or "").partition(".")[0]
        if name not in EXTRAS:
            raise
        raise InputError(f"this {lacking(name)}") from None


def lacking(name: str) -> str:
    """Say that a module of an extra is needed, and what installs it."""
    return (
        f"needs {name}, which is not installed: `make setup` installs it in a checkout, "
        f"and `pip install 'vbraille[{EXTRAS[name]}]'` elsewhere"
    )
