"""An exploration: a book or a picture under a hand, and the one loop that goes on until it is done.

Inputs are the keys of a terminal, the device's buttons and knobs, and what a conventional display
and pages of the live view ask for; all call commands of one table.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.cli.old.reading.keyboard import POLL_S, STOPPED
from vbraille.cli.old.reading.keys import Context, spoken
from vbraille.devices.events import Placing, placing_sentence
from vbraille.engine.host import HostDiedError
from vbraille.errors import InputError

if TYPE_CHECKING:
    from vbraille.cli.old.reading.device import OpenDevice
    from vbraille.cli.old.reading.keyboard import Keyboard
    from vbraille.cli.old.reading.outputs import Output
    from vbraille.cli.old.reading.view import View


class Exploration:
    """A view under a hand, told by keys what to do until there is no more to do.

    The process can be stopped meanwhile, and a host that dies can be begun again.

    Parameters
    ----------
    view
        Text or picture that is explored, which is under the hand already.
    device
        Device that it is explored on.
    keys
        Keyboard, whose keys are taken.
    outputs
        Console, speech, cues, and whatever else shows what is under the hand.
    """

    def __init__(self, view: View, device: OpenDevice, keys: Keyboard, outputs: Output) -> None:
        self.view, self._device, self._keys, self._outputs = view, device, keys, outputs

    def run(self) -> None:
        """Go on until there is no more to do.

        Raises
        ------
        HostDiedError
            If the host is gone, and no user is there to begin another.
        VbrailleError
            If something else goes wrong with the device.
        """
        self._outputs.attend()
        if self._keys.attached:
            self.view.say(f"{self.view.key('HELP', 'h')} says the keys")
        while not self.view.done:
            self._step()
        self._outputs.attend()

    def _step(self) -> None:
        """Do what keys ask for, show that at once, then see what the device has to tell."""
        device, outputs = self._device, self._outputs
        for key in self._pressed():
            self._set_context()
            self.view.listener().press(key)
        self._set_context()
        outputs.attend()
        placing = device.placing
        try:
            events = device.poll(0.0)
        except HostDiedError as fault:
            self._start_again(fault)
            return
        if device.placing is not placing:
            self._say_place()
        outputs.attend(events)

    def _pressed(self) -> list[str]:
        """Take the keys typed; before that, the process stops for a while if it is told to."""
        if self._keys.must_stop:
            self._suspend()
        attached = self._keys.attached
        keys = self._keys.pressed(POLL_S)
        if attached and not self._keys.attached:  # whatever its keys meant
            self.view.quit()
            return []
        return keys

    def _suspend(self) -> None:
        """Stop, with the array at rest, until the shell says to go on."""
        device = self._device
        paused, device.paused = device.paused, True
        self.view.say(STOPPED)
        self._outputs.stand("stopped: the array rests")
        self._outputs.rest()
        self._keys.stop()
        device.paused = paused
        self.view.say("paused" if paused else self.view.doing)
        self._outputs.stand("")

    def _set_context(self) -> None:
        """Have keys mean that the carriage is at its place while the device waits for that."""
        view = self.view.listener()
        if self._device.placing is Placing.STOP:
            view.context = Context.PLACING
        elif view.context is Context.PLACING:
            view.context = Context.READING

    def _say_place(self) -> None:
        if self._device.placing is Placing.STOP and not self._keys.attached:
            raise InputError(
                "the device must be shown its place, such as its left stop; "
                f"{self.view.does} at a terminal"
            )
        self.view.say(placing_sentence(self._device.placing, self._device.engine.display))

    def _start_again(self, fault: HostDiedError) -> None:
        """Say that the host is gone, and begin another when asked to.

        Raises
        ------
        HostDiedError
            If there is no user to ask.
        """
        view = self.view
        self._outputs.stand(f"fault: {fault}")
        if not self._keys.attached:
            raise fault
        again, stop = view.key("PAUSE", " "), view.key("QUIT", "q")
        view.say(f"fault: {fault}; {again} begins again, {stop} stops")
        while not view.done:
            keys = [spoken(key) for key in self._pressed()]
            self._outputs.attend()
            if stop in keys:
                view.quit()
            elif again in keys:
                break
            elif keys:
                said = f"{again} begins again, {stop} stops"
                view.say(f"fault: nothing drives the device; {said}")
        if view.done:
            return
        self._device.start_again()
        view.say(view.doing)
        self._outputs.stand("")
