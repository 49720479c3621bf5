"""The program: its commands, and how it ends.

A refusal ends it with exit code 2, a fault or a signal with 1, each with one sentence on standard
error. A command's module is loaded when the command is called.
"""

from __future__ import annotations

import errno
import os
import sys
from contextlib import suppress
from importlib import import_module
from inspect import cleandoc
from io import TextIOWrapper

import click

from vbraille.cli.options import Group
from vbraille.cli.settings import origin
from vbraille.errors import VbrailleError, needing_extras
from vbraille.signals import EAR, EXIT_CODE, SAID, Stopped
from vbraille.version import __version__
from vbraille.wording import printable, spelled

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence

# The help of each command, in the sections and in the order of the program's help.
SECTIONS = {
    "Reading": {
        "read": "Read a text on a device, line after line.",
        "books": "List the books you have read, or go on with one.",
        "keys": "List the keys for reading.",
        "settings": "Print each setting, and where it comes from.",
        "tune": "Find how braille feels best, two ways at a time.",
        "structure": "Print the outline of a book.",
        "tables": "List braille tables.",
    },
    "Pictures": {
        "feel": "Feel a tactile picture on a device.",
        "screen": "Feel what a screen reader shows, by BRLTTY.",
        "play": "Play memory with tactile cards.",
        "map": "Draw a tactile picture for the eye or for paper.",
        "scene": "Check or convert tactile pictures.",
    },
    "Pages, frames and drawings": {
        "page": "Print the braille of a text, or write it to a file.",
        "render": "Write the frames of a reading to an HDF5 file.",
        "plot": "Draw what a display does, or print its numbers.",
        "monitor": "Play back a recording or a session in a browser.",
    },
    "Devices": {
        "device": "List, check or calibrate devices.",
        "simulate": "Simulate a device.",
    },
    "Experiments": {
        "session": "Plan, run and export legibility sessions.",
        "analyse": "Analyse sessions: tables, statistics, a report.",
        "power": "Estimate the power of a study by simulation.",
        "pilot": "Try a whole study with the simulated reader.",
    },
    "Shell": {
        "setup": "Compile what drives the actuators.",
        "completion": "Print the shell completion script.",
    },
}
HELP = {name: text for commands in SECTIONS.values() for name, text in commands.items()}


class Program(Group):
    """The group of all commands, which are loaded late."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002 - click's signature
        """Names of the commands, in the order of help."""
        return list(HELP)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002
        """Load a command."""
        if cmd_name not in HELP:
            return None
        command = import_module(f"vbraille.cli.commands.{cmd_name}").command
        command.name, more = cmd_name, cleandoc(command.help or "")
        if not more.startswith(HELP[cmd_name]):
            command.help = f"{HELP[cmd_name]}\n\n{more}".strip()
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002
        """Write the commands in their sections."""
        width = max(map(len, HELP))
        for section, commands in SECTIONS.items():
            with formatter.section(section):
                formatter.write_dl([(name.ljust(width), text) for name, text in commands.items()])


@click.group(
    cls=Program,
    context_settings={
        "auto_envvar_prefix": "VBRAILLE",
        "help_option_names": ["-h", "--help"],
        "max_content_width": 100,
    },
    epilog="Example: vbraille read book.txt. vbraille COMMAND --help says more of each.",
)
@click.version_option(__version__, "-V", "--version", message="vbraille %(version)s")
def app() -> None:
    """Read braille under one fingertip, on a page as large as you like."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command, and return its exit code: 0, 1 for a fault or a signal, 2 for a refusal.

    Afterwards signals are ignored: the program is at its end.
    """
    arguments = list(sys.argv[1:] if arguments is None else arguments)
    if arguments[:1] == ["help"]:
        arguments = [*arguments[1:], "--help"]
    try:
        try:
            EAR.listen()
            _open_streams()
            sentence, code = _run(arguments)
        finally:
            EAR.close()
        if EAR.heard and code:
            sentence, code = SAID, EXIT_CODE
    except (KeyboardInterrupt, Stopped):
        sentence, code = SAID, EXIT_CODE
    if sentence:
        with suppress(OSError):
            print(f"vbraille: {printable(' '.join(sentence.split()))}", file=sys.stderr)
    return _flush() or code


def _run(arguments: list[str]) -> tuple[str, int]:
    """Run a command; a sentence on what went wrong, and the exit code."""
    try:
        with needing_extras():
            code = app.main(arguments, prog_name="vbraille", standalone_mode=False)
        sys.stdout.flush()
        return "", code if isinstance(code, int) else 0
    except SystemExit as end:  # of completion
        return "", int(end.code or 0)
    except click.exceptions.NoArgsIsHelpError as error:
        click.echo(error.format_message(), err=True)
        return "", 2
    except click.Abort:
        return SAID, EXIT_CODE
    except click.ClickException as error:
        return spelled(_sentence(error)), 2
    except VbrailleError as error:
        return spelled(str(error)), error.exit_code
    except BrokenPipeError:  # the program that read our output has enough
        return "", EXIT_CODE
    except OSError as error:
        if error.errno == errno.EBADF:
            return "the output is closed; give it a file, or /dev/null", 1
        return error.strerror or str(error), 1
    except Exception as error:
        from vbraille.logs import print_traceback

        print_traceback(error)
        what = f"{type(error).__name__}: {error}"
        return f"internal error, please report it: {what}; VBRAILLE_TRACEBACK=1 shows more", 1


def _sentence(error: click.ClickException) -> str:
    """One line on a refusal by click; a value that was not typed is named with its origin."""
    message = " ".join(error.format_message().split()).rstrip(".")
    if message[:2] != message[:2].upper():  # an acronym stays
        message = message[:1].lower() + message[1:]
    context = error.ctx if isinstance(error, click.UsageError) else None
    if isinstance(error, click.BadParameter) and context and error.param:
        place = origin(context, error.param)
        return f"{place}: {message}" if place else message
    if isinstance(error, click.NoSuchOption):
        near = f"; did you mean {' or '.join(error.possibilities)}?" if error.possibilities else ""
        message = f"unknown option {error.option_name}{near}"
        if not near and context:
            message += f"; {context.command_path} --help-all lists the options"
    return message


def _open_streams() -> None:
    """Have all three streams, also where the caller closed one; text of any kind can be written.

    The null device stands on a closed descriptor: a file that is opened next would stand there
    otherwise, and messages would go into it. What is written to a closed output fails.
    """
    for descriptor, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            access = os.O_RDONLY if name == "stdout" else os.O_RDWR
            os.set_inheritable(os.open(os.devnull, access), True)  # the lowest that is free
            setattr(sys, name, os.fdopen(descriptor, "w" if descriptor else "r", closefd=False))
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")


def _flush() -> int:
    """Flush the streams; an exit code if that fails for the output."""
    # numba begins colorama where an environment has it, which would end the output by an escape.
    if (colors := sys.modules.get("colorama.initialise")) is not None:
        import atexit

        atexit.unregister(colors.reset_all)
    code = 0
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except OSError:
            if stream is sys.stdout:
                code = EXIT_CODE
            with suppress(OSError):  # Python must not try again at exit, and give a code of its own
                os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
    return code
