"""The options of every command."""

from __future__ import annotations

import argparse
import os

from vbraille import __version__
from vbraille.cli.optionvalues import Pairs, duration, lines, marks, names, number, seed, whole
from vbraille.errors import InputError

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import NoReturn

MAPPINGS = ("alternate", "paired", "sheared", "split-columns", "row-sheared", "compact")
PLOTS = ("profile", "mapping", "wave", "strain", "page")


class _Help(argparse.HelpFormatter):
    """Help without a look at the terminal, which would load half the standard library."""

    def __init__(self, prog: str) -> None:
        columns = os.environ.get("COLUMNS", "")
        super().__init__(prog, width=int(columns) - 2 if columns.isdecimal() else 78)


class _Parser(argparse.ArgumentParser):
    """A parser whose errors are one sentence."""

    def __init__(self, **options) -> None:
        super().__init__(**options, formatter_class=_Help, allow_abbrev=False)

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message} ({self.prog} --help says what there is)")


def parse(argv: Sequence[str] | None) -> argparse.Namespace:
    """Read the command line.

    Raises
    ------
    InputError
        If it cannot be understood.
    """
    parser = _Parser(
        prog="vbraille",
        description="Read braille under one fingertip, on a page as large as you like.",
    )
    parser.add_argument("--version", action="version", version=f"vbraille {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    def command(name: str, text: str) -> argparse.ArgumentParser:
        return commands.add_parser(name, help=text, description=f"{text}.")

    read = command("read", "Read a text on a device, line after line")
    _text_options(read)
    _show_options(read)
    read.add_argument(
        "--device", default="sim", metavar="SPEC", help="sim (default), serial:/dev/ttyACM0, …"
    )
    read.add_argument(
        "--advance",
        choices=("return", "key"),
        default="return",
        help="next line when the hand returns (default), or by key",
    )
    read.add_argument(
        "--echo",
        choices=("none", "text", "cells", "both"),
        help="what to say of each line (default: none at a terminal, else both)",
    )
    _hand_options(read)

    page = command("page", "Print the laid-out page")
    _text_options(page)
    _page_options(page)
    page.add_argument(
        "--format",
        choices=("unicode", "brf", "dots", "text"),
        default="unicode",
        help="Unicode braille (default), ASCII braille, dot numbers, or the text of each line",
    )

    render = command("render", "Write every frame of a reading to an HDF5 file")
    _text_options(render)
    _show_options(render)
    _hand_options(render)
    render.add_argument("--out", required=True, metavar="FILE.h5", help="the file to write")
    render.add_argument("--plain", action="store_true", help="progress as lines, without a bar")

    plot = command("plot", "Draw a picture, or print its numbers")
    plot.add_argument("kind", choices=PLOTS, metavar="KIND", help=", ".join(PLOTS))
    _text_options(plot, optional=True)
    _show_options(plot)
    plot.add_argument("--out", metavar="F.png|F.svg", help="the picture to write")
    plot.add_argument("--csv", action="store_true", help="print the numbers instead")
    plot.add_argument(
        "--at", type=number, default=20.0, metavar="MM", help="page: where the array is (20)"
    )
    plot.add_argument("--letter", help="mapping: the letter shown (z)")
    plot.set_defaults(model=None)  # the one that the source drew the figure for

    _simulate_options(command("simulate", "Be a device, at a port that a program can read on"))

    _device_options(command("device", "Say which devices there are, and try one"))

    _session_options(command("session", "Run legibility sessions, and keep every answer"))

    _analyse_options(command("analyse", "Make tables, statistics and a report of sessions"))

    tables = command("tables", "List the braille tables there are")
    tables.add_argument("--language", metavar="TAG", help="only of this language, such as fr")

    arguments = parser.parse_args(argv)
    for name, value in vars(arguments).items():
        if (
            isinstance(value, list) and name != "paths"
        ):  # Python before 3.13 takes the value of --name=-- away
            parser.error(f"argument --{name.replace('_', '-')}: expected one argument")
    return arguments


def _device_options(parser: argparse.ArgumentParser) -> None:
    actions = parser.add_subparsers(
        dest="action", required=True, metavar="ACTION", parser_class=_Parser
    )
    actions.add_parser("list", help="the serial ports, with names and ids")
    for name, text in (
        ("info", "what a device says of itself"),
        ("check", "swing each actuator, hold the rate, measure the round trip, and judge"),
    ):
        action = actions.add_parser(name, help=text, description=f"{text.capitalize()}.")
        action.add_argument("spec", metavar="SPEC", help="serial:/dev/ttyACM0, …")
        action.add_argument("--model", choices=("stress2", "vbd"), help="that it must be")


def _session_options(parser: argparse.ArgumentParser) -> None:
    actions = parser.add_subparsers(
        dest="action", required=True, metavar="ACTION", parser_class=_Parser
    )

    def action(name: str, text: str) -> argparse.ArgumentParser:
        return actions.add_parser(name, help=text, description=f"{text.capitalize()}.")

    protocols = action("protocols", "what there is; with a name, its file, to be copied and edited")
    protocols.add_argument("name", nargs="?", metavar="NAME", help="print this one's TOML")

    plan = action("plan", "print the whole order of a session")
    _plan_options(plan)
    plan.add_argument("--brf", action="store_true", help="the strings as ASCII braille, to emboss")

    run = action("run", "run a session; one line an event, help says what to type")
    _plan_options(run)
    run.add_argument("--out", metavar="DIR", help="its directory (PARTICIPANT-PROTOCOL-TIME)")
    _conduct_options(run)
    run.set_defaults(device="sim", answers="typed", hand="device", rate=1000.0)
    run.add_argument("--rate", type=number, metavar="HZ", help="frames a second (1000)")
    run.add_argument(
        "--field",
        action=Pairs,
        default={},
        metavar="NAME=VALUE",
        help="what the protocol asks about the participant; may be given again",
    )

    resume = action("resume", "go on with a session, at the next trial of the same order")
    resume.add_argument("folder", metavar="DIR", help="the session's directory")
    _conduct_options(resume)

    export = action("export", "make tables of a session")
    export.add_argument("folder", metavar="DIR", help="the session's directory")
    export.add_argument(
        "--out", metavar="FILE|DIR", help="trials as CSV (default: printed); with --bids, a dataset"
    )
    export.add_argument(
        "--bids", action="store_true", help="*_beh.tsv with its sidecar, traces as *_physio.tsv.gz"
    )

    check = action("check", "see whether every file of a session is whole and consistent")
    check.add_argument("folder", metavar="DIR", help="the session's directory")


def _plan_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("protocol", metavar="PROTOCOL", help="a name, or a file such as mine.toml")
    parser.add_argument("--participant", required=True, metavar="P07", help="a pseudonym")
    parser.add_argument("--seed", type=seed, metavar="N", help="of the order (drawn, and said)")
    parser.add_argument(
        "--order",
        type=whole,
        metavar="N",
        help="of the balanced orders (by the number in the participant's name)",
    )
    parser.add_argument("--texture", type=number, metavar="0…1", help="where no condition sets it")
    parser.add_argument("--contrast", type=number, metavar="0…1", help="where no condition does")


def _conduct_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--device", metavar="SPEC", help="sim (default), serial:/dev/ttyACM0, …")
    parser.add_argument(
        "--answers",
        metavar="SOURCE",
        help="typed (default), a file with a line for each trial, simulated[:NOISE]",
    )
    parser.add_argument("--hand", metavar="HAND", help="of the simulated device (device)")
    parser.add_argument("--fast", action="store_true", help="simulated: as fast as the machine can")
    parser.add_argument(
        "--sound",
        choices=("auto", "tones", "bell", "none"),
        default="auto",
        help="how the participant hears signals (auto: tones if there is an audio output)",
    )


def _analyse_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "paths",
        nargs="*",
        metavar="DIR|trials.csv",
        help="directories of sessions, or tables with columns participant, condition, presented, "
        "answered",
    )
    parser.add_argument(
        "--scores", metavar="FILE.csv", help="instead: participant, what was varied, score"
    )
    parser.add_argument(
        "--out", metavar="DIR", help="report.html and .md, every table as CSV, figures as SVG, PNG"
    )
    parser.add_argument("--json", action="store_true", help="print the results as JSON")
    parser.add_argument("--protocol", metavar="NAME", help="only trials of this protocol")
    parser.add_argument(
        "--exclude",
        action=Pairs,
        default={},
        metavar="P07=REASON",
        help="leave a participant out, and say why in the report; may be given again",
    )
    parser.add_argument(
        "--factors",
        type=names,
        metavar="NAME,NAME",
        help="compare trials by these columns, such as texture,contrast (condition)",
    )
    parser.add_argument(
        "--correction",
        choices=("none", "bonferroni", "holm", "fdr"),
        default="none",
        help="of t-tests for their number (none)",
    )
    parser.add_argument(
        "--marks",
        type=marks,
        metavar="N,N",
        help="mark errors above these counts in confusion matrices (4,9)",
    )
    parser.add_argument("--seed", type=seed, metavar="N", help="of bootstraps (20090618)")


