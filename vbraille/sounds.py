"""Sounds: tones through the machine's audio output, or the terminal's bell."""

from __future__ import annotations

import os
import sys
import wave as wav
from contextlib import contextmanager
from typing import TYPE_CHECKING, Protocol

import numpy as np

from vbraille.errors import InputError, lacking

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

_RATE_HZ = 48_000
_RAMP_S = 0.005  # a tone swells and fades for so long, so that it does not click
_LOUDNESS = 0.5
_GAP_S = 0.02  # between the tones of a melody
MOST_BYTES = 10_000_000  # of a file of sound: a minute of it, as music is recorded
_TYPES = {1: np.dtype("u1"), 2: np.dtype("<i2"), 4: np.dtype("<i4")}  # by the bytes of a sample


class Pitched(Protocol):
    """A tone: a sine of a frequency in Hz, for a time in ms."""

    @property
    def frequency_hz(self) -> float:
        """Frequency of the sine."""
        ...

    @property
    def duration_ms(self) -> float:
        """Length of the tone."""
        ...


class Bell:
    """Sound device that rings the terminal's bell; without a terminal nothing is heard."""

    name = "bell"

    def play(self, _tone: Pitched, /) -> None:
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
            try:
                import sounddevice
            except ModuleNotFoundError:
                raise OSError(f"a tone {lacking('sounddevice')}") from None
            self._play, self._fault = sounddevice.play, sounddevice.PortAudioError
            try:
                sounddevice.check_output_settings(samplerate=_RATE_HZ, channels=1)
            except (self._fault, ValueError) as error:
                raise OSError(f"there is no audio output ({error})") from None

    def play(self, *tones: Pitched) -> None:
        """Begin to play tones one after the other, in place of what is being played.

        Raises
        ------
        OSError
            If the audio output is gone.
        """
        self._begin(melody(tones), _RATE_HZ)

    def play_file(self, path: Path) -> None:
        """Begin to play a WAV file, in place of what is being played.

        Raises
        ------
        OSError
            If the audio output is gone, or does not take the file's rate.
        InputError
            If the file cannot be played; see `read_sound`.
        """
        self._begin(*read_sound(path))

    def _begin(self, samples: NDArray[np.float32], rate_hz: int) -> None:
        try:
            with _quiet():
                self._play(samples, rate_hz)
        except (self._fault, ValueError) as error:
            raise OSError(f"the audio output is gone ({error})") from None


def read_sound(path: Path) -> tuple[NDArray[np.float32], int]:
    """Read a WAV file: float32[n, channels] from -1 to 1, and its rate in Hz.

    Raises
    ------
    InputError
        If it is not there, is larger than 10 MB, or is no WAV file of 8, 16 or 32 bits.
    """
    try:
        if not path.is_file() or path.stat().st_size > MOST_BYTES:
            most = f"a WAV file of at most {MOST_BYTES / 1e6:.0f} MB"
            raise InputError(f"sound {path} is not {most}")
        with wav.open(str(path), "rb") as file:
            kind = _TYPES[file.getsampwidth()]
            samples = np.frombuffer(file.readframes(file.getnframes()), kind)
            rate_hz, channels = file.getframerate(), file.getnchannels()
    except OSError as error:
        raise InputError(f"sound {path} cannot be read: {error.strerror}") from None
    except (wav.Error, EOFError, KeyError, ValueError):
        raise InputError(f"sound {path} is not a WAV file of 8, 16 or 32 bits") from None
    middle = 128.0 if kind.itemsize == 1 else 0.0
    whole = samples[: samples.size // channels * channels].reshape(-1, channels)
    return ((whole - middle) / 2.0 ** (8 * kind.itemsize - 1)).astype(np.float32), rate_hz


def wave(tone: Pitched) -> NDArray[np.float32]:
    """Samples of a tone that swells and fades; float32[n], at 48 kHz."""
    count = max(round(tone.duration_ms / 1000 * _RATE_HZ), 1)
    t_s = np.arange(count) / _RATE_HZ
    edges = np.minimum(t_s, t_s[-1] - t_s) / _RAMP_S
    swell = np.sin(np.pi / 2 * np.minimum(edges, 1.0)) ** 2
    return (_LOUDNESS * swell * np.sin(2 * np.pi * tone.frequency_hz * t_s)).astype(np.float32)


def melody(tones: Sequence[Pitched]) -> NDArray[np.float32]:
    """Samples of tones one after the other, with a short gap after each; float32[n], at 48 kHz."""
    gap = np.zeros(round(_GAP_S * _RATE_HZ), np.float32)
    return np.concatenate([part for tone in tones for part in (wave(tone), gap)])


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
