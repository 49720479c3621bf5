"""The command ``vbraille``: parse, build, call, print.

A command's module is imported only when the command is called.
"""

from __future__ import annotations

import atexit
import errno
import os
import sys
from contextlib import ExitStack, suppress
from importlib import import_module
from io import BufferedWriter, FileIO, RawIOBase, TextIOWrapper

from vbraille.errors import VbrailleError, needing_extras
from vbraille.signals import EAR, EXIT_CODE, SAID, Stopped
from vbraille.wording import printable, spelled

TYPE_CHECKING = False  # importing typing, for its constant, takes as long as all the rest
if TYPE_CHECKING:
    from argparse import Namespace
    from collections.abc import Sequence

    from vbraille.engine.spawning import Spawned
    from vbraille.simulation.steering import Pointer, Steering


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command, and give its exit code.

    0 is done, 1 a fault at run time or a signal, 2 something that cannot be used.
    Afterwards signals are ignored: the program is at its end.
    """
    try:
        sentence, code = _listen(argv)
    except (KeyboardInterrupt, Stopped):
        sentence, code = SAID, EXIT_CODE
    if sentence:
        with suppress(OSError):
            print(f"vbraille: {printable(' '.join(sentence.split()))}", file=sys.stderr)
    # numba begins colorama where an environment has it, which would end the output by an escape.
    if (colors := sys.modules.get("colorama.initialise")) is not None:
        atexit.unregister(colors.reset_all)
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except OSError:
            if stream is sys.stdout:
                code = code or EXIT_CODE
            with suppress(OSError):  # Python must not try again at exit, and give a code of its own
                os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
    return code


def _listen(argv: Sequence[str] | None) -> tuple[str, int]:
    """Run a command until it ends or a signal stops it."""
    try:
        EAR.listen()
        _hold_descriptors()
        _set_streams()
        sentence, code = _run(argv)
    finally:
        EAR.close()
    return (SAID, EXIT_CODE) if EAR.heard and code else (sentence, code)


def _hold_descriptors() -> None:
    """Open what is nothing on the standard descriptors that are closed, for child processes too.

    Whatever opens next would stand there otherwise: memory that is passed on to a child, which has
    its pipes in that place, or a book that messages are written into.
    """
    for descriptor in range(3):
        try:
            os.fstat(descriptor)
        except OSError:
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)  # the lowest that is free


def _set_streams() -> None:
    """Have all three streams; those of output take any text, lone surrogates and all."""
    # None stands for a stream that the caller closed. No reader is left for stderr, but a caller
    # who closed the output has lost what was asked for.
    if sys.stdin is None:
        sys.stdin = os.fdopen(0, closefd=False)
    if sys.stdout is None:
        sys.stdout = TextIOWrapper(BufferedWriter(_Closed()))
    if sys.stderr is None:
        sys.stderr = TextIOWrapper(FileIO(os.devnull, "w"))
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")


class _Closed(RawIOBase):
    """An output that is closed: the first writing says so, and later ones go nowhere."""

    def __init__(self) -> None:
        self._said = False

    def writable(self) -> bool:
        """Say yes, so that the fault comes when something is written."""
        return True

    def write(self, content) -> int:
        """Refuse the first time."""
        if not self._said:
            self._said = True
            raise OSError(errno.EBADF, "the output is closed; give it a file, or /dev/null")
        return len(content)


def _run(argv: Sequence[str] | None) -> tuple[str, int]:
    """Run a command; give a sentence on its failure, and its exit code."""
    try:
        with needing_extras():
            code = _call(argv)
        sys.stdout.flush()
    except BrokenPipeError:  # the program that read our output has enough: no sentence
        return "", EXIT_CODE
    except VbrailleError as error:
        return spelled(str(error)), error.exit_code
    except OSError as error:
        return error.strerror or str(error), 1
    except Exception as error:
        from vbraille.logs import print_traceback

        print_traceback(error)
        what = f"{type(error).__name__}: {error}"
        return f"a fault of vbraille's own, which its authors want to hear of: {what}", 1
    return "", code


def _call(argv: Sequence[str] | None) -> int:
    with EAR.at_once():
        from vbraille.cli.parser import parse, read_instead
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
        with EAR.at_once():
            command = import_module(f"vbraille.cli.commands.{arguments.command}")
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
