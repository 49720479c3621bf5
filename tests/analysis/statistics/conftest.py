"""What the statistics are held against."""

import importlib

import pytest


@pytest.fixture(scope="session")
def pingouin():
    """Pingouin, which takes seconds to load: only where it is asked for."""
    return importlib.import_module("pingouin")
