"""Big texts, made with a seed of the project's own passages."""

from __future__ import annotations

import random
from typing import TYPE_CHECKING

from tests.conftest import SEED, TEXTS

if TYPE_CHECKING:
    from pathlib import Path


def big_text(path: Path, size: int) -> Path:
    """Write about so many bytes of English paragraphs."""
    paragraphs = (TEXTS / "english.txt").read_text().strip().split("\n\n")
    draw = random.Random(SEED)
    written = 0
    with path.open("w") as file:
        while written < size:
            written += file.write(f"{draw.choice(paragraphs)}\n\n")
    return path
