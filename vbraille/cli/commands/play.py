"""``vbraille play``: memory with tactile cards."""

from __future__ import annotations

from typing import Any

import click

from vbraille.cli import options


@click.command(cls=options.Command, epilog="Example: vbraille play --players 2 --speech")
@options.takes(
    options.device, options.hand(default="slow", show_default=True),
    options.model(group=options.FIRST),
    options.option("--players", type=options.whole(1, 2), default=1, help="Players, 1 or 2."),
    options.option("--deck", type=click.Path(), metavar="FOLDER", help="Folder of scenes."),
    options.option("--seed", type=options.whole(0), metavar="N", help="Seed of the deal."),
    options.speech, options.monitor, options.cues, options.also, options.rate, options.host,
    options.port, options.settings,
)  # fmt: skip
@click.pass_context
def command(ctx: click.Context, **chosen: Any) -> None:
    """At a terminal, h says the keys."""
    import random
    from pathlib import Path

    from vbraille.cli.exploring import equipped, find_model, refuse_terminal, say_summary
    from vbraille.errors import InputError
    from vbraille.reading.game import DECK, Game, load_deck
    from vbraille.render import MODELS

    seed = random.randrange(1000) if chosen["seed"] is None else chosen["seed"]
    chosen["seed"] = ctx.params["seed"] = seed
    asked = MODELS[chosen["model"] or "stress2-8x8"]
    with equipped(ctx, asked.display, hand=chosen["hand"]) as equipment:
        device = equipment.device
        if not chosen["monitor"]:
            refuse_terminal(equipment.keyboard, "vbraille play")
        model = find_model(ctx, device, asked)
        if not model.display.height_mm:
            raise InputError(
                f"{model.display.name} goes along x only; cards need a device of two axes"
            )
        deck = load_deck(Path(chosen["deck"] or DECK), model.style, model.display)
        equipment.start(ctx, model)
        game = Game(
            deck, device, equipment.outputs, players=chosen["players"], seed=seed,
            attended=equipment.keyboard.attached,
        )  # fmt: skip
        game.say(f"seed: {seed}")
        game.begin()
        equipment.explore(ctx, game)
    say_summary(device)
