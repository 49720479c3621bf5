"""Markers for other recorders: what they are told, and one that takes nothing."""

import os
import sys
import tty
from types import ModuleType

import pytest

from tests.sessions.sittings import MINI, made
from vbraille.errors import InputError

TWO = "[[conditions]]\nname = 'flat'\ntexture = 0.0\n[[conditions]]\nname = 'rough'\n"
CODES = "[markers]\ncodes = { flat = 60, rough = 61 }\n"


def test_a_serial_port_is_sent_a_byte_an_event_and_the_condition_of_each_cue(tmp_path):
    master, slave = os.openpty()
    tty.setraw(slave)
    sat = made(tmp_path, MINI + TWO + CODES)
    sat.sit(answers="simulated", markers=f"serial:{os.ttyname(slave)}")
    sent = os.read(master, 4096)
    conditions = {t.number: t.condition for t in sat.session.content.plan.trials}
    codes = {"flat": 60, "rough": 61}
    cues = [byte for byte in sent if byte in codes.values()]
    assert cues == [codes[conditions[cue.trial]] for cue in sat.of("cue")]
    assert len(sent) == len(sat.events) - 1  # all but the plan's own
    assert any(sentence.startswith(f"markers: {len(sent)} sent") for sentence in sat.said)
    os.close(master)
    os.close(slave)


def test_a_port_that_is_gone_loses_markers_and_the_session_goes_on(tmp_path):
    master, slave = os.openpty()
    tty.setraw(slave)
    name = os.ttyname(slave)
    os.close(slave)
    sat = made(tmp_path)

    def answer(_trial):
        with_master.clear() if not with_master else os.close(with_master.pop())
        return "??"

    with_master = [master]
    sat.sit(answers=answer, markers=f"serial:{name}")
    assert sat.of("end")
    assert sum("takes none" in sentence for sentence in sat.said) == 1


def test_a_stream_is_sent_words_without_the_answer(tmp_path, monkeypatch):
    sent, pylsl = [], ModuleType("pylsl")
    pylsl.local_clock = lambda: 1000.0
    pylsl.StreamInfo = lambda *told: told

    class StreamOutlet:
        def __init__(self, info):
            assert info[:2] == ("lab", "Markers")

        def push_sample(self, sample, at_s):
            sent.append((sample[0], at_s))

    pylsl.StreamOutlet = StreamOutlet
    monkeypatch.setitem(sys.modules, "pylsl", pylsl)
    sat = made(tmp_path, MINI + TWO).sit(answers="simulated", markers="lsl:lab")
    words = [text for text, _ in sent]
    assert any(text.startswith("cue trial 1 condition ") for text in words)
    assert not any(event.data["answer"] in " ".join(words) for event in sat.of("answer"))


@pytest.mark.parametrize("spec", ["usb", "serial:", "serial:/dev/no-port-here"])
def test_a_recorder_that_is_not_there_is_refused_before_anything_begins(tmp_path, spec):
    sat = made(tmp_path)
    with pytest.raises(InputError, match=r"markers"):
        sat.sit(answers="simulated", markers=spec)
    assert not sat.of("run")
