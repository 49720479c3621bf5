"""The one loop: keys, what they change, and what the device has to tell, until there is no more."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from vbraille.devices.base import Placing
from vbraille.devices.events import Button, Knob, placing_sentence
from vbraille.engine.host import HostDiedError
from vbraille.errors import DeviceError, InputError
from vbraille.reading.commands import Command, bindings, spoken
from vbraille.reading.device import POLL_S

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from vbraille.reading.device import ReadingDevice
    from vbraille.reading.explored import Explored
    from vbraille.reading.keys import Keyboard
    from vbraille.reading.outputs import Console

_SETTLED_S = 0.3  # a knob that no hand has turned for so long is left where it stands
_STOPPED = "stopped: the array rests; fg goes on"


class Exploration:
    """A book, a picture, a game or a tuning course under a hand, and a person at keys.

    Parameters
    ----------
    what
        What is explored.
    device
        The device that it is shown on.
    keyboard
        Keys of the terminal.
    console
        Where a line that is typed is shown.
    sources
        Outputs that keys come from, too: ``pressed(what)`` names those since the last call, and
        ``rest()`` has them show nothing until then.
    own
        Names of commands by keys of one's own, for a book.
    """

    def __init__(
        self,
        what: Explored,
        device: ReadingDevice,
        keyboard: Keyboard,
        console: Console,
        sources: Sequence[Any] = (),
        own: Mapping[str, str] | None = None,
    ) -> None:
        self._outer, self._device = what, device
        self._keyboard, self._console, self._sources = keyboard, console, sources
        self._own = own or {}
        self._bound: tuple[object, dict[str, Command]] = None, {}
        self._turned: dict[str, tuple[float, str]] = {}  # knobs whose value is not said yet
        self._dead = False

    def run(self) -> None:
        """Go on until the book is read, or a person ends it.

        Raises
        ------
        VbrailleError
            If the device is gone, and no person can help.
        """
        attended = self._keyboard.attached
        while not self._outer.done and self._keyboard.attached is attended:
            self.step()

    @property
    def what(self) -> Explored:
        """Object of keys: what is explored, or what is felt in its place."""
        return self._outer.inside or self._outer

    def step(self) -> None:
        """Do what keys ask for, then take what the device has to tell."""
        for key in self._keyboard.pressed(POLL_S):
            self.press(key)
        self._keyboard.catch_interrupts(caught=self.what.prompt is not None)
        for source in self._sources:
            for key in source.pressed(self.what):
                self.press(key)
        if self._keyboard.must_stop:
            self._stop()
        if not self._dead:
            self._listen()
        self.what.idle(time.monotonic())
        if self._outer.inside is not None and self._outer.inside.done:
            self._outer.come_back()

    def press(self, key: str) -> None:
        """Do what a key asks for."""
        what = self.what
        if self._dead:
            self._revive(key)
        elif self._device.placing is Placing.STOP and key != "q":
            self._device.set_zero()
        elif what.prompt is not None:
            self._type(what, key)
        elif key.startswith("paste:"):
            what.say("pasted text is ignored here")
        elif key.startswith(("route:", "place:")):
            what.route(int(key.partition(":")[2]))
        else:
            self._call(what, key)

    def _call(self, what: Explored, key: str) -> None:
        if self._bound[0] is not what:
            self._bound = what, bindings(what.key_set, what.where, self._own)
        if key.startswith("command:"):
            called = next(c for c in self._bound[1].values() if c.name == key.partition(":")[2])
        else:
            called = self._bound[1].get(key)
        if called is None:
            what.say(f"{spoken(key)}: no command")
        elif what.learning and called.name not in ("learn", "quit"):
            what.say(f"{spoken(key)}: {called.help}")
        else:
            called.run(what)

    def _type(self, what: Explored, key: str) -> None:
        """Give a key to the question that is being answered."""
        if ":" in key and not key.startswith("paste:") and len(key) > 1:
            what.say("finish typing first")
            return
        prompt, what.prompt = what.prompt, None  # an answer may ask the next question
        assert prompt is not None, "a question is asked"
        if key == "enter":
            self._console.end_typing()
        try:
            said = prompt.press(key)
        except KeyError:
            what.say("cancelled")
            return
        if said is None:
            return
        what.prompt = prompt
        self._console.typing(prompt.question, prompt.text)
        for output in what.outputs:
            if said and output is not self._console:
                output.say(said)

    def _stop(self) -> None:
        """Stop as the shell asks, with the array at rest meanwhile."""
        paused = self._device.paused
        self._device.paused = True
        self._outer.say(_STOPPED)
        for source in self._sources:
            source.rest()
        self._keyboard.stop()
        self._device.paused = paused
        self._outer.say("paused" if paused else self._outer.doing)

    def _revive(self, key: str) -> None:
        """Start the process that drives the device again, or quit."""
        if key == "q":
            self._outer.done = True
        elif key == " ":
            self._device.start(self._device.model)
            self._dead = False
            self.what.steer()
            self._outer.say(self._outer.doing)
        else:
            self._outer.say("the array rests; space begins again, q stops")

    def _listen(self) -> None:
        """Take what the device has to tell."""
        what, device = self.what, self._device
        before = device.placing
        try:
            ticks, events, sentences = device.take()
        except HostDiedError as error:
            if not self._keyboard.attached:
                raise
            self._dead = True
            what.say(f"{error}; the array rests; space begins again, q stops")
            return
        for sentence in sentences:
            what.say(sentence)
        if device.placing is not before:
            if device.placing is Placing.STOP and not self._keyboard.attached:
                raise InputError("the device must be shown its place; read at a terminal")
            what.say(placing_sentence(device.placing, device.display))
        for event in events:
            if isinstance(event, Button) and event.pressed:
                self.press(f"button:{event.number}")
            elif isinstance(event, Knob):
                self._turn(what, f"knob:{event.number}", event.value)
        for knob, (due_s, said) in tuple(self._turned.items()):
            if time.monotonic() >= due_s:
                del self._turned[knob]
                what.say(said)
        if ticks.size:
            what.follow(ticks)
            if what.hopeless is not None and not self._keyboard.attached:
                raise DeviceError(what.hopeless)

    def _turn(self, what: Explored, knob: str, share: float) -> None:
        """Show the value of a knob that is being turned at once; it is said once it is left."""
        name = self._own.get(knob, "")
        if what.learning:
            said = f"{spoken(knob)}: {name or 'nothing'}"
        else:
            said = what.turn(name, round(share, 2)) if name else ""
        if said:
            self._turned[knob] = time.monotonic() + _SETTLED_S, said
