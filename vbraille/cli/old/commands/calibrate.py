"""``vbraille device calibrate``: each actuator in turn, felt or looked at."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final, Self

from vbraille.cli.old.exploring import opened_in_time
from vbraille.cli.old.reading.keyboard import STOPPED, Keyboard
from vbraille.cli.old.reading.keys import spoken
from vbraille.cli.old.terminal import print_json, say_line
from vbraille.devices.base import Placing
from vbraille.devices.calibration import LEAST_GAIN, Calibration, Tried
from vbraille.devices.calibrations import load, name_of, path_of, save
from vbraille.devices.events import placing_sentence, told
from vbraille.engine.checkup import ActuatorSwings
from vbraille.engine.clock import RealClock
from vbraille.errors import DeviceError, InputError
from vbraille.files import settings_path
from vbraille.signals import EAR

if TYPE_CHECKING:
    import argparse
    from pathlib import Path

    from vbraille.devices import Device
    from vbraille.devices.calibration import State
    from vbraille.display import Display

GAIN_STEP: Final = 0.05


@dataclass(frozen=True, slots=True)
class ActuatorRound:
    """State of a round through the actuators.

    Parameters
    ----------
    found
        What was found so far.
    now
        The actuator in turn, with what was set of it and is not found yet.
    before
        The round before the last finding, for undo; None if there was none since it began.
    """

    found: Calibration
    now: Tried
    before: ActuatorRound | None = None

    @classmethod
    def of(cls, found: Calibration) -> Self:
        """Begin at the first actuator that was not tried, or at the first of all."""
        return cls(found, _usual(found, _untried_from(found, (0, 0)) or (0, 0)))

    @property
    def shown(self) -> Calibration:
        """Calibration by which the actuator in turn swings as it is set; it is never dead there."""
        return self.found.with_tried(replace(self.now, state="ok"))

    def is_(self, state: State) -> ActuatorRound:
        """Find the actuator to be in a state, and go to the next that was not tried."""
        found = self.found.with_tried(replace(self.now, state=state))
        place = _untried_from(found, self.now.place) or _stepped(found, self.now.place, 1)
        return ActuatorRound(found, _usual(found, place), self)

    def undo(self) -> ActuatorRound | None:
        """Take the last finding back, and go to its actuator; None if there is none."""
        if self.before is not None:
            return self.before
        if not self.found.tried:
            return None
        last = self.found.tried[-1]
        return ActuatorRound(self.found.without_last(), replace(last, state="ok"))

    def go(self, steps: int) -> ActuatorRound:
        """Go to another actuator without finding anything."""
        place = _stepped(self.found, self.now.place, steps)
        return replace(self, now=_usual(self.found, place))

    def inverted(self) -> ActuatorRound:
        """Set the actuator to be inverted, or not to be."""
        return replace(self, now=replace(self.now, inverted=not self.now.inverted))

    def louder(self, steps: int) -> ActuatorRound:
        """Set the actuator's gain some steps higher, or lower."""
        gain = round(self.now.gain + steps * GAIN_STEP, 2)
        return replace(self, now=replace(self.now, gain=min(max(gain, LEAST_GAIN), 1.0)))

    @property
    def reference(self) -> tuple[int, int] | None:
        """Row and column, from 0, of the last other actuator found to be ok; None if none was."""
        others = (one for one in reversed(self.found.tried) if one.place != self.now.place)
        return next((one.place for one in others if one.state == "ok"), None)


def _usual(found: Calibration, place: tuple[int, int]) -> Tried:
    """Give the setting of an actuator as it comes in turn: that found before, or the usual one."""
    before = found.of(place)
    return Tried(*place) if before is None else replace(before, state="ok")


def _stepped(found: Calibration, place: tuple[int, int], steps: int) -> tuple[int, int]:
    """Place of an actuator some steps further in reading order; the first follows the last."""
    count = found.rows * found.columns
    row, column = place
    return divmod((row * found.columns + column + steps) % count, found.columns)


def _untried_from(found: Calibration, place: tuple[int, int]) -> tuple[int, int] | None:
    """Place of the first actuator from here on that was not tried; None if all were."""
    tried = {one.place for one in found.tried}
    around = (_stepped(found, place, steps) for steps in range(found.rows * found.columns))
    return next((place for place in around if place not in tried), None)


