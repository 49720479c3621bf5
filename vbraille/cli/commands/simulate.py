"""``vbraille simulate``."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import click

from vbraille.cli import options
from vbraille.cli.printing import say

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

_HEIGHT_MM = 200.0  # of a carriage of two axes whose display has none of its own
_PRIORITY = 41  # above the engine: a real controller has a processor of its own
_FAULTS: Any = {"group": "Faults"}
_share = options.Number(0, 1)


_press = options.option("--press", metavar="MOVES", default="", help="Moves of buttons and knobs, "
                        "such as 1@2.5s, 2@4s-5s or knob 1 0.8@4s.")  # fmt: skip


def _time(name: str, help: str) -> Callable:  # noqa: A002 - click's word
    """Return the option of a time after which, or for which, something goes wrong."""
    return options.option(name, type=options.seconds, default="0s", metavar="TIME", help=help,
                          **_FAULTS)  # fmt: skip


@click.group(cls=options.Group)
def command() -> None:
    """It runs until Ctrl-C."""


@command.action(
    "simulate serial --link ./vb0 --hand slow",
    options.model(group=options.FIRST, default="stress2", show_default=True),
    options.hand, options.seed,
    options.option("--link", type=click.Path(), metavar="PATH", help="Link to make to the port."),
    options.option("--axes", type=click.Choice(["x", "xy", "xyθ"]), default="x", show_default=True,
                   help="Axes that are measured."),
    options.option("--unplaced", is_flag=True, help="Do not know the place before it is told."),
    _press,
    options.travel, options.height,
    options.rate(type=options.whole(50, 1000)),
    options.option("--drop", type=_share, default=0.0, help="Share of messages that are lost.",
                   **_FAULTS),
    options.option("--corrupt", type=_share, default=0.0, help="Share of messages with a wrong "
                   "bit.", **_FAULTS),
    _time("--unplug-every", "Time between unpluggings, such as 5s; needs --link."),
    _time("--hold", "Time for which a USB adapter holds bytes, such as 16ms."),
    _time("--boot", "Time for which the board starts, such as 1.5s."),
    options.option("--defect", metavar="NAME",
                   type=options.Known("defect", "vbraille.simulation.simulator", "Defect"),
                   help="Way in which it is built wrong.", **_FAULTS),
)  # fmt: skip
def serial(**chosen: Any) -> None:
    """Simulate a device at a serial port."""
    from dataclasses import replace

    from vbraille.errors import InputError
    from vbraille.render import MODELS
    from vbraille.simulation.carriage import area_of
    from vbraille.simulation.controls import Controls, parse_moves
    from vbraille.simulation.pty import Port
    from vbraille.simulation.simulator import Defect, Faults, Simulator
    from vbraille.simulation.specs import parse_hand

    if chosen["unplug_every"] and not chosen["link"]:
        raise click.UsageError("--unplug-every needs --link: the port has a new name each time")
    model = MODELS[chosen["model"]]
    geometry = model.style.geometry
    height_mm = 0.0
    if "y" in chosen["axes"]:
        height_mm = chosen["height"] or model.display.height_mm or _HEIGHT_MM
    try:
        if chosen["travel"]:
            geometry = replace(geometry, travel_mm=chosen["travel"])
        display = model.on(geometry, chosen["rate"])
        display = replace(display, height_mm=height_mm, turns="θ" in chosen["axes"])
        faults = Faults(
            drop=chosen["drop"],
            corrupt=chosen["corrupt"],
            hold_ms=1000 * chosen["hold"],
            boot_s=chosen["boot"],
            unplug_every_s=chosen["unplug_every"],
            defect=Defect(chosen["defect"]) if chosen["defect"] else None,
            seed=chosen["seed"],
        )
        hand = parse_hand(chosen["hand"], chosen["seed"])
        controls = Controls(parse_moves(chosen["press"]))
        with _running() as (stopped, keys):
            port = Port(chosen["link"])
            try:
                simulator = Simulator(
                    display, hand, port, say=say, faults=faults, placed=not chosen["unplaced"],
                    area=area_of(display, geometry.line_pitch_mm), controls=controls, keys=keys,
                )  # fmt: skip
                say(f"port: {port.path}")
                if chosen["link"]:
                    say(f"link: {chosen['link']}")
                say("keys: 1 to 8 press a button; a to d turn a knob up, A to D down")
                simulator.run(stopped)
            finally:
                port.unplug()
    except ValueError as error:
        raise InputError(str(error)) from None
    controller = simulator.controller
    say(f"summary: seconds {simulator.now_us / 1e6:.1f}, frames {controller.frames}, "
        f"dropped {controller.dropped}, trips {controller.trips}")  # fmt: skip


@command.action(
    "simulate latero --hand slow",
    options.hand, options.seed,
    options.option("--udp-port", type=options.whole(0, 65_535), help="UDP port; 0 for any."),
    options.option("--page-lines", type=options.whole(1, 15), metavar="N", default=1,
                   help="Lines of the page that the hand reads."),
    options.option("--wait", type=options.seconds, default="1s", metavar="TIME",
                   help="Time for which the hand waits at the lower left."),
    _press,
)  # fmt: skip
def latero(**chosen: Any) -> None:
    """Simulate a Latero on the network."""
    from vbraille.devices.latero.wire import BUTTONS, PORT
    from vbraille.errors import InputError
    from vbraille.render.braille.models import LATERO
    from vbraille.simulation.controls import parse_moves
    from vbraille.simulation.laterosim import LateroCarriage, LateroSimulator
    from vbraille.simulation.specs import parse_hand

    events = parse_moves(chosen["press"])
    if any(event.knob or event.number > len(BUTTONS) for event in events):
        raise InputError("a Latero has two buttons, 1 and 2, and no knobs")
    hand = parse_hand(chosen["hand"], chosen["seed"])
    pitch_mm = LATERO.style.geometry.line_pitch_mm
    port = PORT if chosen["udp_port"] is None else chosen["udp_port"]
    with _running() as (stopped, keys):
        simulator = LateroSimulator(
            LateroCarriage(hand, chosen["page_lines"], pitch_mm),
            say=say, port=port, script=events, keys=keys, wait_s=chosen["wait"],
        )  # fmt: skip
        try:
            say(f"device: {simulator.spec}")
            say("keys: 1 and 2 press the left and the right button")
            simulator.run(stopped)
        finally:
            simulator.close()
    board = simulator.board
    say(f"summary: seconds {simulator.now_us / 1e6:.1f}, frames {board.fulls}, "
        f"blades {'at rest' if board.at_rest else 'not at rest'}")  # fmt: skip


@contextmanager
def _running() -> Iterator[tuple[Callable[[], bool], Callable[[], Iterable[str]]]]:
    """Run until a signal; a function that tells so, and one that returns the keys typed."""
    from vbraille.engine.realtime import come_first
    from vbraille.reading.keys import Keyboard
    from vbraille.signals import EAR

    with EAR.deferred(), Keyboard() as keyboard:
        come_first(_PRIORITY)
        yield lambda: EAR.heard, lambda: keyboard.pressed(0.0)
