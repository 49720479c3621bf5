"""The command ``vbraille``: parse, build, call, print.

A command's module is imported only when the command is called.
"""

from __future__ import annotations

import os
import signal
import sys
from importlib import import_module
from io import TextIOWrapper

from vbraille.errors import VbrailleError

TYPE_CHECKING = False  # importing typing, for its constant, takes as long as all the rest
if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import FrameType
    from typing import NoReturn


class _Terminated(BaseException):
    """Somebody ended the program by a signal."""


def _terminate(_signal: int, _frame: FrameType | None) -> NoReturn:
    raise _Terminated


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command; its exit code.

    0 is done, 1 a fault at run time or a signal, 2 something that cannot be used.
    """
    try:
        for number in (signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, _terminate)
        # Lone surrogates and such of a text must not stop its printing.
        for stream in (sys.stdout, sys.stderr):
            if isinstance(stream, TextIOWrapper):
                stream.reconfigure(encoding="utf-8", errors="backslashreplace")
        from vbraille.cli.parser import parse

        arguments = parse(argv)
        code = import_module(f"vbraille.cli.{arguments.command}").run(arguments)
        sys.stdout.flush()
    except BrokenPipeError:
        # Whoever read our output has enough; Python must not try again at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except VbrailleError as error:
        return _fail(str(error), error.exit_code)
    except (KeyboardInterrupt, _Terminated):
        return _fail("stopped", 1)
    except OSError as error:
        return _fail(error.strerror or str(error), 1)
    except Exception as error:
        if os.environ.get("VBRAILLE_TRACEBACK"):
            raise
        what = f"{type(error).__name__}: {error}"
        return _fail(f"a fault of vbraille's own, which its authors want to hear of: {what}", 1)
    return code


def _fail(sentence: str, code: int) -> int:
    print(f"vbraille: {' '.join(sentence.split())}", file=sys.stderr)
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return code
