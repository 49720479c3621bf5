"""Options of the commands about tactile pictures."""

from __future__ import annotations

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from argparse import ArgumentParser


def check(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille scene check``."""
    parser.add_argument(
        "file", metavar="FILE", help="Check this scene, SVG or file of OpenLatero's."
    )
    parser.add_argument("--json", action="store_true", help="Print the report as JSON.")


def convert(parser: ArgumentParser) -> None:
    """Add the options of ``vbraille scene convert``."""
    parser.add_argument(
        "file", metavar="OLD", help="File of OpenLatero's (.gen, .tx) or drawing in SVG."
    )
    parser.add_argument("--out", required=True, metavar="NEW", help="Write to this scene file.")
    parser.add_argument(
        "--as-shown",
        action="store_true",
        help="Convert what OpenLatero shows, where that is not what its file says "
        "(default: what the file says).",
    )
    parser.add_argument(
        "--force", action="store_true", help="Replace the file if it is there already."
    )
