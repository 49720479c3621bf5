"""What the statistics are held against."""

import importlib

import pytest

from tests.untraced import untraced


@pytest.fixture(scope="session")
def pingouin():
    """Pingouin, which takes seconds to load: only where it is asked for."""
    with untraced():
        return importlib.import_module("pingouin")
