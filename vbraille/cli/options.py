"""Options that commands share, each one decorator; a command takes those that it obeys.

An option says what it is called, which values it takes and what its help is. ``None`` means that it
was not given: what then holds is with the work of the command.
"""

from __future__ import annotations

import math
import re
from difflib import get_close_matches
from importlib import import_module
from typing import TYPE_CHECKING, Any

import click
from click.shell_completion import CompletionItem

from vbraille.cli.settings import SHARED, Context
from vbraille.knobs import KNOBS

if TYPE_CHECKING:
    from collections.abc import Callable

FIRST = "Options"  # the group that `--help` prints; `--help-all` prints every group


class Option(click.Option):
    """An option with a group, under which help lists it."""

    def __init__(self, *names: Any, group: str = FIRST, **how: Any) -> None:
        super().__init__(*names, **how)
        self.group = group


class Command(click.Command):
    """A command with a settings file, a log, and help in groups.

    ``--help`` lists the options without a group, and ``--help-all`` all of them.
    """

    context_class = Context

    def __init__(self, *names: Any, **how: Any) -> None:
        super().__init__(*names, **how)
        self.params += [
            Option(
                ["--help-all"], is_flag=True, is_eager=True, expose_value=False,
                callback=_show_all, help="Show all options, in groups.",
            ),
            Option(
                ["--log"], metavar="FILE", expose_value=False, callback=_keep_log,
                help="Append a log to a file; - for stderr.", group="For developers",
            ),
        ]  # fmt: skip

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


def _show_all(ctx: click.Context, _param: click.Parameter, value: bool) -> None:
    if value and not ctx.resilient_parsing:
        ctx.meta["vbraille.help_all"] = True
        click.echo(ctx.get_help())
        ctx.exit()


def _keep_log(ctx: click.Context, _param: click.Parameter, value: str | None) -> None:
    if value is not None and not ctx.resilient_parsing:
        from vbraille.logs import keep

        keep(value)


class Group(click.Group):
    """A command that has actions, listed in the order of their making."""

    command_class = Command

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002 - click's signature
        """Names of the actions."""
        return list(self.commands)

    def action(
        self, example: str, *options: Callable, name: str | None = None
    ) -> Callable[[Callable], click.Command]:
        """Make the decorator of an action, as `command` does."""
        return command(example, *options, group=self, name=name)

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
        Bounds.
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
            number = self.kind(str(value))
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            what = "a whole number" if self.kind is int else "a number"
            self.fail(f"{value!r} is not {what}", param, ctx)
        low, high = self.low, self.high
        if (low is not None and number < low) or (high is not None and number > high):
            within = f"{low:g} or more" if high is None else f"{low:g} to {high:g}"
            self.fail(f"{number:g} is not {within}", param, ctx)
        return number

    def get_metavar(self, param: click.Parameter, ctx: click.Context | None = None) -> str | None:  # noqa: ARG002
        """The range, for help."""
        return "N" if self.low is None or self.high is None else f"{self.low:g}…{self.high:g}"


def whole(low: int | None = None, high: int | None = None) -> Number:
    """A whole number in a range."""
    return Number(low, high, int)


