"""Sounds that the participant hears: the start signal and the warning."""

from __future__ import annotations

import os
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING, Protocol

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.sessions.planning.conduct import Tone

_RATE_HZ = 48_000
_RAMP_S = 0.005  # a tone swells and fades for so long, so that it does not click
_LOUDNESS = 0.5


class Sound(Protocol):
    """Device that plays a tone without waiting for its end."""

    name: str

    def play(self, tone: Tone, /) -> None:
        """Begin to play a tone."""
        ...


class Silence:
    """Sound device that plays nothing, where nobody listens."""

    name = "none"

    def play(self, _tone: Tone, /) -> None:
        """Ignore a tone."""


class Bell:
    """Sound device that rings the terminal's bell; without a terminal nothing is heard."""

    name = "bell"

    def play(self, _tone: Tone, /) -> None:
        """Ring the bell once for any tone."""
        if sys.stderr.isatty():
            os.write(sys.stderr.fileno(), b"\a")


class Tones:
    """Sound device that uses the machine's audio output, through PortAudio.

    Raises
    ------
    OSError
        If PortAudio or an audio output is missing.
    """

    name = "tones"

    def __init__(self) -> None:
        with _quiet():
            import sounddevice

            try:
                sounddevice.check_output_settings(samplerate=_RATE_HZ, channels=1)
            except (sounddevice.PortAudioError, ValueError) as error:
                raise OSError(f"there is no audio output ({error})") from None
        self._play = sounddevice.play

    def play(self, tone: Tone, /) -> None:
        """Begin to play a tone."""
        self._play(wave(tone), _RATE_HZ)


def wave(tone: Tone) -> NDArray[np.float32]:
    """Samples of a tone that swells and fades; float32[n], at 48 kHz."""
    count = max(round(tone.duration_ms / 1000 * _RATE_HZ), 1)
    t_s = np.arange(count) / _RATE_HZ
    edges = np.minimum(t_s, t_s[-1] - t_s) / _RAMP_S
    swell = np.sin(np.pi / 2 * np.minimum(edges, 1.0)) ** 2
    return (_LOUDNESS * swell * np.sin(2 * np.pi * tone.frequency_hz * t_s)).astype(np.float32)


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep stderr silent meanwhile, where ALSA reports every card that it does not find."""
    kept = os.dup(2)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)