_KEYS: Final = {
    "space": "swing it again",
    "y or Enter": "it moves as it should",
    "w": "it is weak",
    "d": "it is dead",
    "i": "it moves the wrong way, or does not after all",
    "minus or plus": "less gain, more gain",
    "c": "swing the last one that was well, then this one",
    "u": "take the last finding back",
    "n or p": "next actuator, previous actuator, with nothing found",
    "s": "say what was found",
    "h": "say the keys",
    "q": "leave; the same command goes on from here",
}
_FINDINGS: Final[dict[str, State]] = {"y": "ok", "\n": "ok", "\r": "ok", "w": "weak", "d": "dead"}


def calibrate(arguments: argparse.Namespace, wanted: Display | None) -> int:
    """Go through a device's actuators, or say or forget what is kept of them.

    Parameters
    ----------
    arguments
        Parsed options of the command.
    wanted
        Display that the device must be; None if any will do.

    Raises
    ------
    InputError
        If there is no terminal, what is kept cannot be used, or the device makes up for its
        actuators itself.
    """
    settings = settings_path()
    if arguments.json and not arguments.show:
        raise InputError("--json prints what is kept; add --show, or leave --json out")
    with Keyboard() as keyboard, opened_in_time(arguments.spec, wanted) as device:
        path = path_of(settings, name_of(device))
        if arguments.forget:
            return _forget(path)
        if arguments.show and arguments.json:
            found = None if device.has_own_gains else load(settings, device)
            print_json(
                {
                    "device": name_of(device),
                    "own_gains": device.has_own_gains,
                    "calibration": found and found.to_json(),
                    "file": found and str(path),
                }
            )
            return 0
        if arguments.show:
            say_line(f"device: {name_of(device)}")
            say_calibration(device, settings, whole=True)
            return 0
        if device.has_own_gains:
            raise InputError(
                f"{device.display.name} has gains of its own, which are used; "
                f"change them in the device"
            )
        if not keyboard.attached:
            raise InputError("vbraille device calibrate is led by keys; start it at a terminal")
        kept = load(settings, device)
        _Guided(device, keyboard, settings, kept).run()
    return 0


def say_calibration(device: Device, settings: Path, *, whole: bool = False) -> None:
    """Say what is kept of a device's actuators, and whether it is applied.

    Raises
    ------
    InputError
        If what is kept cannot be used.
    """
    if device.has_own_gains:
        say_line("gains: the device's own, which are used")
        return
    found = load(settings, device)
    if found is None:
        say_line("calibration: none; vbraille device calibrate makes one")
        return
    sentences = list(found.sentences())
    for sentence in sentences if whole else sentences[:1]:
        say_line(sentence)
    say_line(f"calibration: {path_of(settings, found.device)}")


def _forget(path: Path) -> int:
    try:
        path.unlink()
    except FileNotFoundError:
        say_line("calibration: none was kept")
    except OSError as error:
        raise InputError(f"{path} cannot be removed: {error.strerror}") from None
    else:
        say_line("calibration: forgotten")
    return 0


