"""The commands and their parser, help and refusals; `vbraille.cli.options` has their options."""

from __future__ import annotations

import argparse
import os
import sys
from importlib import import_module

from vbraille.config.options import COMMON, FILE, OPTIONS, PROFILE, held_in, number, whole
from vbraille.errors import InputError
from vbraille.version import __version__
from vbraille.wording import nearest

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from typing import NoReturn

    Options = Callable[["CommandParser"], None]


class _Help(argparse.HelpFormatter):
    """Help without a look at the terminal, which would load half the standard library."""

    def __init__(self, prog: str) -> None:
        columns = os.environ.get("COLUMNS", "")
        super().__init__(prog, width=int(columns) - 2 if columns.isdecimal() else 78)

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        """Wrap all but examples, which are copied from here."""
        return text if text.startswith("example:") else super()._fill_text(text, width, indent)


def _with_default(text: str, default: object) -> str:
    """Sentence of help with the default, unless there is none or the sentence has words for it."""
    if default is None or "(default: " in text:
        return text
    said = f"{default:g}" if isinstance(default, float) else default
    return f"{text.removesuffix('.')} (default: {said})."


_READERS = {int: whole, float: number}
# Options that there were, and what does the same.
_GONE = {
    "--at": "--y chooses the height of the line that is felt, and --x the place of an array",
    "--plain": "progress is lines, at a terminal or with --verbose",
    "--play": "give the recording by itself, as in vbraille monitor reading.h5",
    "--abstract": "--outline draws what is felt",
    "--raised": "--outline draws what is felt, black on white, for swell paper",
    "--sheet": "print an --outline without scaling",
    "--layout": "--cells 40 --format pef makes pages; file2brl lays out for embossers",
    "--skin": "the simulated reader has one model of the skin",
    "--key": "pseudonyms are codes already; pandas puts others in their place",
    "--sites": "give participants pseudonyms that tell the sites apart, such as B-P01",
    "--mapping": "docs/analysis.md shows how pandas makes a table of trials",
    "--workers": "one process translates",
    "--test": "studies are tested as [analysis] of the protocol plans",
    "--cluster": "--workers shares the work between the processors of one machine",
    "--protocol": "a simulated controller speaks the one version of the wire protocol",
}


