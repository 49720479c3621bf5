"""``vbraille simulate latero``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from vbraille.cli.old.controlkeys import ControlKeys
from vbraille.cli.old.terminal import say_line
from vbraille.devices.latero.device import DISPLAY
from vbraille.devices.latero.wire import BUTTONS, PORT
from vbraille.engine.realtime import come_first
from vbraille.errors import InputError
from vbraille.render.braille.models import LATERO
from vbraille.signals import EAR
from vbraille.simulation.controls import load_script, parse_presses
from vbraille.simulation.laterosim import WAIT_S, LateroCarriage, LateroFaults, LateroSimulator
from vbraille.simulation.specs import parse_hand

if TYPE_CHECKING:
    import argparse

_MOST_PORT: Final = 0xFFFF


def run(arguments: argparse.Namespace, priority: int) -> int:
    """Be a Latero until a signal says to stop, with this real-time priority if it may."""
    hand = parse_hand(arguments.hand, arguments.seed)
    script = parse_presses(arguments.press)
    if arguments.script is not None:
        script += load_script(arguments.script)
    for event in script:
        if event.knob:
            raise InputError(f"{arguments.script} turns a knob, and a Latero has none")
        if event.number > len(BUTTONS):
            raise InputError(f"button is {event.number}; a Latero has 1 and 2, left and right")
    port = PORT if arguments.udp_port is None else arguments.udp_port
    if not 0 <= port <= _MOST_PORT:
        raise InputError(f"port is {port}; it must be 0 to {_MOST_PORT}")
    lines = 1 if arguments.page_lines is None else arguments.page_lines
    pitch_mm = LATERO.style.geometry.line_pitch_mm
    most = int(DISPLAY.height_mm / pitch_mm)
    if not 1 <= lines <= most:
        raise InputError(f"lines are {lines}; a Latero has room for 1 to {most}")
    try:
        faults = LateroFaults(
            drop=arguments.drop,
            late=arguments.late or 0.0,
            double=arguments.double or 0.0,
            foreign=arguments.stray or 0.0,
            seed=arguments.seed,
        )
    except ValueError as error:
        raise InputError(str(error)) from None
    with EAR.deferred(), ControlKeys() as keys:
        simulator = LateroSimulator(
            LateroCarriage(hand, DISPLAY.span_mm, lines, pitch_mm),
            say=say_line,
            port=port,
            faults=faults,
            script=script,
            keys=keys.pressed,
            wait_s=WAIT_S if arguments.wait is None else arguments.wait,
        )
        try:
            say_line(f"device: {simulator.spec}")
            if keys.attached:
                say_line("keys: 1 and 2 press the left and the right button")
            come_first(priority)
            simulator.run(stopped=lambda: EAR.heard)
        finally:
            simulator.close()
    say_line(_summary(simulator))
    return 0


def _summary(simulator: LateroSimulator) -> str:
    board, tally = simulator.board, simulator.network.tally
    return (
        f"summary: seconds {simulator.now_us / 1e6:.1f}, frames {board.fulls}, "
        f"registers {board.raws}, other datagrams {board.foreign}, beyond rest {board.beyond}, "
        f"requests lost {tally.requests_lost}, answers lost {tally.answers_lost}, "
        f"late {tally.answers_late}, doubled {tally.requests_doubled + tally.answers_doubled}, "
        f"foreign {tally.foreign}, blades {'at rest' if board.at_rest else 'not at rest'}, "
        f"motor power {'on' if board.powered else 'off'}"
    )