class _Guided:
    """A round through the actuators at a terminal; whatever is found is on the disk at once."""

    def __init__(
        self, device: Device, keyboard: Keyboard, settings: Path, kept: Calibration | None
    ) -> None:
        info = device.display
        self._device, self._keyboard, self._settings = device, keyboard, settings
        self._round = ActuatorRound.of(
            kept or Calibration(name_of(device), info.rows, info.columns)
        )
        self._left = False
        self._placing = Placing.DONE
        self._compares = False
        self._swinging = ActuatorSwings(device, RealClock(), self._begun)

    def run(self) -> None:
        """Lead through the actuators until all were tried, or the user leaves."""
        say_line(f"device: {name_of(self._device)}")
        say_line("h says the keys")
        found = self._round.found
        if found.tried:
            say_line(f"going on: tried {len(found.tried)} of {found.rows * found.columns}")
        with self._keyboard.taken() as keys:
            try:
                self._device.correct(self._round.shown)
                self._ask()
                while not self._left:
                    self._tick()
                    if keys.must_stop:
                        self._suspend(keys)
                    for key in keys.pressed():
                        if not self._left:
                            self._press(key)
            finally:
                EAR.close()  # so that the array goes to rest
                with suppress(DeviceError):
                    self._swinging.rest()
        say_line(f"kept: {len(self._round.found.tried)} tried")

    def _tick(self) -> None:
        self._swinging.tick()
        for sentence in told(self._device.take_events()):
            say_line(sentence)
        if self._device.placing is not self._placing:
            self._placing = self._device.placing
            say_line(placing_sentence(self._placing, self._device.display))

    def _suspend(self, keys: Keyboard) -> None:
        """Stop, with the array at rest, until the shell says to go on."""
        self._swinging.stop()
        while not self._swinging.resting:
            self._tick()
        say_line(STOPPED)
        keys.stop()
        self._ask()

    def _press(self, key: str) -> None:
        if self._device.placing is Placing.STOP and key != "q":
            self._device.set_zero()
            return
        turn = self._round
        match key:
            case " ":
                self._swinging.swing(turn.now.place)
            case _ if state := _FINDINGS.get(key):
                say_line(f"found: {state}")
                self._find(turn.is_(state))
            case "i":
                self._set(turn.inverted())
                say_line(f"inverted: {'yes' if self._round.now.inverted else 'no'}")
            case "+" | "=" | "-":
                self._set(turn.louder(-1 if key == "-" else 1))
                say_line(f"gain: {100 * self._round.now.gain:.0f} %")
            case "c":
                self._compare(turn)
            case "u":
                before = turn.undo()
                if before is None:
                    say_line("undo: nothing was found")
                else:
                    self._find(before)
            case "n" | "right" | "p" | "left":
                self._set(turn.go(1 if key in ("n", "right") else -1))
                self._ask()
            case "s":
                for sentence in turn.found.sentences():
                    say_line(sentence)
            case "h" | "?":
                for name, does in _KEYS.items():
                    say_line(f"{name}: {does}")
            case "q":
                self._left = True
            case _:
                say_line(f"no command: {spoken(key)}; h says the keys")

    def _compare(self, turn: ActuatorRound) -> None:
        """Have the last actuator that was well swing, and then the one in turn."""
        well = turn.reference
        if well is None:
            say_line("compare: no other actuator was found to be well")
            return
        self._compares = True
        self._swinging.swing(well, turn.now.place)

    def _find(self, turn: ActuatorRound) -> None:
        """Go on to another round, keep what it has found, and ask of its actuator."""
        was_whole = self._round.found.whole
        self._set(turn)
        self._keep()
        if turn.found.whole and not was_whole:
            self._left = True
            for sentence in turn.found.sentences():
                say_line(sentence)
        else:
            self._ask()

    def _set(self, turn: ActuatorRound) -> None:
        """Have the actuator in turn rest, and then swing as it is set."""
        self._swinging.stop()
        while not self._swinging.resting:
            self._tick()
        self._round = turn
        self._device.correct(turn.shown)
        self._swinging.swing(turn.now.place)

    def _ask(self) -> None:
        now = self._round.now
        count = self._round.found.rows * self._round.found.columns
        number = now.row * self._round.found.columns + now.column + 1
        say_line(
            f"actuator {number} of {count}: row {now.row + 1}, column {now.column + 1}"
            f"{_so_far(self._round)}"
        )
        self._swinging.swing(now.place)

    def _begun(self, place: tuple[int, int]) -> None:
        """Say which of the two that are compared swings now."""
        if self._compares:
            say_line(f"swings: row {place[0] + 1}, column {place[1] + 1}")
            self._compares = place != self._round.now.place

    def _keep(self) -> None:
        """Keep what was found; frames go on meanwhile, since a disk may take its time."""
        with ThreadPoolExecutor(1) as pool:
            kept = pool.submit(save, self._settings, self._round.found)
            while not kept.done():
                self._tick()
            kept.result()


def _so_far(turn: ActuatorRound) -> str:
    before = turn.found.of(turn.now.place)
    if before is None:
        return ""
    inverted = ", inverted" if before.inverted else ""
    gain = f", gain {100 * before.gain:.0f} %" if before.gain < 1 else ""
    return f"; {before.state}{inverted}{gain} so far"