class CommandParser(argparse.ArgumentParser):
    """A parser of kinds of options, whose errors are one sentence.

    Parameters
    ----------
    options
        Function that adds the options, called when the command is; None if none are added so.
    settings
        As for an `argparse.ArgumentParser`.
    """

    def __init__(
        self, *, options: Callable[[CommandParser], None] | None = None, **settings
    ) -> None:
        super().__init__(**settings, formatter_class=_Help, allow_abbrev=False)
        self._options = options

    def parse_known_args(self, args=None, namespace=None):  # pyright: ignore[reportIncompatibleMethodOverride]
        """Parse, as argparse does, with the options of this command added now."""
        if self._options is not None:
            options, self._options = self._options, None
            self.add_argument("-h", "--help", action="help", help="Print this help.")
            options(self)
            if self._subparsers is None:  # one without actions, which have options of their own
                self.take(*COMMON)
        namespace, unknown = super().parse_known_args(args, namespace)
        if unknown and self._subparsers is None:
            self._refuse(unknown)
        return namespace, unknown

    def _refuse(self, unknown: list[str]) -> NoReturn:
        """Refuse arguments; of an option that is gone say what there is, of others what is near."""
        options = [argument.partition("=")[0] for argument in unknown if argument[:1] == "-"]
        for option in options:
            if instead := _GONE.get(option):
                raise InputError(f"{option} is gone; {instead}")
        near = nearest(options[0], self._option_string_actions) if options else ""
        self.error(f"unrecognized arguments: {' '.join(unknown)}{near}")

    def _check_value(self, action: argparse.Action, value: object) -> None:
        """Refuse a value that is none of the choices, as argparse does, and name what is near."""
        try:
            super()._check_value(action, value)
        except argparse.ArgumentError as error:
            near = nearest(str(value), map(str, action.choices or ()))
            if near and isinstance(action, argparse._SubParsersAction):
                self.error(f"there is no {action.dest} {value!r}{near}")
            error.message += near
            raise

    def take(self, *names: str, unset: bool = False) -> None:
        """Add options of the schema, by their names.

        Parameters
        ----------
        names
            Names of the options.
        unset
            Whether one that is not given has no value, so that it is known not to be given.
        """
        for option in map(OPTIONS.__getitem__, names):
            if option.kind is bool:
                self.flag(option.flag, option.sentence)
                continue
            kind = str if option.choices else _READERS.get(option.kind, option.kind)
            added = self.add_argument(
                option.flag,
                metavar=option.metavar,
                help=option.sentence,
                type=kind,
                default=None if unset else option.default,
            )
            added.choices = option.choices  # not looked at before they are needed

    def leave_to_settings(self) -> None:
        """Leave options that a settings file may say without a value."""
        self.set_defaults(**{option.name: None for option in held_in(FILE)})

    def flag(self, name: str, text: str) -> None:
        """Add an option that is given or not, and the sentence that help has of it."""
        self.add_argument(name, action="store_true", help=text)

    def option(
        self,
        name: str,
        metavar: str,
        text: str,
        kind: Callable[[str], object] = str,
        *,
        default: object = None,
        required: bool = False,
    ) -> None:
        """Add an option with a value; help says its default where the sentence does not."""
        self.add_argument(
            name,
            metavar=metavar,
            help=_with_default(text, default),
            type=kind,
            default=default,
            required=required,
        )

    def choice(
        self,
        name: str,
        choices: Sequence[object],
        text: str,
        *,
        default: object = None,
        kind: Callable[[str], object] = str,
    ) -> None:
        """Add an option with one of some values; help says its default as for `option`."""
        text = _with_default(text, default)
        self.add_argument(name, choices=choices, help=text, type=kind, default=default)

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
        from vbraille.reading.commands.table import COMMANDS as KEYS
    elif program == "vbraille feel":
        from vbraille.reading.commands.scene import COMMANDS as KEYS
    elif program == "vbraille play":
        from vbraille.reading.commands.game import COMMANDS as KEYS
    else:
        return ""
    width = max(len(command.spoken_keys) for command in KEYS)
    lines = [f"  {command.spoken_keys:{width}}  {command.help}\n" for command in KEYS]
    return "\nkeys at a terminal:\n" + "".join(lines)


class _Options:
    """A module of options, of which only functions are known that load it when called."""

    def __init__(self, name: str) -> None:
        self._module = f"vbraille.cli.options.{name}"

    def __getattr__(self, name: str) -> Options:
        """Give the function of a name, which adds a command's options."""

        def add(parser: CommandParser) -> None:
            getattr(import_module(self._module), name)(parser)

        return add


