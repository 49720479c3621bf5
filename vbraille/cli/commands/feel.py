"""``vbraille feel``: a tactile picture under the hand."""

from __future__ import annotations

from typing import Any

import click

from vbraille.cli import options


@click.command(cls=options.Command, epilog="Example: vbraille feel house.scene --monitor")
@options.file
@options.takes(
    options.device, options.hand(default="still", show_default=True),
    options.model(group=options.FIRST),
    options.option("--say-entering", is_flag=True,
                   help="Say each element when the finger comes to it."),
    options.option("--sounds", is_flag=True, help="Play the sounds of elements, too."),
    options.option("--zoom", type=options.Number(0.5, 16), default=1, help="Zoom to begin with."),
    options.option("--key", is_flag=True,
                   help="Show numbers for labels that do not fit; entering says the texts."),
    options.option("--y", type=options.Number(0), metavar="MM",
                   help="Height of the line to feel, on a device of one axis."),
    options.speech, options.monitor, options.cues, options.also, options.rate, options.seed,
    options.host, options.port, options.settings,
)  # fmt: skip
@click.pass_context
def command(ctx: click.Context, **chosen: Any) -> None:
    """At a terminal, h says the keys."""
    from vbraille.cli.exploring import equipped, find_model, say_summary
    from vbraille.cli.printing import say
    from vbraille.errors import InputError
    from vbraille.pictures.keys import keyed
    from vbraille.pictures.loading import check_fits, load_scene
    from vbraille.reading.picture import Picture
    from vbraille.render import MODELS
    from vbraille.scene.patterns import Label
    from vbraille.simulation.specs import is_simulated

    asked = MODELS[chosen["model"] or "stress2-8x8"]
    loaded = load_scene(chosen["file"], asked.style)
    if chosen["key"]:
        loaded, key = keyed(loaded, asked.style)
        labels = [one.text for one in key.scene.elements if isinstance(one, Label)]
        say(f"key: {'; '.join(labels)}")
    with equipped(ctx, asked.display, hand=chosen["hand"]) as equipment:
        device, attended = equipment.device, equipment.keyboard.attached
        still = chosen["hand"] == "still" and is_simulated(chosen["device"])
        if still and not (attended or chosen["monitor"]):
            raise InputError(
                "nothing would move the hand: start vbraille feel at a terminal, with --monitor, "
                "or with a hand such as --hand wide"
            )
        model = find_model(ctx, device, asked)
        _check(loaded, model.display, chosen["y"], check_fits)
        equipment.start(ctx, model, language=loaded.scene.language or "en")
        signals = equipment.signals
        picture = Picture(
            loaded,
            device,
            equipment.outputs,
            y_mm=chosen["y"],
            saying=2 if chosen["sounds"] else int(chosen["say_entering"]),
            sound=None if signals is None else signals.sound,
            goes=not still,
            attended=attended,
            zoom=chosen["zoom"],
        )
        picture.begin()
        for note in loaded.notes:
            say(f"note: {note}", aside=True)
        equipment.explore(ctx, picture)
    say_summary(device)


def _check(loaded: Any, display: Any, y_mm: float | None, check_fits: Any) -> None:
    """Refuse a picture that the carriage cannot go over, or a height that it does not need."""
    from vbraille.errors import InputError

    check_fits(loaded.scene, display)
    height_mm = loaded.scene.canvas.height_mm
    if y_mm is not None and display.height_mm:
        raise InputError(f"--y is for a device of one axis; {display.name} has two; leave it out")
    if y_mm is not None and y_mm > height_mm:
        raise InputError(f"--y {y_mm:g} mm is below the picture, which is {height_mm:g} mm high")
