"""A folder with a book in it."""

import pytest

from tests.reading.places.shelved import TEXT


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "book.txt").write_text(TEXT)
    return tmp_path
