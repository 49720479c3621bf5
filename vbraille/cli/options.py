"""Options that commands share, each one decorator; a command takes those that it obeys.

An option says what it is called, which values it takes and what its help is. ``None`` means that it
was not given: what then holds is with the work of the command.
"""

from __future__ import annotations

import math
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

import click
from click.shell_completion import CompletionItem

from vbraille.cli.settings import use_settings
from vbraille.knobs import KNOBS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

FIRST = "Options"  # the group that `--help` prints; `--help-all` prints every group
SHARED: set[str] = set()  # names of the options of this module


class Option(click.Option):
    """An option with a group, under which help lists it."""

    def __init__(self, *names: Any, group: str = FIRST, **how: Any) -> None:
        super().__init__(*names, **how)
        self.group = group


class Command(click.Command):
    """A command with a settings file, a log, and help in groups.

    ``--help`` lists the options without a group, and ``--help-all`` all of them.
    """

    def __init__(self, *names: Any, **how: Any) -> None:
        super().__init__(*names, **how)
        self.params += [_help_all(), _log()]

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse, with the settings file for what is not given."""
        names = {param.name for param in self.params}
        if "settings" in names and not ctx.resilient_parsing:
            typed, _, _ = self.make_parser(ctx).parse_args(list(args))
            chosen = {
                param.name: param.consume_value(ctx, typed)[0]
                for param in self.params
                if param.name in ("settings", "profile")
            }
            root = ctx.find_root().command
            commands = root.list_commands(ctx) if isinstance(root, click.Group) else ()
            use_settings(
                ctx,
                _text(chosen.get("settings")),
                _text(chosen.get("profile")),
                commands,
                SHARED,
            )
        return super().parse_args(ctx, args)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the first options, or all of them in groups."""
        groups: dict[str, list[tuple[str, str]]] = {FIRST: []}
        for param in self.get_params(ctx):
            record = param.get_help_record(ctx)
            if record is not None and isinstance(param, click.Option):
                groups.setdefault(getattr(param, "group", FIRST), []).append(record)
        shown = groups if ctx.meta.get("vbraille.help_all") else {FIRST: groups[FIRST]}
        for name, records in shown.items():
            with formatter.section(name):
                formatter.write_dl(records, col_max=26)


class Group(click.Group):
    """A command that has actions."""

    command_class = Command

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002 - click's signature
        """Names of the actions, in the order of their making."""
        return list(self.commands)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the action, or the command, that the arguments begin with.

        Raises
        ------
        click.UsageError
            If there is none; the sentence names what comes near.
        """
        names = self.list_commands(ctx)
        if args[0] not in names and not args[0].startswith("-") and not ctx.resilient_parsing:
            near = get_close_matches(args[0], names, 1)
            hint = f"did you mean {near[0]!r}?" if near else f"{ctx.command_path} --help lists them"
            raise click.UsageError(f"unknown command {args[0]!r}; {hint}", ctx)
        return super().resolve_command(ctx, args)


class Number(click.ParamType):
    """A finite number in a range.

    Parameters
    ----------
    low, high
        Bounds; None for none.
    kind
        float or int.
    """

    def __init__(
        self, low: float | None = None, high: float | None = None, kind: type = float
    ) -> None:
        self.name = "integer" if kind is int else "number"
        self.low, self.high, self.kind = low, high, kind

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Convert a text or a number of a file."""
        try:
            number = self.kind(value)
            wrong = isinstance(value, bool) or not math.isfinite(number) or number != float(value)
        except (TypeError, ValueError, OverflowError):
            wrong, number = True, 0
        if wrong:
            what = "a whole number" if self.kind is int else "a number"
            self.fail(f"{value!r} is not {what}", param, ctx)
        if self.low is not None and number < self.low:
            self.fail(f"{number:g} is not {self._range()}", param, ctx)
        if self.high is not None and number > self.high:
            self.fail(f"{number:g} is not {self._range()}", param, ctx)
        return number

    def get_metavar(self, param: click.Parameter, ctx: click.Context | None = None) -> str | None:  # noqa: ARG002
        """The range, for help."""
        if self.low is None or self.high is None:
            return "N"
        return f"{self.low:g}…{self.high:g}"

    def _range(self) -> str:
        if self.high is None:
            return f"{self.low:g} or more"
        return f"at most {self.high:g}" if self.low is None else f"{self.low:g} to {self.high:g}"