completion, exploring, lab = map(_Options, ("completion", "exploring", "lab"))
# For each command: what it does, how its options are made, and an example.
COMMANDS: dict[str, tuple[str, Options, str]] = {
    "read": (
        "Read a text on a device, line after line.",
        exploring.read,
        "vbraille read book.txt --device serial:/dev/ttyACM0",
    ),
    "feel": (
        "Feel a tactile picture on a device, or with a simulated hand.",
        exploring.feel,
        "vbraille feel house.scene --device latero:192.168.1.10",
    ),
    "play": (
        "Play memory with cards that only the finger tells apart.",
        exploring.play,
        "vbraille play --players 2 --device latero:192.168.1.10",
    ),
    "books": (
        "List the books that were read, or read on in one of them.",
        exploring.books,
        "vbraille books 2",
    ),
    "keys": (
        "List the keys that are obeyed while reading.",
        exploring.keys,
        "vbraille keys",
    ),
    "settings": (
        "Print each setting of reading, and where it comes from.",
        exploring.settings,
        "vbraille settings --profile evening",
    ),
    "tune": (
        "Find out in five minutes how braille feels best, two ways at a time.",
        exploring.tune,
        "vbraille tune --profile evening --device serial:/dev/ttyACM0",
    ),
    "page": (
        "Print the page as it is laid out, or write it for an embosser.",
        exploring.page,
        "vbraille page book.txt --cells 40 --format brf --out book.brf",
    ),
    "structure": (
        "Print a book's outline, and what it has.",
        exploring.structure,
        "vbraille structure book.epub",
    ),
    "render": (
        "Write every frame of a reading to an HDF5 file.",
        exploring.render,
        "vbraille render book.txt --lines 1-3 --hand slow --out reading.h5",
    ),
    "profile": (
        "Say what a frame of a tactile picture costs, place by place.",
        exploring.profile,
        "vbraille profile house.scene --path wide --out cost.csv",
    ),
    "monitor": (
        "Play back a recording or a session in a browser, until Ctrl-C.",
        exploring.monitor,
        "vbraille monitor reading.h5",
    ),
    "plot": (
        "Draw a picture of what the display does, or print its numbers.",
        exploring.plot,
        "vbraille plot page book.txt --lines 1-4 --x 120 --out page.png",
    ),
    "map": (
        "Draw a tactile picture: its deflections, what it is made of, or raised lines for paper.",
        exploring.scene_map,
        "vbraille map texts/scenes/gallery/layers.scene --array 22,16 --out layers.png",
    ),
    "simulate": (
        "Be a device, at a port that a program can read on, until Ctrl-C.",
        exploring.simulate,
        "vbraille simulate --link ./vb0 --hand slow",
    ),
    "device": (
        "Say which devices there are, and try one.",
        lambda parser: _add(parser, "action", "ACTION", ACTIONS["device"]),
        "vbraille device check serial:/dev/ttyACM0",
    ),
    "session": (
        "Run legibility sessions, and keep every answer.",
        lambda parser: _add(parser, "action", "ACTION", ACTIONS["session"]),
        "vbraille session run legibility --participant P07 --seed 42",
    ),
    "analyse": (
        "Make tables, statistics and a report of sessions.",
        lab.analyse,
        "vbraille analyse P01-letters-* P02-letters-* --out report",
    ),
    "power": (
        "Say how often a study of a protocol would find an effect, by simulation.",
        lab.power,
        "vbraille power letters --effect T0=0.5,T25=0.56,T100=0.64 --participants 4-40",
    ),
    "predict": (
        "Say what the simulated reader would read, over a grid of styles, texts and speeds.",
        lab.predict,
        "vbraille predict grid.toml --out predicted --workers 2",
    ),
    "scene": (
        "Look through tactile pictures, and convert those of others.",
        lambda parser: _add(parser, "action", "ACTION", ACTIONS["scene"]),
        "vbraille scene check texts/scenes/house.scene",
    ),
    "tables": (
        "List the braille tables that there are, and which a language takes.",
        exploring.tables,
        "vbraille tables --language fr",
    ),
    "setup": (
        "Compile what drives the actuators, so that the first reading does not wait for it.",
        exploring.nothing,
        "vbraille setup",
    ),
    "completion": (
        "Print what makes a shell complete commands, options and values.",
        completion.completion,
        "vbraille completion fish > ~/.config/fish/completions/vbraille.fish",
    ),
}
SCENE_ACTIONS: dict[str, tuple[str, Options, str]] = {
    "check": (
        "Say what a tactile picture holds, what is ignored of its file, what will vibrate against "
        "what, and what is hard to feel.",
        exploring.check,
        "vbraille scene check texts/scenes/house.scene",
    ),
    "convert": (
        "Make a scene file of a file of OpenLatero's or a drawing, and say what differs.",
        exploring.convert,
        "vbraille scene convert umbrella.gen --out umbrella.scene",
    ),
    "schema": (
        "Print the form of scene files as a JSON Schema, for editors that complete and check.",
        exploring.nothing,
        "vbraille scene schema > scene.schema.json",
    ),
}
DEVICE_ACTIONS: dict[str, tuple[str, Options, str]] = {
    "list": (
        "List the serial ports, with their names and ids.",
        exploring.device_list,
        "vbraille device list",
    ),
    "info": (
        "Print what a device says of itself.",
        exploring.device_info,
        "vbraille device info serial:/dev/ttyACM0",
    ),
    "check": (
        "Swing each actuator, hold the rate, measure the clock, the round trip and the watchdog, "
        "and judge whether a person can read on the device.",
        exploring.device_info,
        "vbraille device check serial:/dev/ttyACM0 --model stress2",
    ),
    "calibrate": (
        "Feel or look at each actuator in turn, and keep which are dead, weak or inverted, and "
        "their gains; h says the keys.",
        exploring.device_calibrate,
        "vbraille device calibrate serial:/dev/ttyACM0",
    ),
}
SESSION_ACTIONS: dict[str, tuple[str, Options, str]] = {
    "protocols": (
        "List the protocols that come with the program, or print one to be copied and edited.",
        lab.session_protocols,
        "vbraille session protocols letters > mine.toml",
    ),
    "plan": (
        "Print the whole order of a session before anyone sits down.",
        lab.session_plan,
        "vbraille session plan legibility --participant P07 --seed 42",
    ),
    "run": (
        "Run a session; at its prompt, help says what can be typed.",
        lab.session_run,
        "vbraille session run legibility --participant P07 --device serial:/dev/ttyACM0",
    ),
    "resume": (
        "Go on with a session at the next trial of the same order.",
        lab.session_resume,
        "vbraille session resume P07-legibility-20261121-101500",
    ),
    "pilot": (
        "Conduct a whole study with the simulated reader, its report and all.",
        lab.session_pilot,
        "vbraille session pilot letters --participants 20 --workers 2",
    ),
    "export": (
        "Make tables of a session.",
        lab.session_export,
        "vbraille session export P07-legibility-20261121-101500 --out trials.csv",
    ),
    "methods": (
        "Say in a paragraph what was done, made of the records of sessions.",
        lab.session_methods,
        "vbraille session methods P01-letters-* P02-letters-*",
    ),
    "check": (
        "See whether every file of a session is whole, and nothing was changed.",
        lab.session_check,
        "vbraille session check P07-legibility-20261121-101500",
    ),
    "withdraw": (
        "Remove all data of a participant: sessions, rows of tables, plans, reports.",
        lab.session_withdraw,
        "vbraille session withdraw P07 study",
    ),
}


