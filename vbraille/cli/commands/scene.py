"""``vbraille scene``: what is done with files of tactile pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse


def run(arguments: argparse.Namespace) -> int:
    """Do what the action says."""
    from vbraille.cli.commands.scene_convert import convert

    return {"convert": convert}[arguments.action](arguments)
