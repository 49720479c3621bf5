"""The parser of a command's options: kinds of options, help, and refusals of one sentence."""

from __future__ import annotations

import argparse
import os

from vbraille.config.options import COMMON, FILE, OPTIONS, held_in, number, whole
from vbraille.errors import InputError
from vbraille.wording import nearest

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from typing import NoReturn


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
    else:
        return ""
    width = max(len(command.spoken_keys) for command in KEYS)
    lines = [f"  {command.spoken_keys:{width}}  {command.help}\n" for command in KEYS]
    return "\nkeys at a terminal:\n" + "".join(lines)
