"""What the thesis has published, and where each number comes from: Lévesque 2009, chapters 3 and 4.

`published.json` tells it of each; the names of the tests repeat it. What is exact was printed so;
what is reconstructed follows from the print arithmetically; what is inferred is the most
plausible, and not certain.
"""

import json
from pathlib import Path

import pytest

EXACT, RECONSTRUCTED, INFERRED = "exact", "reconstructed", "inferred"
EXACT_SPLIT = "exact_split"  # the digits are the print's, and were split by hand
TOLD = json.loads((Path(__file__).parent / "published.json").read_text(encoding="utf-8"))


def each(*cases):
    """Parametrise by provenance, name and values: the ids tell them in ``pytest -v``."""
    return pytest.mark.parametrize(
        "told", [pytest.param(tuple(values), id=f"{tag} {name}") for tag, name, *values in cases]
    )


def printed(values, decimals=1):
    """As the thesis has them."""
    return [None if value is None else f"{value:.{decimals}f}" for value in values]
