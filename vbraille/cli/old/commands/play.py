"""``vbraille play``."""

from __future__ import annotations

import secrets
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.cli.old.exploring import around_device, say_summary
from vbraille.devices.registry import check_actuators, find_driver
from vbraille.display import check_rate
from vbraille.errors import InputError
from vbraille.layout.texts import choose_table
from vbraille.reading.commands.game import BOUND
from vbraille.reading.device import HAND
from vbraille.reading.exploration import Exploration
from vbraille.reading.game import DECK, GameView, load_deck, programs_of
from vbraille.reading.keyboard import Keyboard
from vbraille.render import MODELS, model_of
from vbraille.simulation.specs import parse_hand, refuse_hand

if TYPE_CHECKING:
    import argparse

    from vbraille.cli.old.exploring import Around
    from vbraille.reading.device import OpenDevice
    from vbraille.reading.liveview import LiveView

_MODEL = "stress2-8x8"
_SEEDS = 1_000_000


def run(arguments: argparse.Namespace) -> int:
    """Play until a key says so."""
    rate_hz = check_rate(arguments.rate)
    refuse_hand(arguments.device, hand=arguments.hand, seed=None)
    hand = HAND if arguments.hand is None else arguments.hand
    parse_hand(hand)
    seed = secrets.randbelow(_SEEDS) if arguments.seed is None else arguments.seed
    wanted = replace(MODELS[arguments.model or _MODEL].display, rate_hz=rate_hz)
    find_driver(arguments.device)
    with Keyboard() as keyboard:
        if not (keyboard.attached or arguments.monitor):
            raise InputError(
                "vbraille play is led by keys or by a page; start it at a terminal, or with "
                "--monitor"
            )
        with around_device(arguments, keyboard, wanted, hand, "en") as around:
            device, outputs = around.device, around.outputs
            display = device.find()
            if arguments.model is not None:
                check_actuators(display, wanted)
            if not display.height_mm:
                raise InputError(
                    f"the carriage of {display.name} goes along x only; a card is felt along x and "
                    "y, so take a device of two axes"
                )
            folder = DECK if arguments.deck is None else Path(arguments.deck)
            model = model_of(display)
            deck = load_deck(folder, model.style, display)
            programs = programs_of(deck, display, rate_hz)
            device.start(model, max(program.nbytes for program in programs))
            keys = around.keys()
            view = GameView(
                deck,
                programs,
                device,
                players=arguments.players,
                seed=seed,
                say=outputs.say,
                bound=BOUND,
                cue=outputs.cue,
            )
            _show_also(arguments, around, view)
            device.explore(view)
            if around.live is not None:
                _show_live(around.live, device, view)
            outputs.say(f"seed: {seed}")
            view.start()
            Exploration(view, device, keys, outputs).run()
    say_summary(device, rate_hz=rate_hz)
    return 0


def _show_live(live: LiveView, device: OpenDevice, view: GameView) -> None:
    """Show how the cards lie on the pages of the live view, which turn them, too."""
    # Only a game that has a live view waits for what it needs.
    from vbraille.reading.liveview import PlayedState

    live.show(PlayedState(device, view, live.said))


def _show_also(arguments: argparse.Namespace, around: Around, view: GameView) -> None:
    """Have all that is said stand on the conventional display that was asked for."""
    if arguments.also is None:
        return
    # Only a game that has such a display needs what drives it.
    from vbraille.conventional.display import ConventionalDisplay
    from vbraille.reading.conventionalview import SentencesOnDisplay

    display = ConventionalDisplay(arguments.also)
    say, table = around.outputs.say, choose_table("en")
    around.outputs.add(SentencesOnDisplay(display, lambda: view, say, table))