# Actions of the commands that have any.
ACTIONS = {"device": DEVICE_ACTIONS, "scene": SCENE_ACTIONS, "session": SESSION_ACTIONS}

# Commands as the overview has them.
GROUPS = {
    "reading": ("read", "books", "keys", "settings", "tune", "structure", "tables"),
    "pictures": ("feel", "play", "map", "scene", "profile"),
    "a page, its frames and drawings": ("page", "render", "plot", "monitor"),
    "devices": ("device", "simulate"),
    "for a lab": ("session", "analyse", "power", "predict"),
    "for the machine and its shell": ("setup", "completion"),
}


class _Overview(CommandParser):
    """The parser of all commands, whose help has them in groups."""

    def format_help(self) -> str:
        """Help on all commands, a line for each, under the name of its group."""
        width = max(map(len, COMMANDS))
        lines = [self.format_usage(), self.description or ""]
        for title, names in GROUPS.items():
            lines.append(f"\n{title}:")
            lines += [f"    {name:{width}}  {COMMANDS[name][0]}" for name in names]
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
    return arguments


def read_instead(arguments: argparse.Namespace) -> argparse.Namespace:
    """Arguments of ``vbraille read`` in place of ``vbraille books N``, which opens the book.

    Raises
    ------
    InputError
        If another option of ``vbraille books`` is given, too.
    """
    if arguments.json or arguments.forget is not None:
        raise InputError("a number alone opens its book; leave out either that or the option")
    log = () if arguments.log is None else ("--log", arguments.log)
    return parse(["read", "--book", str(arguments.number), *log])


def _add(
    parser: CommandParser,
    dest: str,
    metavar: str,
    commands: dict[str, tuple[str, Options, str]],
) -> None:
    """Add commands to a parser, or the actions of a command."""
    added = parser.add_subparsers(
        dest=dest, required=True, metavar=metavar, parser_class=CommandParser
    )
    for name, (text, add_options, example) in commands.items():
        added.add_parser(
            name,
            help=text,
            description=text,
            epilog=f"example:\n  {example}",
            add_help=False,
            options=add_options,
        )
