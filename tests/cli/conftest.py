"""The program called here, or in a process of its own, with a text to read."""

from dataclasses import dataclass

import pytest

from tests.calling import as_before
from vbraille.cli.app import main

TEXT = "one two three\n\nfour five six\n\nseven eight nine\n"


@dataclass(frozen=True)
class Done:
    """What a run left behind."""

    code: int
    out: str
    err: str


@pytest.fixture
def call(capsys):
    """Call the program's `main` with arguments; this process stays as it was."""

    def call_main(*arguments):
        capsys.readouterr()
        with as_before():
            code = main([str(argument) for argument in arguments])
        said = capsys.readouterr()
        return Done(code, said.out, said.err)

    return call_main


@pytest.fixture
def text(tmp_path):
    """A file of three lines."""
    path = tmp_path / "text.txt"
    path.write_text(TEXT)
    return path
