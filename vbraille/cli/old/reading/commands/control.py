"""Commands to the device, what is typed, and the end of reading."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.cli.old.reading.keys import Context

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.cli.old.reading.view import Prompt, View


def pause(view: View) -> None:
    """Rest the array at once, or go on."""
    view.engine.paused = not view.engine.paused
    view.say("paused" if view.engine.paused else view.doing)


def set_zero(view: View) -> None:
    """Tell the device that its carriage is at the left stop."""
    view.engine.set_zero()


def stop(view: View) -> None:
    """Stop reading; or, when keys are learnt, stop learning."""
    view.quit()


def learn(view: View) -> None:
    """Have keys say what they do, and do nothing."""
    view.context = Context.LEARNING
    ends = view.key("QUIT", "q")
    view.say(f"learn: a key says what it does; this key again or {ends} ends it")


def say_keys(view: View) -> None:
    """Say what the keys do."""
    for command in view.bound.of(view.context):
        if command.keys:
            view.say(f"{command.spoken_keys}: {command.help}")


def enter(view: View) -> None:
    """Take what was typed, and say it."""
    prompt = view.prompt
    view.prompt, view.context = None, Context.READING
    if prompt is None:
        return
    typed = prompt.typed.strip() or prompt.again
    if not typed:
        view.say(f"{prompt.label}: nothing was typed")
        return
    prompt.keep(typed)
    view.say(f"{prompt.label}: {typed}")
    prompt.then(typed)


def give_up(view: View) -> None:
    """Forget what was typed."""
    prompt = view.prompt
    view.prompt, view.context = None, Context.READING
    view.say(f"{'text' if prompt is None else prompt.label}: given up")


def edit(view: View, change: Callable[[Prompt], str]) -> None:
    """Change what is typed, and say what has come of it, if anything is to be said."""
    if view.prompt is not None and (sentence := change(view.prompt)):
        view.say(sentence)
