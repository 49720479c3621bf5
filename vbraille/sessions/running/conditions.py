"""Conditions of a run, and what they open: the source of the answers, and the sound."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from msgspec import Meta, Struct, ValidationError, convert, structs

from vbraille.errors import InputError
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.running.answers import Answers, Programmed, Scripted, Typed
from vbraille.simulation.specs import is_simulated
from vbraille.wording import setting


class Conditions(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Conditions of a run; the record keeps them, and the next run has the same.

    Parameters
    ----------
    device, hand
        Spec of the device, such as "serial:/dev/ttyACM0", and the hand of a simulated one.
    answers
        Source of the answers: "typed", "simulated:NOISE" or the name of a file.
    rate_hz
        Frames per second.
    fast
        Whether a simulated device runs as fast as the machine can.
    sound
        How the participant hears signals.
    markers
        Recorder that is sent markers: "lsl", "lsl:NAME", "serial:PORT" or "serial:PORT:BAUD".
    also
        Conventional display, such as "brlapi".
    """

    device: str = "sim"
    hand: str = "slow"
    answers: str = "typed"
    rate_hz: Annotated[float, Meta(ge=1, le=10_000)] = 1000.0
    fast: bool = False
    sound: Literal["auto", "tones", "bell", "none"] = "auto"
    markers: str = ""
    also: str = "brlapi"

    def changed(self, changes: Mapping[str, Any]) -> Conditions:
        """Return conditions with other values.

        Raises
        ------
        InputError
            If a value is out of range, or there is no such condition.
        """
        if changes.get("answers", self.answers) != self.answers:
            changes = {"fast": False, **changes}
        try:
            return convert(structs.asdict(self) | dict(changes), Conditions)
        except ValidationError as error:
            raise InputError(f"conditions: {error}") from None


def open_answers(given: Any, conditions: Conditions, progress: Progress) -> Answers:
    """Return the source of the answers: that of a spec, lines, a function, or a source itself.

    Raises
    ------
    InputError
        If there is no such source, or it cannot be used with this session.
    """
    spec = conditions.answers if given is None or isinstance(given, str) else given
    kind, _, habits = spec.partition(":") if isinstance(spec, str) else ("", "", "")
    source: Answers
    if not isinstance(spec, str):
        source = spec if hasattr(spec, "line") else Programmed(spec)
    elif spec == "typed":
        source = Typed()
    elif kind == "simulated":
        from vbraille.sessions.running.reader import Simulated

        source = Simulated(progress.protocol, progress.plan, habits)
    elif Path(spec).exists():
        source = Scripted(Path(spec), progress.script_line)
    else:
        raise InputError(f"there is no file {spec}; give typed, simulated:NOISE or a file")
    if conditions.fast and (isinstance(source, Typed) or not is_simulated(conditions.device)):
        said = "is for the simulated device, and answers that are not typed"
        raise InputError(f"{setting('fast')} {said}; leave it out")
    return source


def open_sound(wanted: str, source: Answers, say: Callable[[str], None]) -> Callable[[Any], None]:
    """Return what plays the participant's signals.

    Raises
    ------
    InputError
        If tones are asked for and there is no audio output.
    """
    from vbraille.sounds import Bell, Tones

    if wanted == "none" or (wanted == "auto" and not source.typed):
        return lambda _tone: None
    if wanted != "bell":
        try:
            return Tones().play
        except OSError as error:
            if wanted == "tones":
                raise InputError(f"{error}; give {setting('cues')} bell or none") from None
        say("sound: the terminal's bell, since there is no audio output")
    return Bell().play
