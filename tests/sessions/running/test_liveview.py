"""What the pages of a session are told, and what a blind one keeps back."""

import re

import msgspec
import pytest

from tests.sessions.sittings import HEAD, SURE, made
from vbraille.errors import InputError
from vbraille.sessions.running import liveview

LETTERS = f"""{HEAD}[design]
kind = "list"
strings = ["ac", "ca"]
blocks = 1
[[conditions]]
name = "flat"
texture = 0.0
[[conditions]]
name = "rough"
texture = 0.73
"""


@pytest.fixture
def told(monkeypatch):
    """States that pages are told."""
    states = []

    class View:
        def __init__(self, **how):
            self.how = how

        def __enter__(self):
            return self

        def __exit__(self, *_):
            states.append("closed")

        addresses = ("live view: http://127.0.0.1:1/#secret",)
        take = notes = staticmethod(list)
        watch = staticmethod(lambda _reader: None)
        tell = staticmethod(states.append)

    monkeypatch.setattr(liveview, "LiveView", View)
    return states


def sit(folder, protocol, *script):
    script = script or (*[("read:", "ac")] * 4, ("last", ""))
    sat = made(folder, protocol)
    sat.sit(*script, fast=False, hand="sweep:400", monitor=(None, None))
    return sat


def test_a_blind_page_is_told_nothing_of_stimuli_conditions_and_answers(tmp_path, told):
    sat = sit(tmp_path, LETTERS + SURE.replace("identify'", "identify'\nask = 'Which?'"),
              *[("read:", "ac"), ("confidence", "3")] * 4, ("last", ""))  # fmt: skip
    assert told.pop() == "closed"
    text = "".join(msgspec.json.encode(state).decode() for state in told)
    for hidden in ("flat", "rough", "0.73", "a c", "⠁", "P01", "secret", "confidence"):
        assert hidden not in text, hidden
    assert all(state.blind and not state.lines for state in told)
    assert any(re.search("trial 3 of 4", str(state.facts)) for state in told)
    assert told[-1].done
    assert sat.of("run")[0].data["monitor"]["blind"]


def test_an_open_page_is_told_what_is_under_the_hand(tmp_path, told):
    sit(tmp_path, LETTERS + "[session]\nblind = false\n")
    told.pop()
    shown = [state for state in told if state.lines]
    assert {line.cells[1] for state in shown for line in state.lines} == {1, 9}
    assert {dict(state.facts)["condition"] for state in shown} == {"flat", "rough"}


@pytest.mark.parametrize("how", [{"fast": True}, {"paper": True}])
def test_there_is_no_live_view_without_a_device_in_real_time(tmp_path, how):
    paper = LETTERS.replace(HEAD, HEAD + 'medium = "paper"\n')
    protocol = paper if how.pop("paper", False) else LETTERS
    with pytest.raises(InputError, match="monitor"):
        made(tmp_path, protocol).sit(answers=["ac"], monitor=(None, None), **{"fast": False, **how})


@pytest.mark.usefixtures("told")
def test_a_page_that_fails_does_not_end_the_session(tmp_path, monkeypatch):
    def fail(_state):
        raise RuntimeError("the page is gone")

    monkeypatch.setattr(liveview.LiveView, "tell", staticmethod(fail))
    sat = sit(tmp_path, LETTERS)
    assert sat.of("end")
    assert sum("live view" in sentence for sentence in sat.said) >= 2
