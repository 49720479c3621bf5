"""``vbraille play``: memory with tactile cards."""

from __future__ import annotations

from typing import Any

import click

from vbraille.cli import options


@options.command(
    "play --players 2 --speech",
    options.device, options.hand(default="slow", show_default=True),
    options.model(group=options.FIRST),
    options.option("--players", type=options.whole(1, 2), default=1, help="Players, 1 or 2."),
    options.option("--deck", type=click.Path(), metavar="FOLDER", help="Folder of scenes."),
    *options.AROUND,
)  # fmt: skip
@click.pass_context
def command(ctx: click.Context, **chosen: Any) -> None:
    """At a terminal, h says the keys."""
    import random
    from pathlib import Path

    from vbraille.cli.exploring import equipped, refuse_terminal, say_summary
    from vbraille.cli.settings import is_default
    from vbraille.errors import InputError
    from vbraille.reading.game import DECK, Game, load_deck
    from vbraille.render import MODELS

    if is_default(ctx, "seed"):
        ctx.params["seed"] = random.randrange(1000)
    seed = ctx.params["seed"]
    asked = MODELS[chosen["model"] or "stress2-8x8"]
    with equipped(ctx, asked.display) as equipment:
        device, attended = equipment.device, equipment.keyboard.attached
        if not chosen["monitor"]:
            refuse_terminal(equipment.keyboard, "vbraille play")
        model = equipment.find(asked)
        if not model.display.height_mm:
            raise InputError(
                f"{model.display.name} goes along x only; cards need a device of two axes"
            )
        deck = load_deck(Path(chosen["deck"] or DECK), model.style, model.display)
        equipment.start(model)
        outputs, players = equipment.outputs, chosen["players"]
        game = Game(deck, device, outputs, players=players, seed=seed, attended=attended)
        game.say(f"seed: {seed}")
        game.begin()
        equipment.explore(game)
    say_summary(device)
