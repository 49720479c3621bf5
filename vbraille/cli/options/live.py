"""The options of the live view, which several commands have."""

from __future__ import annotations

from vbraille.cli.options.groups import whole
from vbraille.errors import InputError
from vbraille.wording import setting

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    import argparse

    from vbraille.cli.options.commandparser import CommandParser

MOST_PORT = 65_535


def add_live_options(parser: CommandParser) -> None:
    """Add ``--monitor`` and where its page is, for a command that may have a live view."""
    parser.flag(
        "--monitor", "Show a live view in a browser, at an address of this machine that is printed."
    )
    add_address_options(parser)


def add_address_options(parser: CommandParser) -> None:
    """Add ``--host`` and ``--port``, for a command that always has a page."""
    parser.option(
        "--host",
        "ADDRESS",
        "Offer the page of the live view at this address, so that others can see it who are told "
        "its token (default: to this machine only).",
    )
    parser.option(
        "--port",
        "N",
        "Offer the page of the live view at this port (default: one that is free).",
        whole,
    )


def monitor(parser: CommandParser) -> None:
    """Add the options of ``vbraille monitor``."""
    parser.option(
        "--play",
        "FILE",
        "Play back what vbraille render wrote, the directory of a session, or one of its traces "
        "(default: nothing is played).",
    )
    add_address_options(parser)


def check_live_options(arguments: argparse.Namespace) -> None:
    """Refuse options of the live view that cannot be.

    Raises
    ------
    InputError
        If there is an address without a live view, or no such port.
    """
    for name in ("host", "port"):
        if getattr(arguments, name) is not None and not getattr(arguments, "monitor", True):
            raise InputError(
                f"{setting(name)} is for the live view; add {setting('monitor')}, or leave "
                f"{setting(name)} out"
            )
    port = arguments.port
    if port is not None and not 0 <= port <= MOST_PORT:
        raise InputError(
            f"{setting('port')} is {port}; it must be 0 to {MOST_PORT}, and 0 is any that is free"
        )
    if arguments.host == "":
        raise InputError(
            f"{setting('host')} is empty; give an address of this machine, or leave it out"
        )
