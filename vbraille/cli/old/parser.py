"""The parser of the command line, its help and its refusals, made of the table of commands."""

from __future__ import annotations

import argparse
import os
import sys

from vbraille.cli.old.commandtable import ACTIONS, COMMANDS, GROUPS
from vbraille.config.option import PROFILE, Argument, Option
from vbraille.config.options import ADDRESS, COMMON, OPTIONS
from vbraille.config.readers import number, whole
from vbraille.errors import InputError
from vbraille.version import __version__
from vbraille.wording import nearest, setting

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from typing import NoReturn

    from vbraille.cli.old.commandtable import CommandRow, Row


class _Help(argparse.HelpFormatter):
    """Help without a look at the terminal, which would load half the standard library."""

    def __init__(self, prog: str) -> None:
        columns = os.environ.get("COLUMNS", "")
        super().__init__(prog, width=int(columns) - 2 if columns.isdecimal() else 78)

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        """Wrap all but examples, which are copied from here."""
        return text if text.startswith("example:") else super()._fill_text(text, width, indent)


_READERS = {int: whole, float: number}
# Commands and options that there were, and what does the same; those that other commands still have
# stand with the command.
_GONE = {
    "profile": "vbraille scene cost says what a frame of a picture costs",
    "plot profile": "vbraille plot deflection draws how far an actuator leans",
    "feel --at": "--y chooses the height of the line that is felt",
    "render --at": "the place is in the hand's name: --hand spot:X,Y",
    "scene cost --at": "the place is in the hand's name: --hand spot:X,Y",
    "--path": "--hand wide, --hand spot:X,Y or --hand recorded:FILE.csv goes over a picture",
    "--spacing": "the distance of turns is in the hand's name: --hand wide:SPACING",
    "--sound": "--cues tones, bell or none chooses how signals are heard",
    "map --axes": "--rulers draws rulers in mm",
    "simulate --port": "--udp-port is where a simulated Latero listens",
    "simulate --lines": "--page-lines has a hand read so many lines of a page",
    "simulate --foreign": "--stray sends a stranger's datagrams",
    "--cues sound": "--cues tones plays them through the loudspeakers",
    "--plain": "progress is lines, at a terminal or with --verbose",
    "--play": "give the recording by itself, as in vbraille monitor reading.h5",
    "--abstract": "--outline draws what is felt",
    "--raised": "--outline draws what is felt, black on white, for swell paper",
    "--sheet": "print an --outline without scaling",
    "--layout": "--cells 40 --format pef makes pages; file2brl lays out for embossers",
    "--skin": "the simulated reader has one model of the skin",
    "--key": "pseudonyms are codes already; pandas puts others in their place",
    "--sites": "give participants pseudonyms that tell the sites apart, such as B-P01",
    "analyse --mapping": "docs/analysis.md shows how pandas makes a table of trials",
    "page --workers": "one process translates",
    "--test": "studies are tested as [analysis] of the protocol plans",
    "--cluster": "--workers shares the work between the processors of one machine",
    "simulate --protocol": "a simulated controller speaks the one version of the wire protocol",
}


class _Pairs(argparse.Action):
    """Options NAME=VALUE, gathered in a dictionary."""

    def __call__(
        self,
        _parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: str | Sequence[object] | None,
        _option: str | None = None,
    ) -> None:
        """Add a pair to those before."""
        name, equals, value = str(values).partition("=")
        if not equals or not name:
            raise argparse.ArgumentError(self, f"{values!r} is not NAME=VALUE")
        setattr(namespace, self.dest, {**getattr(namespace, self.dest), name: value})


