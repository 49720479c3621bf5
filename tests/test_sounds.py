"""What the participant hears."""

import os
import subprocess
import sys
from ctypes.util import find_library

import numpy as np
import pytest

from vbraille.sessions.running.runner import Tone
from vbraille.sounds import wave

# A sound card that hears everything and says nothing.
NULL_CARD = "pcm.!default { type null }\nctl.!default { type null }\n"
MISSING_CARD = "pcm.!default { type hw card 77 }\nctl.!default { type hw card 77 }\n"
PLAY = """
import time
from vbraille.sessions.running.runner import Tone
from vbraille.sounds import Tones
tones = Tones()
begun = time.monotonic()
tones.play(Tone(880.0, 60_000.0))
print(time.monotonic() - begun < 30.0)
"""


def test_a_tone_has_its_pitch_and_its_length_and_does_not_click():
    samples = wave(Tone(1000.0, 150.0))
    assert samples.dtype == np.float32
    assert samples.size == 7200  # at 48 kHz
    assert abs(samples[0]) < 1e-6
    assert abs(samples[-1]) < 1e-6
    assert np.abs(np.diff(samples)).max() < 0.1
    spectrum = np.abs(np.fft.rfft(samples))
    assert np.argmax(spectrum) * 48_000 / samples.size == pytest.approx(1000, abs=7)
    assert 0.4 < np.abs(samples).max() <= 0.5


def in_a_process(tmp_path, script, cards):
    config = tmp_path / "asound.conf"
    config.write_text(cards)
    return subprocess.run(
        [sys.executable, "-c", script], capture_output=True, encoding="utf-8", check=False,
        env={**os.environ, "ALSA_CONFIG_PATH": str(config)},
    )  # fmt: skip


@pytest.mark.skipif(find_library("portaudio") is None, reason="make sound installs PortAudio")
def test_a_tone_is_begun_and_not_waited_for(tmp_path):
    ran = in_a_process(tmp_path, PLAY, NULL_CARD)
    assert (ran.stdout, ran.stderr) == ("True\n", "")


def test_without_an_output_it_is_one_error_and_nothing_on_stderr(tmp_path):
    script = """
from vbraille.sounds import Tones
try:
    Tones()
except OSError as error:
    print(error)
"""
    ran = in_a_process(tmp_path, script, MISSING_CARD)
    assert ran.stderr == ""
    assert "audio output" in ran.stdout or "PortAudio" in ran.stdout
