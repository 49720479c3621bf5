"""A text and tables that several tests of lines need."""

import pytest

from vbraille.translate import BrailleTable


@pytest.fixture(scope="module")
def english(texts) -> str:
    return (texts / "english.txt").read_text()


@pytest.fixture(scope="module")
def table() -> BrailleTable:
    return BrailleTable("en-ueb-g2.ctb")


@pytest.fixture(scope="module")
def letters() -> BrailleTable:
    return BrailleTable("fr-bfu-comp6.utb")
