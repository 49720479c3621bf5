"""The options of tactile pictures, each with a sentence of its own."""

from __future__ import annotations

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from argparse import ArgumentParser


def check(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille scene check``."""
    _scene(parser)
    parser.add_argument("--json", action="store_true", help="Print the report as JSON.")


def convert(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille scene convert``."""
    _scene(parser)
    parser.add_argument(
        "--out", required=True, metavar="FILE", help="Write the scene to this file."
    )


def _scene(parser: ArgumentParser) -> None:
    parser.add_argument(
        "file",
        metavar="FILE",
        help="Take this picture: a scene file, an SVG drawing, or a .gen file of OpenLatero's.",
    )