def whole(low: int | None = None, high: int | None = None) -> Number:
    """A whole number in a range."""
    return Number(low, high, int)


class Known(click.ParamType):
    """One of some names, which are loaded when a value is converted or completed.

    Parameters
    ----------
    what
        Noun for what a name names, such as "table".
    load
        Function that returns the names.
    """

    name = "name"

    def __init__(self, what: str, load: Callable[[], Iterable[str]]) -> None:
        self.what, self.load = what, load

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Check that a name is known."""
        names = list(self.load())
        if value in names:
            return value
        near = get_close_matches(str(value), names, 3)
        hint = f"did you mean {' or '.join(near)}?" if near else f"known: {', '.join(names)}"
        raise click.BadParameter(f"unknown {self.what} {value!r}; {hint}", ctx, param)

    def shell_complete(
        self,
        ctx: click.Context,  # noqa: ARG002 - click's signature
        param: click.Parameter,  # noqa: ARG002
        incomplete: str,
    ) -> list[CompletionItem]:
        """Names that begin as what is typed."""
        return [CompletionItem(name) for name in self.load() if name.startswith(incomplete)]


class Lines(click.ParamType):
    """A range of lines such as 3-10, 7 or 5-: the first and the last, which may be None."""

    name = "lines"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Convert a text."""
        if isinstance(value, tuple):
            return value
        first, dash, last = str(value).partition("-")
        digits = [part for part in (first, last) if part]
        if not digits or not all(part.isdecimal() and len(part) < 16 for part in digits):
            self.fail(f"{value!r} is not a range of lines such as 3-10", param, ctx)
        low = int(first or 1)
        high = int(last) if last else None if dash else low
        if low < 1 or (high is not None and high < low):
            self.fail(f"{value!r} is not a range of lines such as 3-10; lines count from 1",
                      param, ctx)  # fmt: skip
        return low, high


