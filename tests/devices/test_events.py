"""Events: through JSON and back the same, and a sentence for each."""

import json
from dataclasses import replace

import pytest

from vbraille.devices import events
from vbraille.devices.base import Placing
from vbraille.devices.events import (
    Back,
    Button,
    Changed,
    Difference,
    Exposed,
    Fault,
    HandHeld,
    Knob,
    Notice,
    NotInTime,
    Placed,
    Silent,
    Stalled,
    Stranger,
    Unplugged,
    WatchdogTripped,
    from_json,
    is_known,
    placing_sentence,
    shortened,
    to_json,
    told,
)
from vbraille.devices.latero.device import DISPLAY as LATERO
from vbraille.display import Display

SAID = [
    (Unplugged(), "device: unplugged; plug it in again and reading goes on"),
    (
        Silent(101.5),
        "device: silent, and sent to rest; reading goes on once it speaks",
    ),
    (
        Stalled(1020.0),
        "device: its driver has not answered for 1 s; reading goes on once it does",
    ),
    (Back(times=3), "device: back (3 times in the last second)"),
    (
        Stranger("A", "B", (Difference("levels", 2, 1024), Difference("rest_side", "l", "r"))),
        "device: B came back in its place (levels 1024, not 2, rest side r, not l); plug in A "
        "again and reading goes on",
    ),
    (
        Stranger("A", version=3),
        "device: a device of version 3 of the protocol came back, and this vbraille speaks "
        "version 2; plug in A again and reading "
        "goes on",
    ),
    (
        Stranger("A", fault="rows is 0"),
        "device: what came back says in its INFO what cannot be: rows is 0",
    ),
    (
        Changed((Difference("encoder", "index", "absolute"),), gain=2, placing=Placing.MARK),
        "device: changed, for its encoder is absolute, not index, 2 of its actuators have "
        "another gain; if asked to, move the carriage over its mark",
    ),
    (
        WatchdogTripped(4),
        "device: no frame reached it in time, so it went to rest; reading goes on",
    ),
    (
        WatchdogTripped(4, "host"),
        "device: this computer was late, and no frame reached it in time, so it went to rest; "
        "reading goes on",
    ),
    (Notice(200, "Warm."), "device: Warm."),
    (Notice(200, ""), "device: notice 200"),
    (Fault("A", 3, "Too hot."), "A: Too hot."),
    (Fault("A", 3), "A: error 3"),
    (Fault("A"), "A has a fault; switch it off and on, and try again"),
    (Button(1, pressed=True), "device: button 1 pressed"),
    (Button(2, pressed=False), "device: button 2 let go"),
    (Knob(1, 0.25), "device: knob 1 at 25%"),
    (HandHeld(held=True), "hand: moved in the live view"),
    (HandHeld(held=False), "hand: simulated again"),
    (Placed(Placing.STOP), "device: it waits to be shown its place"),
    (
        NotInTime(("priority", "memory")),
        "timing: no real-time priority and no locked memory, so that ticks may come late; to "
        "allow it, put '@audio - rtprio 95' and '@audio - memlock unlimited' into "
        "/etc/security/limits.d/audio.conf, join the group audio, and log in again",
    ),
    (
        Exposed(60.0),
        "picture: it has moved by itself for 60 s, and rests, which spares the skin; a pause and "
        "going on begin it anew",
    ),
]


@pytest.mark.parametrize(("event", "sentence"), SAID)
def test_each_has_a_sentence_and_comes_through_json_as_it_is(event, sentence):
    assert event.say() == sentence
    assert is_known(event)
    back = from_json(json.loads(json.dumps(to_json(event))))
    assert back == event
    assert repr(back) == repr(event)


def test_every_kind_has_a_sentence_here():
    assert {type(event) for event, _ in SAID} == set(events._KINDS.values())


def test_what_a_reader_hears_of_otherwise_is_not_said():
    quiet = [event for event, _ in SAID if not told([event])]
    assert {type(event) for event in quiet} == {Button, Knob, Placed, Fault}


def test_texts_are_cut_and_nothing_else():
    event = Stranger("a" * 9, "b", (Difference("name", "c" * 9, 2.5),), 7, times=3)
    assert shortened(event, 4) == Stranger(
        "aaaa", "b", (Difference("name", "cccc", 2.5),), 7, times=3
    )


class Own(events.Event):
    """A kind of event that only a driver knows."""


def test_a_driver_s_own_kind_is_not_known():
    assert not is_known(Own())
    assert not is_known("a sentence")
    with pytest.raises(TypeError, match="no words for"):
        Own().say()


SLIDER = Display("slider", rows=6, columns=10, column_pitch_mm=1.2, row_pitch_mm=1.6)


@pytest.mark.parametrize(
    ("display", "where"),
    [
        (SLIDER, "left to the stop"),
        (
            replace(SLIDER, height_mm=100.0),
            "to the far left corner, with the array straight",
        ),
        (LATERO, "to the near left corner, with the array straight"),
    ],
)
def test_a_reader_is_told_where_a_carriage_is_shown_its_place(display, where):
    said = placing_sentence(Placing.STOP, display, press="press Enter")
    assert said == f"place: move {where}, then press Enter"
    assert placing_sentence(Placing.DONE, display) == "place: known"
