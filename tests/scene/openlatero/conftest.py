"""Files of OpenLatero's, written and read."""

import pytest

from tests.scene.openlatero.files import scene
from vbraille.scene.openlatero import read_gen


@pytest.fixture
def read(tmp_path):
    def reader(*patterns, as_shown=False, name="old.gen", **settings):
        text = patterns[0] if patterns[0].startswith(("<?xml", "<l", "<s")) else None
        path = tmp_path / name
        path.write_text(text or scene(*patterns, **settings), encoding="utf-8")
        return read_gen(path, as_shown=as_shown)

    return reader
