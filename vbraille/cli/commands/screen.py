"""``vbraille screen``."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import click

from vbraille.cli import options


@options.command(
    "screen --device serial:/dev/ttyACM0",
    *options.HAND,
    options.option("--listen", metavar="PLACE", help="Socket for BRLTTY: a path, or HOST:PORT."),
    options.option("--connect", metavar="PLACE", help="Socket at which BRLTTY listens."),
    options.echo, options.profile, *options.FEEL, *options.CARRIAGE, *options.AROUND,
)  # fmt: skip
@click.pass_context
def command(ctx: click.Context, **chosen: Any) -> None:
    """The line that BRLTTY shows is under the hand. At a terminal, h says the keys."""
    from vbraille.cli.build import build_model
    from vbraille.cli.exploring import equipped, say_summary
    from vbraille.reading.brltty import Port
    from vbraille.reading.screen import Screen
    from vbraille.render import MODELS

    usual = MODELS[chosen["model"] or "stress2"]
    wanted = build_model(ctx, usual, usual.style.geometry.travel_mm)
    folder = os.environ.get("XDG_RUNTIME_DIR") or Path.home()
    place = chosen["connect"] or chosen["listen"] or f"{folder}/vbraille-screen"
    display = wanted.on(wanted.style.geometry, chosen["rate"])
    with equipped(ctx, display, chosen["echo"] or "none") as equipment:
        port = Port(place, connects=bool(chosen["connect"]))
        equipment.stack.callback(port.close)
        device = equipment.device
        model = equipment.find(wanted)
        equipment.start(model)
        mode = "server" if chosen["connect"] else "client"
        equipment.say(f"start BRLTTY: brltty -b vr -d {mode}:{place}")
        if not port.local:
            equipment.say(f"{place}: any program that reaches it may show text and hear keys")
        equipment.explore(Screen(port, device, equipment.outputs, model.style, equipment.keyboard))
    say_summary(device)
