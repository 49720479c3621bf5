"""Commands to the device, what is typed, and the end of reading."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.reading.context import Context

if TYPE_CHECKING:
    from vbraille.reading.keyed import Keyed
    from vbraille.reading.reader import Reader


def pause(reader: Reader) -> None:
    """Rest the array at once, or go on."""
    reader.engine.paused = not reader.engine.paused
    reader.say("paused" if reader.engine.paused else "reading")


def set_zero(reader: Reader) -> None:
    """Tell the device that its carriage is at the left stop."""
    reader.engine.set_zero()


def stop(reader: Reader) -> None:
    """Stop reading; or, when keys are learnt, stop learning."""
    reader.quit()


def learn(reader: Keyed) -> None:
    """Have keys say what they do, and do nothing."""
    reader.context = Context.LEARNING
    reader.say("learn: a key says what it does; this key again or q ends it")


def end_learning(reader: Keyed) -> None:
    """Have keys do what they do again."""
    reader.context = Context.READING
    reader.say("learn: off")


def enter(reader: Keyed) -> None:
    """Take what was typed, and say it."""
    prompt = reader.prompt
    reader.prompt, reader.context = None, Context.READING
    if prompt is None:
        return
    typed = prompt.typed.strip() or prompt.again
    if not typed:
        reader.say(f"{prompt.label}: nothing was typed")
        return
    reader.say(f"{prompt.label}: {typed}")
    prompt.then(typed)


def give_up(reader: Keyed) -> None:
    """Forget what was typed."""
    prompt = reader.prompt
    reader.prompt, reader.context = None, Context.READING
    reader.say(f"{'text' if prompt is None else prompt.label}: given up")


def erase(reader: Keyed) -> None:
    """Take back the character that was typed last."""
    if reader.prompt is not None:
        reader.prompt.erase()