class Known(click.ParamType):
    """One of some names, which are loaded when a value is converted or completed.

    Parameters
    ----------
    what
        Noun for what a name names, such as "mapping".
    module, names
        Module that has the names, and its collection of them.
    """

    name = "name"

    def __init__(self, what: str, module: str, names: str) -> None:
        self.what, self.module, self.names = what, module, names

    def load(self) -> list[str]:
        """Load the names."""
        return list(getattr(import_module(self.module), self.names))

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Check that a name is known."""
        names = self.load()
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


def line_range(text: str) -> tuple[int, int | None]:
    """Lines such as 3-10, 7 or 5-: the first, and the last, which may be None."""
    found = re.fullmatch(r"(\d{0,15})(-?)(\d{0,15})", text, re.ASCII)
    if found and (found[1] or found[3]):
        first = int(found[1] or 1)
        last = int(found[3]) if found[3] else None if found[2] else first
        if 1 <= first <= (last or first):
            return first, last
    raise click.BadParameter(f"{text!r} is not a range of lines such as 3-10; lines count from 1")


def seconds(text: str) -> float:
    """Seconds of a time such as 200ms or 5s."""
    found = re.fullmatch(r"(\d*\.?\d+)(m?)s", text, re.ASCII)
    time_s = float(found[1]) / (1000 if found[2] else 1) if found else math.inf
    if time_s > 3600:
        raise click.BadParameter(f"{text!r} is not a time up to 3600s, such as 200ms")
    return time_s


def pair(text: str) -> tuple[str, str]:
    """Name and value of a text such as P07=REASON."""
    name, _, value = (part.strip() for part in text.partition("="))
    if not (name and value):
        raise click.BadParameter(f"{text!r} is not a name and a value, such as NAME=VALUE")
    return name, value


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


def command(
    example: str, *options: Callable, group: click.Group | None = None, name: str | None = None
) -> Callable[[Callable], click.Command]:
    """Make the decorator of a command, or of an action of a group.

    Parameters
    ----------
    example
        Words of an example after "vbraille"; empty for none.
    options
        Decorators of its options and arguments, listed in this order.
    group, name
        Command that it is an action of, and its name there if it is not the function's.
    """

    def decorate(function: Callable) -> click.Command:
        for each in reversed(options):
            function = each(function)
        epilog = f"Example: vbraille {example}" if example else None
        made = click.command(name, cls=Command, epilog=epilog)(function)
        if group is not None:
            group.add_command(made)
        return made

    return decorate


def _shared(*names: str, **how: Any) -> Callable:
    """Make the decorator of an option that a settings file may have."""
    SHARED.add(names[-1].removeprefix("--").replace("-", "_"))
    return option(*names, **how)


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
lines = option("--lines", type=line_range, metavar="3-10", default="1-",
               help="Lines of the page, from 1.")  # fmt: skip
table = _shared("--table", metavar="NAME", help="Translation table of liblouis.", **_TEXT)
encoding = _shared("--encoding", metavar="NAME", help="Text encoding of the file.", **_TEXT)
form = _shared("--form", metavar="NAME", help="File format: text, markdown, html, epub, dtbook, "
               "docx, odt, rtf, brf, unicode-braille or pef.", **_TEXT)  # fmt: skip
foreign = _shared("--foreign", type=click.Choice(["switch", "own"]), default="switch",
                  help="Passages in another language: switch to its table, or keep the text's own.",
                  **_TEXT)  # fmt: skip
undefined = _shared("--undefined", type=click.Choice(["mark", "drop"]), default="mark",
                    help="Characters that the table lacks: a mark, or nothing.",
                    **_TEXT)  # fmt: skip
keep_lines = _shared("--keep-lines", is_flag=True, help="Keep line breaks, as in verse.", **_TEXT)

# How braille feels
texture = _knob("texture", "Texture between the dots.")
contrast = _knob("contrast", "Share of the actuators' full swing.")
texture_cycles = _knob("texture_cycles", "Half-cycles of texture in a dot's radius; odd.")
dot_width = _knob("dot_width", "Width of a dot along the line.")
dot_spacing = _knob("dot_spacing", "Distance between the dot columns of a cell.")
cell_gap = _knob("cell_gap", "Distance between the dots of neighbouring cells.")
line_pitch = _knob("line_pitch", "Distance between lines.")
mapping = _shared("--mapping", type=Known("mapping", "vbraille.render", "MAPPINGS"), metavar="NAME",
                  help="Rows of actuators that show each row of dots.", **_FEEL)  # fmt: skip
dot_row = _shared("--dot-row", type=whole(1, 3), help="Row of dots that a VBD shows.", **_FEEL)
geometry = _shared("--geometry", type=Known("geometry", "vbraille.braille.geometry", "PRESETS"),
                   metavar="NAME", help="Distances to start from: a display's, or paper.",
                   **_FEEL)  # fmt: skip

# Device and hand
device = _shared("--device", metavar="SPEC", default="sim", show_default=True,
                 help="Device: serial:PORT, latero:HOST or sim.")  # fmt: skip
model = _shared("--model", type=Known("display model", "vbraille.render", "MODELS"), metavar="NAME",
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
profile = _shared("--profile", metavar="NAME", is_eager=True, help="Profile of the settings file.")
settings = option("--settings", type=click.Path(), metavar="FILE", is_eager=True,
                  help="Settings file to use.", **_KEPT)  # fmt: skip
no_places = _shared("--no-places", is_flag=True, help="Start at the top; keep no place.", **_KEPT)

# What a command prints or writes
json = option("--json", is_flag=True, help="Print JSON.")
csv = option("--csv", is_flag=True, help="Print CSV.")
out = option("--out", type=click.Path(), metavar="FILE", help="File to write.")
force = option("--force", is_flag=True, help="Replace files that exist.")
workers = option("--workers", type=whole(1, 1024), metavar="N", default=1, help="Processes.")

TRANSLATION = (language, grade, table, encoding, form, foreign, undefined, keep_lines)
DISTANCES = (dot_width, dot_spacing, cell_gap, line_pitch, geometry)
FEEL = (texture, contrast, texture_cycles, *DISTANCES, mapping, dot_row)
CARRIAGE = (straying, band, travel, height)
LIVE = (monitor, host, port)
HAND = (device, hand, model(group=FIRST))
AROUND = (speech, cues, also, rate, seed, *LIVE, settings)  # of commands that drive a device
