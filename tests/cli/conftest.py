"""The program called here, or in a process of its own, with a text to read."""

import signal
import sys
from dataclasses import dataclass

import pytest

from vbraille.cli.main import main
from vbraille.signals import SIGNALS

TEXT = "one two three\n\nfour five six\n\nseven eight nine\n"


@dataclass(frozen=True)
class Done:
    """What a run left behind."""

    code: int
    out: str
    err: str


@pytest.fixture
def call(capsys):
    """Call the program's `main` with arguments; this process's signals stay as they were."""

    def call_main(*arguments):
        handlers = {number: signal.getsignal(number) for number in (*SIGNALS, signal.SIGALRM)}
        hook = sys.unraisablehook
        capsys.readouterr()
        try:
            code = main([str(argument) for argument in arguments])
        finally:
            sys.unraisablehook = hook
            for number, handler in handlers.items():
                signal.signal(number, handler)
        said = capsys.readouterr()
        return Done(code, said.out, said.err)

    return call_main


@pytest.fixture
def text(tmp_path):
    """A file of three lines."""
    path = tmp_path / "text.txt"
    path.write_text(TEXT)
    return path
