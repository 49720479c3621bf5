"""Outputs that may have to wait: speech by a server, pins by a real BRLTTY; the loop never does."""

import sys
import time
from types import SimpleNamespace

import pytest

from tests.conventional.handytech import LNDN, ROUTE_0, Brltty, needs_brltty, until
from tests.reading.bench import Reading
from vbraille.conventional.display import load_brlapi
from vbraille.errors import InputError
from vbraille.reading.outputs import Behind, Cue, Speech
from vbraille.reading.pins import Pins
from vbraille.translate import BrailleTable

TOLD = []
WORDS = " ".join(f"word{n}" for n in range(60))


def installed():
    try:
        load_brlapi()
    except InputError:
        return False
    return True


class Slow:
    def __init__(self):
        self.done = []

    def say(self, sentence, _cue=None):
        time.sleep(0.2)
        self.done.append(sentence)

    def close(self):
        pass


def test_an_output_behind_a_thread_never_holds_the_loop():
    slow, said = Slow(), []
    output = Behind("slow", lambda: slow, said.append)
    begun_s = time.monotonic()
    for n in range(5):
        output.say(str(n), Cue.LIMIT)
    assert time.monotonic() - begun_s < 0.1
    until(lambda: len(slow.done) == 5)
    output.close()
    assert not said


def test_an_output_that_fails_says_so_once():
    def fail():
        raise OSError("nothing there")

    said = []
    output = Behind("speech", fail, said.append)
    until(lambda: said)
    output.say("more")
    output.close()
    assert said == ["no speech: nothing there"]


class Voice:
    """Client of Speech Dispatcher, as python3-speechd has it, that keeps what it is told."""

    def __init__(self, name):
        TOLD.append((name,))

    def __getattr__(self, name):
        return lambda *words: TOLD.append((name, *words))


def test_sentences_and_lines_are_spoken_and_cells_are_not(monkeypatch):
    monkeypatch.setitem(sys.modules, "speechd", SimpleNamespace(SSIPClient=Voice))
    with Reading("one two", hand="sweep:1") as reading:
        speech = Behind("speech", lambda: Speech("fr-CA"), print)
        reading.reader.outputs.append(speech)
        reading.press("i")
        until(lambda: TOLD[-1][0] == "speak" and "line 1" in TOLD[-1][1])
        speech.show(reading.reader)
        speech.say("cells: ⠁")
        speech.close()
    assert ("set_language", "fr") in TOLD
    assert TOLD[-2:] == [("speak", "one two"), ("close",)]


@pytest.mark.parametrize("spec", ["foo", "brlapi:x", "brlapi:host:port"])
def test_a_display_that_cannot_be_is_refused(spec):
    with pytest.raises(InputError, match=spec):
        Pins(spec, BrailleTable("en-ueb-g1.ctb"), print)


@needs_brltty
@pytest.mark.skipif(not installed(), reason="python3-brlapi is not installed")
def test_the_line_stands_on_the_pins_and_their_keys_are_obeyed(tmp_path):
    said = []
    with Brltty(tmp_path) as brltty, Reading(WORDS, hand="sweep:1") as reading:
        pins = Pins(f"brlapi:{brltty.host}", BrailleTable("en-ueb-g1.ctb"), said.append)
        reading.reader.outputs.append(pins)
        reading.loop._sources = [pins]

        def stands(masks):
            wanted = masks.tobytes()[:40].ljust(40, b"\0")
            return until(lambda: reading.run(0.02) or brltty.display.standing == wanted)

        stands(reading.reader.line.masks)
        assert said[-1].endswith("40 cells")
        brltty.display.press(LNDN)
        until(lambda: reading.run(0.02) or reading.line == 2)
        reading.run(0.1)
        pins.show(reading.reader)
        stands(reading.reader.line.masks)
        brltty.display.press(ROUTE_0 + 4)
        until(lambda: reading.run(0.02) or "dots" in reading.heard.said[-1])
        pins.close()


@pytest.mark.skipif(not installed(), reason="python3-brlapi is not installed")
def test_without_brltty_a_sentence_says_so_and_reading_goes_on():
    said = []
    with Reading(WORDS, hand="sweep:1") as reading:
        pins = Pins("brlapi:127.0.0.1:998", BrailleTable("en-ueb-g1.ctb"), said.append)
        reading.loop._sources = [pins]
        until(lambda: reading.run(0.02) or said)
        assert reading.press("n") == ["line 2"]
        pins.close()