class Duration(click.ParamType):
    """A time such as 200ms or 5s; in seconds."""

    name = "duration"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Convert a text."""
        if isinstance(value, float):
            return value
        text = str(value)
        number, unit = (text[:-2], 0.001) if text.endswith("ms") else (text[:-1], 1.0)
        try:
            seconds = float(number) * unit if text.endswith("s") else math.nan
        except ValueError:
            seconds = math.nan
        if not 0.001 <= seconds <= 3600:
            self.fail(f"{value!r} is not a time from 1ms to 3600s, such as 200ms", param, ctx)
        return seconds


def option(*names: str, **how: Any) -> Callable:
    """Make the decorator of an option.

    It decorates a function, or makes another decorator, with changes such as a group:
    ``options.model(group=options.FIRST, default="stress2")``.
    """

    def decorate(function: Callable | None = None, **changes: Any) -> Callable:
        made = how | changes
        apply = click.option(*names, cls=Option, **made)
        return apply if function is None else apply(function)

    return decorate


def takes(*options: Callable) -> Callable:
    """Give a command options, listed in this order."""

    def decorate(function: Callable) -> Callable:
        for each in reversed(options):
            function = each(function)
        return function

    return decorate


def _shared(*names: str, **how: Any) -> Callable:
    """Make the decorator of an option that a settings file may have."""
    SHARED.add(names[-1].removeprefix("--").replace("-", "_"))
    return option(*names, **how)


def _text(value: object) -> str | None:
    return value if isinstance(value, str) else None


def _show_all(ctx: click.Context, _param: click.Parameter, value: bool) -> None:
    if value and not ctx.resilient_parsing:
        ctx.meta["vbraille.help_all"] = True
        click.echo(ctx.get_help())
        ctx.exit()


def _help_all() -> Option:
    how = {"is_flag": True, "is_eager": True, "expose_value": False, "callback": _show_all}
    return Option(["--help-all"], help="Show all options, in groups.", **how)


def _keep_log(ctx: click.Context, _param: click.Parameter, value: str | None) -> None:
    if value is not None and not ctx.resilient_parsing:
        from vbraille.logs import keep

        keep(value)


def _log() -> Option:
    how = {"expose_value": False, "callback": _keep_log, "group": "For developers"}
    return Option(["--log"], metavar="FILE", help="Append a log to a file; - for stderr.", **how)


def _models() -> Iterable[str]:
    from vbraille.render import MODELS

    return MODELS


def _mappings() -> Iterable[str]:
    from vbraille.render import MAPPINGS

    return MAPPINGS


def _geometries() -> Iterable[str]:
    from vbraille.braille.geometry import PRESETS

    return PRESETS


def _tables() -> Iterable[str]:
    from vbraille.translate import list_tables

    return (table.name for table in list_tables())


def _knob(name: str, help: str) -> Callable:  # noqa: A002 - click's word
    knob = KNOBS[name]
    kind = Number(knob.low, knob.high, knob.kind)
    metavar = "MM" if knob.unit else None
    return _shared(f"--{name.replace('_', '-')}", type=kind, metavar=metavar, help=help, **_FEEL)


_TEXT: Any = {"group": "Text and translation"}
_FEEL: Any = {"group": "How braille feels"}
_DEVICE: Any = {"group": "Device and hand"}
_OUTPUT: Any = {"group": "Output and keys"}
_VIEW: Any = {"group": "Live view"}
_KEPT: Any = {"group": "Places and settings"}

# The text and its braille
file = click.argument("file", type=click.Path(allow_dash=True))
optional_file = click.argument("file", type=click.Path(allow_dash=True), required=False)
language = _shared("--language", metavar="TAG", help="Language of the text, such as fr or pt-BR.")
grade = _shared("--grade", type=whole(0, 9), metavar="N",
                help="Grade: 0 or 1 uncontracted, 2 and up contracted.")  # fmt: skip
lines = option("--lines", type=Lines(), metavar="3-10", default=(1, None),
               help="Lines of the page, from 1.")  # fmt: skip
table = _shared("--table", metavar="NAME", help="Translation table of liblouis.", **_TEXT)
encoding = _shared("--encoding", metavar="NAME", help="Text encoding of the file.", **_TEXT)
form = _shared("--form", metavar="NAME", help="File format: text, markdown, html, epub, dtbook, "
               "docx, odt, rtf, brf, unicode-braille or pef.", **_TEXT)  # fmt: skip
brf_table = _shared("--brf-table", metavar="NAME", help="Display table of a BRF file, such as "
                    "de-eurobrl6.dis.", **_TEXT)  # fmt: skip
foreign = _shared("--foreign", type=click.Choice(["switch", "own"]), default="switch",
                  help="Passages in another language: switch to its table, or keep the text's own.",
                  **_TEXT)  # fmt: skip
undefined = _shared("--undefined", type=click.Choice(["mark", "name", "code", "drop"]),
                    default="mark", help="Characters that the table lacks: a mark, their name, "
                    "their number, or nothing.", **_TEXT)  # fmt: skip
keep_lines = _shared("--keep-lines", is_flag=True, help="Keep line breaks, as in verse.", **_TEXT)

# How braille feels
texture = _knob("texture", "Texture between the dots.")
contrast = _knob("contrast", "Share of the actuators' full swing.")
texture_cycles = _knob("texture_cycles", "Half-cycles of texture in a dot's radius; odd.")
dot_width = _knob("dot_width", "Width of a dot along the line.")
dot_spacing = _knob("dot_spacing", "Distance between the dot columns of a cell.")
cell_gap = _knob("cell_gap", "Distance between the dots of neighbouring cells.")
line_pitch = _knob("line_pitch", "Distance between lines.")
mapping = _shared("--mapping", type=Known("mapping", _mappings), metavar="NAME",
                  help="Rows of actuators that show each row of dots.", **_FEEL)  # fmt: skip
dot_row = _shared("--dot-row", type=whole(1, 3), help="Row of dots that a VBD shows.", **_FEEL)
geometry = _shared("--geometry", type=Known("geometry", _geometries), metavar="NAME",
                   help="Distances to start from: a display's, or paper.", **_FEEL)  # fmt: skip

# Device and hand
device = _shared("--device", metavar="SPEC", default="sim", show_default=True,
                 help="Device: serial:PORT, latero:HOST or sim.")  # fmt: skip
model = _shared("--model", type=Known("display model", _models), metavar="NAME",
                help="Display model; any other device is rejected.", **_DEVICE)  # fmt: skip
travel = _shared("--travel", type=Number(1, 10_000), metavar="MM",
                 help="Travel of the carriage; sets the line length.", **_DEVICE)  # fmt: skip
height = _shared("--height", type=Number(0, 10_000), metavar="MM",
                 help="Travel across the lines; 0 reads one line.", **_DEVICE)  # fmt: skip
cells = _shared("--cells", type=whole(1, 200), metavar="N", help="Cells in a line.", **_DEVICE)
rate = _shared("--rate", type=Number(1, 10_000), metavar="HZ", default=1000,
               help="Frames per second.", **_DEVICE)  # fmt: skip
straying = _shared("--straying", type=click.Choice(["line", "free"]),
                   help="When the finger strays from its line: keep showing the line, or what lies "
                   "under each contactor.", **_DEVICE)  # fmt: skip
band = _shared("--band", type=Number(0, 0.9), help="How far past a line's edge the finger may "
               "stray, in line pitches.", **_DEVICE)  # fmt: skip
hand = _shared("--hand", metavar="HAND", default="sweep:60", show_default=True,
               help="Simulated hand: slow, fluent, still, sweep:MM_S, wide or recorded:FILE."
               )  # fmt: skip
seed = _shared("--seed", type=whole(0), metavar="N", default=1, help="Seed for random numbers.",
               **_DEVICE)  # fmt: skip

# What is heard and printed
echo = _shared("--echo", type=click.Choice(["none", "text", "cells", "both"]),
               help="What to print of each line.")  # fmt: skip
speech = _shared("--speech", is_flag=True, help="Speak all messages by Speech Dispatcher.")
cues = _shared("--cues", type=click.Choice(["tones", "bell", "none"]),
               help="Signals at limits and ends of pages.", **_OUTPUT)  # fmt: skip
also = _shared("--also", metavar="DISPLAY", help="Braille display beside: brlapi, or "
               "brlapi:HOST:N.", **_OUTPUT)  # fmt: skip
keys = _shared("--keys", type=click.Choice(["usual", "nvda"]), default="usual",
               help="Key set: vbraille's own, or NVDA's browse mode.")  # fmt: skip
advance = _shared("--advance", type=click.Choice(["return", "key"]), default="return",
                  help="What brings the next line: a return of the hand, or a key.",
                  **_OUTPUT)  # fmt: skip

# The live view
monitor = _shared("--monitor", is_flag=True, help="Show a live view in a browser.")
host = option("--host", metavar="ADDRESS", help="Address of the live view, to share it.", **_VIEW)
port = option("--port", type=whole(0, 65_535), help="Port of the live view.", **_VIEW)

# Places and settings
profile = _shared("--profile", metavar="NAME", help="Profile of the settings file.")
settings = option("--settings", type=click.Path(), metavar="FILE", help="Settings file to use.",
                  **_KEPT)  # fmt: skip
no_places = _shared("--no-places", is_flag=True, help="Start at the top; keep no place.", **_KEPT)

# What a command prints or writes
json = option("--json", is_flag=True, help="Print JSON.")
csv = option("--csv", is_flag=True, help="Print CSV.")
out = option("--out", type=click.Path(), metavar="FILE", help="File to write.")
force = option("--force", is_flag=True, help="Replace files that exist.")
workers = option("--workers", type=whole(1, 1024), metavar="N", default=1, help="Processes.")

TRANSLATION = (language, grade, table, encoding, form, brf_table, foreign, undefined, keep_lines)
DISTANCES = (dot_width, dot_spacing, cell_gap, line_pitch, geometry)
FEEL = (texture, contrast, texture_cycles, *DISTANCES, mapping, dot_row)
PAGE = (height, straying, band)
LIVE = (monitor, host, port)
