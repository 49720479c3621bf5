"""Commands of all that is explored: pause, help, quit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.reading.commands import Where, command, keys_of, spoken, table

if TYPE_CHECKING:
    from vbraille.reading.explored import Explored

_ANYWHERE = Where.ANYWHERE
_PAUSE = "pause: rest the array at once, or go on", "space"


@command(
    *_PAUSE,
    where=_ANYWHERE & ~(Where.TUNING | Where.GAME),
    first=True,
    steers=True,
    also="button:3 pins:PAUSE",
)
@command(*_PAUSE, where=Where.GAME, steers=True, also="pins:PAUSE")
def pause(what: Explored) -> None:
    what.device.paused = not what.device.paused
    what.say("paused" if what.device.paused else what.doing)


@command("help", "h f1", "f1", where=_ANYWHERE, also="pins:HELP")
def help_(what: Explored) -> None:
    for each in table(what.where):
        if each.first and keys_of(each, what.key_set):
            what.say(f"{spoken(keys_of(each, what.key_set)[0])}: {each.help}")
    what.say("question mark, then any key: what that key does; vbraille keys lists all")


@command("learn the keys: each says what it does", "? f2", where=_ANYWHERE, also="pins:LEARN")
def learn(what: Explored) -> None:
    what.learning = not what.learning
    if what.learning:
        what.say("press a key to hear what it does; q leaves")
    else:
        what.say("keys work again")


@command("quit", "q", "ctrl-d", where=_ANYWHERE, first=True)
def quit_(what: Explored) -> None:
    if what.learning:
        learn(what)
    else:
        what.done = True