def _text_options(parser: argparse.ArgumentParser, *, optional: bool = False) -> None:
    parser.add_argument("file", metavar="FILE", nargs="?" if optional else None, help="a text file")
    parser.add_argument("--table", metavar="NAME", help="a liblouis table")
    parser.add_argument("--language", metavar="TAG", help="instead of a table (en)")
    parser.add_argument("--grade", type=whole, metavar="N", help="of the language's braille")
    parser.add_argument("--encoding", metavar="NAME", help="of the text, if it is not what it says")
    parser.add_argument(
        "--undefined",
        choices=("mark", "name", "code", "drop"),
        default="mark",
        help="what to write for a character that the table does not know: a marker such as [?] "
        "(default), its name in Unicode, its number, or nothing; they are counted at the end",
    )
    parser.add_argument(
        "--keep-lines", action="store_true", help="keep the text's line breaks (verse, code)"
    )
    parser.add_argument(
        "--lines", type=lines, default=(1, None), metavar="3-10", help="of the book, from 1"
    )


def _page_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--model", choices=("stress2", "vbd"), default="stress2", help="the display (stress2)"
    )
    parser.add_argument(
        "--geometry", choices=("stress2", "vbd", "standard"), help="distances to start from"
    )
    for name, text in (
        ("dot-width", "of a dot along the line"),
        ("dot-spacing", "between the two dot columns of a cell"),
        ("cell-gap", "from a cell's right dot column to the next cell's left one"),
        ("line-pitch", "between lines"),
        ("travel", "of the carriage; the source gives none, 300 is vbraille's own"),
    ):
        parser.add_argument(f"--{name}", type=number, metavar="MM", help=text)


