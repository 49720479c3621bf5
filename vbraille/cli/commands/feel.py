"""``vbraille feel``: a tactile picture under the hand."""

from __future__ import annotations

from typing import Any

import click

from vbraille.cli import options


@options.command(
    "feel house.scene --monitor",
    options.file,
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
    *options.AROUND,
)  # fmt: skip
@click.pass_context
def command(ctx: click.Context, **chosen: Any) -> None:
    """At a terminal, h says the keys."""
    from vbraille.cli.exploring import equipped, say_summary
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
    with equipped(ctx, asked.display) as equipment:
        attended, y_mm = equipment.keyboard.attached, chosen["y"]
        still = chosen["hand"] == "still" and is_simulated(chosen["device"])
        if still and not (attended or chosen["monitor"]):
            raise InputError(
                "nothing would move the hand: start vbraille feel at a terminal, with --monitor, "
                "or with a hand such as --hand wide"
            )
        model = equipment.find(asked)
        name, height_mm = model.display.name, loaded.scene.canvas.height_mm
        check_fits(loaded.scene, model.display)
        if y_mm is not None and model.display.height_mm:
            raise InputError(f"--y is for a device of one axis; {name} has two; leave it out")
        if y_mm is not None and y_mm > height_mm:
            raise InputError(
                f"--y {y_mm:g} mm is below the picture, which is {height_mm:g} mm high"
            )
        equipment.start(model, language=loaded.scene.language or "en")
        sound = (output.sound for output in equipment.outputs if hasattr(output, "sound"))
        picture = Picture(
            loaded,
            equipment.device,
            equipment.outputs,
            y_mm=y_mm,
            saying=2 if chosen["sounds"] else int(chosen["say_entering"]),
            sound=next(sound, None),
            goes=not still,
            attended=attended,
            zoom=chosen["zoom"],
        )
        picture.begin()
        for note in loaded.notes:
            say(f"note: {note}", aside=True)
        equipment.explore(picture)
    say_summary(equipment.device)
