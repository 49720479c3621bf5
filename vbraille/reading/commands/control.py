"""Commands to the device, what is typed, and the end of reading."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.reading.keys import Context, spoken

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.view import Prompt, View


def pause(reader: View) -> None:
    """Rest the array at once, or go on."""
    reader.engine.paused = not reader.engine.paused
    reader.say("paused" if reader.engine.paused else reader.doing)


def set_zero(reader: View) -> None:
    """Tell the device that its carriage is at the left stop."""
    reader.engine.set_zero()


def stop(reader: View) -> None:
    """Stop reading; or, when keys are learnt, stop learning."""
    reader.quit()


def learn(reader: View) -> None:
    """Have keys say what they do, and do nothing."""
    reader.context = Context.LEARNING
    ends = reader.key("QUIT", "q")
    reader.say(f"learn: a key says what it does; this key again or {ends} ends it")


def say_keys(reader: View) -> None:
    """Say what the keys do."""
    for command in reader.bound.of(reader.context):
        if command.keys:
            reader.say(f"{command.spoken_keys}: {command.help}")


def enter(reader: View) -> None:
    """Take what was typed, and say it."""
    prompt = reader.prompt
    reader.prompt, reader.context = None, Context.READING
    if prompt is None:
        return
    typed = prompt.typed.strip() or prompt.again
    if not typed:
        reader.say(f"{prompt.label}: nothing was typed")
        return
    prompt.keep(typed)
    reader.say(f"{prompt.label}: {typed}")
    prompt.then(typed)


def give_up(reader: View) -> None:
    """Forget what was typed."""
    prompt = reader.prompt
    reader.prompt, reader.context = None, Context.READING
    reader.say(f"{'text' if prompt is None else prompt.label}: given up")


def erase(reader: View) -> None:
    """Erase the character before the cursor, without a word."""
    if reader.prompt is not None:
        reader.prompt.erase(reader.prompt.cursor - 1)


def erase_next(reader: View) -> None:
    """Erase the character at the cursor, and say the one that is there then."""
    if reader.prompt is not None:
        reader.prompt.erase(reader.prompt.cursor, reader.prompt.cursor + 1)
        _say_here(reader, reader.prompt)


def erase_word(reader: View) -> None:
    """Erase the word before the cursor, and say it."""
    if reader.prompt is not None:
        _say_erased(reader, reader.prompt.erase(reader.prompt.word_start))


def erase_start(reader: View) -> None:
    """Erase all before the cursor, and say it."""
    if reader.prompt is not None:
        _say_erased(reader, reader.prompt.erase(0))


def move(steps: int) -> Callable[[View], None]:
    """Make a command that moves the cursor, as far as there is text, and says what is there."""

    def handler(reader: View) -> None:
        if reader.prompt is not None:
            reader.prompt.move(steps)
            _say_here(reader, reader.prompt)

    return handler


def bring(step: int) -> Callable[[View], None]:
    """Make a command that brings another text to be typed, and says it."""

    def handler(reader: View) -> None:
        prompt = reader.prompt
        if prompt is None:
            return
        if prompt.bring(step):
            reader.say(f"{prompt.label}: {prompt.typed or 'nothing'}")
        else:
            reader.say(f"{prompt.label}: none {'before' if step < 0 else 'after'} this")

    return handler


def say_typed(reader: View) -> None:
    """Say what is typed so far."""
    if reader.prompt is not None:
        reader.say(f"{reader.prompt.label}: {reader.prompt.typed or 'nothing'}")


def _say_here(reader: View, prompt: Prompt) -> None:
    reader.say(f"cursor: {spoken(prompt.here, typed=True) if prompt.here else 'end'}")


def _say_erased(reader: View, text: str) -> None:
    reader.say(f"erased: {text.strip() or 'nothing'}")