class CommandParser(argparse.ArgumentParser):
    """A parser of a command, whose errors are one sentence.

    Parameters
    ----------
    command
        Command whose options are added when they are needed; None if they are added otherwise.
    settings
        As for an `argparse.ArgumentParser`.
    """

    def __init__(self, *, command: CommandRow | None = None, **settings) -> None:
        settings.setdefault("add_help", command is None)
        super().__init__(**settings, formatter_class=_Help, allow_abbrev=False)
        self._command = command

    def parse_known_args(self, args=None, namespace=None):  # pyright: ignore[reportIncompatibleMethodOverride]
        """Parse, as argparse does, with the options of this command added now."""
        self.complete()
        for argument in () if args is None else args:
            name = argument.partition("=")[0]
            if name.startswith("--") and name not in self._option_string_actions:
                self._refuse_gone(name)
        namespace, unknown = super().parse_known_args(args, namespace)
        if unknown and self._subparsers is None:
            self._refuse_unknown(unknown)
        return namespace, unknown

    def complete(self) -> None:
        """Add what the command has, its actions or its options, unless that is there."""
        command, self._command = self._command, None
        if command is None:
            return
        self.add_argument("-h", "--help", action="help", help="Print this help, and end.")
        actions = ACTIONS.get(self.prog.rpartition(" ")[2])
        if actions is not None:
            _add(self, "action", "ACTION", actions)
            return
        self.set_defaults(**command.values)
        given = {row.name for row in command.options if isinstance(row, Option)}
        self.take(*command.options, *(name for name in COMMON if name not in given))

    def _refuse_unknown(self, unknown: list[str]) -> NoReturn:
        """Refuse arguments, and say what is near an option."""
        options = [argument.partition("=")[0] for argument in unknown if argument[:1] == "-"]
        near = nearest(options[0], self._option_string_actions) if options else ""
        self.error(f"unrecognized arguments: {' '.join(unknown)}{near}")

    def _refuse_gone(self, name: str) -> None:
        """Refuse an option, a command or a value that there was, and say what does the same."""
        command = self.prog.removeprefix("vbraille").strip()
        instead = _GONE.get(f"{command} {name}".strip(), "")
        if not instead and name.startswith("--"):
            instead = _GONE.get(name, "")
        if instead:
            raise InputError(f"{name} is gone; {instead}")

    def _check_value(self, action: argparse.Action, value: object) -> None:
        """Refuse a value that is none of the choices, as argparse does, and name what is near."""
        try:
            super()._check_value(action, value)
        except argparse.ArgumentError as error:
            option = "".join(f"{name} " for name in action.option_strings[-1:])
            self._refuse_gone(f"{option}{value}")
            names = map(str, action.choices or ())
            if isinstance(action, argparse._SubParsersAction):
                near = nearest(str(value), [*names, *["help"] * (action.dest == "command")])
                self.error(f"there is no {action.dest} {value!r}{near}")
            error.message += nearest(str(value), names)
            raise

    def take(self, *rows: Row) -> None:
        """Add arguments and options, by themselves or by their names in the schema."""
        for row in rows:
            if isinstance(row, tuple):
                group = self.add_mutually_exclusive_group()
                for name in row:
                    _add_option(group, OPTIONS[name])
            else:
                _add_option(self, OPTIONS[row] if isinstance(row, str) else row)

    def format_help(self) -> str:
        """Help as argparse has it, followed for reading by help on the keys."""
        return super().format_help() + _keys(self.prog)

    def error(self, message: str) -> NoReturn:
        """Refuse the command line in a sentence.

        Raises
        ------
        InputError
            In any case.
        """
        raise InputError(f"{message} ({self.prog} --help says what there is)")


def _keys(program: str) -> str:
    """Lines on what the keys of a command do at a terminal, one for each key; none without keys."""
    if program == "vbraille read":
        from vbraille.cli.old.reading.commands.table import COMMANDS as KEYS
    elif program == "vbraille feel":
        from vbraille.cli.old.reading.commands.scene import COMMANDS as KEYS
    elif program == "vbraille play":
        from vbraille.cli.old.reading.commands.game import COMMANDS as KEYS
    else:
        return ""
    width = max(len(command.spoken_keys) for command in KEYS)
    lines = [f"  {command.spoken_keys:{width}}  {command.help}\n" for command in KEYS]
    return "\nkeys at a terminal:\n" + "".join(lines)


