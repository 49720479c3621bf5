"""The command ``vbraille``: parse, build, call, print.

A command's module is imported only when the command is called.
"""

from __future__ import annotations

import os
from contextlib import ExitStack, nullcontext
from importlib import import_module

TYPE_CHECKING = False  # importing typing, for its constant, takes as long as all the rest
if TYPE_CHECKING:
    from argparse import Namespace
    from collections.abc import Sequence

    from vbraille.engine.spawning import Spawned
    from vbraille.simulation.steering import Pointer, Steering


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
            # A game compiles all its cards first.
            begins = arguments.command != "play" and _may_begin(arguments)
            arguments.begun = _begin_host(arguments.pointer) if begins else None
        elif arguments.command == "session" and arguments.action in ("run", "resume"):
            arguments.begun = _begin_host() if _session_may_begin(arguments) else None
        if (host := getattr(arguments, "begun", None)) is not None:
            begun.callback(host[0].end)
        with nullcontext():
            command = import_module(f"vbraille.cli.old.commands.{arguments.command}")
        return command.run(arguments)


def _pointer() -> Pointer:
    """Make what a page of the live view may hold a simulated hand by."""
    from vbraille.simulation.steering import Pointer

    return Pointer()


def _may_begin(arguments: Namespace) -> bool:
    """Tell if all that is asked for may be there; a table and the like are looked at later."""
    file, device = arguments.file, arguments.device
    if file not in (None, "-") and not os.path.isfile(file):  # noqa: PTH113 - pathlib loads long
        return False
    if any(getattr(arguments, name, None) is not None for name in ("table", "language", "grade")):
        return False
    return device is None or _may_be_there(device)


def _session_may_begin(arguments: Namespace) -> bool:
    """Tell if a session may go by the clock on a device that may be there."""
    device, fast = arguments.device, arguments.fast
    if arguments.action == "resume":
        import json

        try:
            with open(os.path.join(arguments.folder, "session.json"), "rb") as file:  # noqa: PTH118, PTH123
                head = json.load(file)
            fast = fast or (arguments.answers in (None, head["answers"]) and head["fast"])
            device = device or head["device"]
        except (OSError, ValueError, KeyError, TypeError):
            return False  # the command says what is wrong
    # A page that is the hand, too, needs memory of its own, which the session makes.
    return not (fast or arguments.monitor) and (device is None or _may_be_there(device))


def _may_be_there(device: str) -> bool:
    """Tell if there is a driver of a device's kind."""
    if device == "sim":
        return True
    from importlib.metadata import entry_points

    return bool(entry_points(group="vbraille.devices", name=device.partition(":")[0]))


def _begin_host(pointer: Pointer | None = None) -> tuple[Spawned, Steering]:
    """Begin the process that drives the device, which loads while all else is opened."""
    from vbraille.engine.spawning import spawn
    from vbraille.simulation.steering import Steering

    steering = Steering()
    pointed = () if pointer is None else (pointer.descriptor,)
    return spawn((steering.descriptor, *pointed)), steering