def _show_options(parser: argparse.ArgumentParser) -> None:
    _page_options(parser)
    parser.add_argument("--texture", type=number, metavar="0…1", help="level of texture")
    parser.add_argument(
        "--texture-cycles", type=whole, metavar="K", help="stress2: half-cycles a radius, odd (7)"
    )
    parser.add_argument("--contrast", type=number, metavar="0…1", help="share of the full swing")
    parser.add_argument("--mapping", choices=MAPPINGS, help="stress2: dots to actuator rows")
    parser.add_argument("--dot-row", type=whole, metavar="1|2|3", help="vbd: the row shown (1)")


def _hand_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--hand",
        default="sweep:60",
        metavar="HAND",
        help="simulated: sweep:SPEED in mm/s (sweep:60), device, fluent, recorded:FILE.csv",
    )
    parser.add_argument("--seed", type=seed, default=1, help="of the hand's chances (1)")
    parser.add_argument(
        "--rate", type=number, default=1000.0, metavar="HZ", help="frames a second (1000)"
    )


def _simulate_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--model", choices=("stress2", "vbd"), default="stress2", help="the display (stress2)"
    )
    _hand_options(parser)
    parser.set_defaults(rate=1000)
    parser.add_argument("--link", metavar="PATH", help="a link to its port, to be made and removed")
    parser.add_argument(
        "--encoder",
        choices=("absolute", "index", "incremental"),
        default="absolute",
        help="what it knows of its carriage's place when it starts: all (default), "
        "nothing before its mark, nothing",
    )
    parser.add_argument("--travel", type=number, metavar="MM", help="of the carriage (300)")
    for name in ("drop", "corrupt"):
        parser.add_argument(
            f"--{name}", type=number, default=0.0, metavar="0…1", help=f"messages it {name}s"
        )
    for name, text in (
        ("stall", "do nothing for so long every second, such as 200ms"),
        ("unplug-every", "be unplugged so long after each greeting, such as 5s; needs --link"),
    ):
        parser.add_argument(f"--{name}", type=duration, default=0.0, metavar="DURATION", help=text)
