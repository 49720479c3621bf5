"""A conventional display beside the device: a real BRLTTY, and what stands on it when."""

import time

import pytest

from tests.conventional.handytech import Brltty, needs_brltty
from tests.sessions.sittings import HEAD, WIDTHS, Person, made
from vbraille.errors import VbrailleError
from vbraille.sessions.running.answers import Line

pytestmark = needs_brltty
STRINGS = f"""{HEAD}[design]
kind = "list"
strings = ["ac"]
order = "listed"
[[conditions]]
name = "virtual"
on = "device"
[[conditions]]
name = "conventional"
on = "pins"
[pins]
cell = 3
"""


class Patient(Person):
    """Presses Enter again where it was too early."""

    early = 0

    def line(self, asked, wait_s):
        early = sum(sentence.startswith("too early") for sentence in self.said)
        if early > self.early:
            self.early = early
            time.sleep(0.2)
            return Line("")
        return super().line(asked, wait_s)


def test_strings_stand_there_from_enter_to_enter(tmp_path):
    with Brltty(tmp_path) as brltty:
        sat = made(tmp_path, STRINGS)
        script = [("read:", "ac"), ("break", ""), ("press Enter", ""), ("cue: trial 2", "")]
        person = Patient(sat.said, [*script, ("read:", "ac"), ("last", "")])
        sat.sit(answers=person, fast=False, hand="sweep:400", also=f"brlapi:{brltty.host}")
        assert any(cells[2:4] == bytes([1, 9]) for _, cells in brltty.display.shown)
    stood = [event.data["cells"] for event in sat.of("pins")]
    assert stood[0].startswith("⠀⠀⠁⠉")
    assert sat.of("display")[0].data["columns"] == brltty.display.cells
    assert [row["on"] for row in sat.session.trials] == ["device", "pins"]


def test_a_reference_stands_there_while_the_device_is_felt(tmp_path):
    with Brltty(tmp_path) as brltty:
        sat = made(tmp_path, WIDTHS + '[pins]\nreference = "a"\n')
        sat.sit(("read:", "1"), ("cue: trial 2", "stop"), fast=False, hand="sweep:400",
                also=f"brlapi:{brltty.host}")  # fmt: skip
    assert sat.of("pins")[0].data == {"cells": "⠁", "reference": True}
    assert len(sat.of("answer")) == 1


def test_a_display_that_is_not_there_is_said_before_anything_begins(tmp_path):
    sat = made(tmp_path, STRINGS)
    with pytest.raises(VbrailleError, match="BRLTTY"):
        sat.sit(("ready", "x"), fast=False, also="brlapi:127.0.0.1:899")
    assert not sat.of("run")
