"""The bank of textures that comes with the program: those that the source's author published.

`textures.toml` has them; a scene uses each by its name after ``stock:``.
"""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING

from vbraille.scene.patterns import AnyPattern
from vbraille.toml import TomlFile

if TYPE_CHECKING:
    from collections.abc import Mapping

STOCK = "stock:"  # what the names of the bank's textures begin with


def stock_text() -> str:
    """Text of the file that has the bank, to be read and copied."""
    return files(__name__).joinpath("textures.toml").read_text("utf-8")


@cache
def stock_textures() -> Mapping[str, AnyPattern]:
    """Textures of the bank, by their names without ``stock:``."""
    file = TomlFile(stock_text(), "textures.toml")
    return {
        name: file.read(AnyPattern, under=("textures", name))  # pyright: ignore[reportArgumentType]
        for name in file.names("textures")
    }
