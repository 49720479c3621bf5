"""Cues, as a person at a terminal hears them, and as an audio output gets them."""

import os
import select
import sys
import threading
import time
from contextlib import closing, contextmanager

import numpy as np
import pytest

from vbraille.reading.cueing import MELODIES, give
from vbraille.reading.outputs import CueKind, Cues, choose_cues
from vbraille.reading.view import Cue, SoundFile
from vbraille.sounds import melody
from vbraille.workers import Incoming, Outgoing


class Loudspeaker:
    """An audio output that writes down what it plays, and may be unplugged."""

    def __init__(self):
        self.played = []
        self.there = True

    def play_melody(self, tones):
        if not self.there:
            raise OSError("gone")
        self.played.append(tones)


@contextmanager
def terminal():
    """Standard error is a terminal; gives a function that waits for so many bells."""
    master, slave = os.openpty()
    kept, before = os.dup(2), sys.stderr
    os.dup2(slave, 2)
    sys.stderr = os.fdopen(slave, "w")

    def bells(number):
        heard = b""
        while len(heard) < number:
            assert select.select([master], [], [], 30.0)[0], heard
            heard += os.read(master, 100)
        return heard

    try:
        yield bells
    finally:
        sys.stderr.close()
        sys.stderr = before
        os.dup2(kept, 2)
        os.close(kept)
        os.close(master)


def given(cues, kind, speaker=None):
    """Run the process that gives cues, here, over these."""

    def open_tones():
        if speaker is None:
            raise OSError("no card")
        return speaker

    read, write = os.pipe()
    thread = threading.Thread(target=give, args=(Incoming(read, Cue | SoundFile), kind, open_tones))
    thread.start()
    with os.fdopen(write, "wb", buffering=0):
        for cue in cues:
            Outgoing(write).put(cue)
            yield cue
    thread.join()
    os.close(read)


def test_each_cue_is_another_melody_and_another_number_of_bells():
    assert set(MELODIES) == set(Cue)
    assert len({len(tones) for tones in MELODIES.values()}) == len(Cue)
    heights = [tuple(tone.frequency_hz for tone in tones) for tones in MELODIES.values()]
    assert len(set(heights)) == len(Cue)
    for tones in MELODIES.values():
        samples = melody(tones)
        assert samples.size < 0.5 * 48_000
        assert np.abs(np.diff(samples)).max() < 0.1  # no click


def test_cues_are_played():
    speaker = Loudspeaker()
    for cue in given([Cue.LIMIT, Cue.PAGE_END], "tones", speaker):
        end = time.monotonic() + 30.0
        while speaker.played[-1:] != [MELODIES[cue]]:
            assert time.monotonic() < end
            os.sched_yield()
    assert speaker.played == [MELODIES[Cue.LIMIT], MELODIES[Cue.PAGE_END]]


@pytest.mark.parametrize("speaker", [None, Loudspeaker()])
def test_without_an_audio_output_or_when_it_goes_the_bell_rings(speaker):
    if speaker is not None:
        speaker.there = False
    with terminal() as bells:
        for cue in given([Cue.PAGE_END, Cue.LINE_END], "tones", speaker):
            number = len(MELODIES[cue])
            assert bells(number) == b"\a" * number


def test_bells_come_from_a_process_of_its_own_ten_a_second_at_most():
    now_s = iter((0.0, 0.05, 0.0999, 5.0)).__next__
    with terminal() as bells, closing(Cues(CueKind.BELL, now_s)) as cues:
        for _ in range(3):
            cues.cue(Cue.LINE_END)
        assert bells(1) == b"\a"
        cues.cue(Cue.PAGE_END)  # neither of the two that came too soon was kept
        assert bells(2) == b"\a\a"


def test_no_cues_start_no_process():
    with closing(Cues(CueKind.NONE)) as cues:
        cues.cue(Cue.LIMIT)
        assert cues._worker is None


def test_a_process_that_ends_is_no_fault():
    with closing(Cues(CueKind.BELL, iter(range(100)).__next__)) as cues:
        cues.cue(Cue.LIMIT)
        cues._worker.process.kill()
        cues._worker.process.wait(30.0)
        for _ in range(3):
            cues.cue(Cue.LIMIT)


def test_who_is_at_no_terminal_hears_none_and_who_is_far_away_the_bell(monkeypatch):
    monkeypatch.delenv("SSH_CONNECTION", raising=False)
    assert choose_cues(None, attended=True) is CueKind.TONES
    monkeypatch.setenv("SSH_CONNECTION", "192.0.2.1 5 192.0.2.2 22")
    assert choose_cues(None, attended=True) is CueKind.BELL
    assert choose_cues(None, attended=False) is CueKind.NONE
    assert choose_cues("tones", attended=False) is CueKind.TONES