class _Overview(CommandParser):
    """The parser of all commands, whose help has them in groups."""

    def format_help(self) -> str:
        """Help on all commands, a line for each, under the name of its group."""
        width = max(map(len, COMMANDS))
        lines = [self.format_usage(), self.description or ""]
        for title, names in GROUPS.items():
            lines.append(f"\n{title}:")
            lines += [f"    {name:{width}}  {COMMANDS[name].does}" for name in names]
        lines += ["\noptions:", "    -h, --help     Print this help."]
        lines += ["    -V, --version  Print the version.", "", self.epilog or "", ""]
        return "\n".join(lines)


def parse(argv: Sequence[str] | None) -> argparse.Namespace:
    """Read the command line.

    Raises
    ------
    InputError
        If it cannot be understood.
    """
    argv = sys.argv[1:] if argv is None else list(argv)
    if argv[:1] == ["help"]:
        argv = [*argv[1:], "--help"]
    parser = _Overview(
        prog="vbraille",
        description="Read braille under one fingertip, on a page as large as you like.",
        epilog="example:\n  vbraille read book.txt\n\nvbraille help COMMAND says more of each.",
    )
    parser.add_argument(
        "-V",
        "--version",
        action="version",
        version=f"vbraille {__version__}",
        help="Print the version.",
    )
    _add(parser, "command", "COMMAND", COMMANDS)
    arguments = parser.parse_args(argv)
    for name, value in vars(arguments).items():
        if isinstance(value, list) and name not in (
            "paths",
            "words",
        ):  # Python before 3.13 takes the value of --name=-- away
            parser.error(f"argument --{name.replace('_', '-')}: expected one argument")
    for name, value in vars(arguments).items():
        if name in OPTIONS and PROFILE not in OPTIONS[name].holds:  # styles check themselves
            try:
                OPTIONS[name].check(value, OPTIONS[name].flag)
            except ValueError as error:
                raise InputError(str(error)) from None
    _check_live(arguments)
    return arguments


def _check_live(arguments: argparse.Namespace) -> None:
    """Refuse an address without a live view, or an empty one."""
    for name in ADDRESS:
        if getattr(arguments, name, None) is not None and not getattr(arguments, "monitor", True):
            raise InputError(
                f"{setting(name)} is for the live view; add {setting('monitor')}, or leave "
                f"{setting(name)} out"
            )
    if getattr(arguments, "host", None) == "":
        raise InputError(
            f"{setting('host')} is empty; give an address of this machine, or leave it out"
        )


def read_instead(arguments: argparse.Namespace) -> argparse.Namespace:
    """Arguments of ``vbraille read`` in place of ``vbraille books N``, which opens the book.

    Raises
    ------
    InputError
        If the list is asked for, too.
    """
    if arguments.json:
        raise InputError("a number alone opens its book; leave out either that or --json")
    log = () if arguments.log is None else ("--log", arguments.log)
    return parse(["read", "--book", str(arguments.number), *log])


def _add_option(parser: argparse._ActionsContainer, option: Option) -> None:
    """Add an option, or an argument, to a parser or a group of one."""
    kind = str if option.choices else _READERS.get(option.kind, option.kind)  # pyright: ignore[reportArgumentType, reportCallIssue]
    if isinstance(option, Argument):
        added = parser.add_argument(
            option.name,
            nargs=option.times or None,
            metavar=option.metavar,
            help=option.sentence,
            type=kind,
            default=option.default,
        )
        if option.times == argparse.REMAINDER:
            added.required = False
    elif option.kind is bool:
        parser.add_argument(
            option.flag, action="store_true", help=option.sentence, default=option.default
        )
        return
    else:
        added = parser.add_argument(
            option.flag,
            action=_Pairs if option.pairs else "store",
            metavar=option.metavar,
            help=option.sentence,
            type=kind,
            default={} if option.pairs else option.default,
            required=option.required,
        )
    added.choices = option.choices  # not looked at before they are needed


def _add(
    parser: CommandParser, dest: str, metavar: str, commands: Mapping[str, CommandRow]
) -> None:
    """Add commands to a parser, or the actions of a command."""
    added = parser.add_subparsers(
        dest=dest, required=True, metavar=metavar, parser_class=CommandParser
    )
    for name, command in commands.items():
        added.add_parser(
            name,
            help=command.does,
            description=command.does,
            epilog=f"example:\n  {command.example}",
            command=command,
        )
