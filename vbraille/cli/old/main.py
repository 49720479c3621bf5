"""The command ``vbraille``: parse, build, call, print.

A command's module is imported only when the command is called.
"""

from __future__ import annotations

from contextlib import ExitStack, nullcontext
from importlib import import_module

TYPE_CHECKING = False  # importing typing, for its constant, takes as long as all the rest
if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.simulation.steering import Pointer


def call(argv: Sequence[str] | None) -> int:
    """Run a command, and give its exit code."""
    with nullcontext():
        from vbraille.cli.old.parser import parse, read_instead
    try:
        arguments = parse(argv)
        if arguments.command == "books" and arguments.number is not None and not arguments.forget:
            arguments = read_instead(arguments)
    except SystemExit:  # --help and --version have been printed
        return 0
    if arguments.log is not None or arguments.verbose:
        from vbraille.logs import keep, want_tracebacks

        if arguments.log is not None:
            keep(arguments.log)
        if arguments.verbose:
            want_tracebacks()
    with ExitStack() as begun:
        if arguments.command in ("read", "feel", "play", "tune"):
            # A hand on a picture may stand still, and waits for a person.
            pointed = arguments.monitor or arguments.command == "feel"
            arguments.pointer = _pointer() if pointed else None
            arguments.begun = None
        elif arguments.command == "session" and arguments.action in ("run", "resume"):
            arguments.begun = None
        if (host := getattr(arguments, "begun", None)) is not None:
            begun.callback(host[0].end)
        with nullcontext():
            command = import_module(f"vbraille.cli.old.commands.{arguments.command}")
        return command.run(arguments)


def _pointer() -> Pointer:
    """Make what a page of the live view may hold a simulated hand by."""
    from vbraille.simulation.steering import Pointer

    return Pointer()
