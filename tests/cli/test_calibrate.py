"""``vbraille device calibrate`` at a terminal, with a simulated controller."""

import json
import re
import tomllib
from contextlib import contextmanager

import pytest

from tests import drivers
from tests.cli import program
from tests.tiers import heavy
from vbraille.display import Display
from vbraille.testing import simulated_controller

SMALL = Display("bench", rows=1, columns=3, column_pitch_mm=1.2, row_pitch_mm=1.2, rate_hz=200.0)
FILE = "mine-calibration-bench.toml"


@pytest.fixture
def spec(tmp_path, monkeypatch):
    """The spec of a small device; calibrations go to the test's own folder."""
    monkeypatch.setenv("VBRAILLE_SETTINGS", str(tmp_path / "mine.toml"))
    with simulated_controller(SMALL, hand="sweep:1000") as spec:
        yield spec


@contextmanager
def calibrating(spec):
    with program.Terminal("device", "calibrate", spec) as terminal:

        def press(keys, *said):
            terminal.type(keys)
            lines = r"\r\n(?:[\s\S]*\n)?".join(map(re.escape, said))
            terminal.until(rf"(^|\n){lines}\r\n")

        yield terminal, press


def kept(tmp_path):
    return tomllib.loads((tmp_path / FILE).read_text())["actuator"]


def test_a_round_is_led_left_taken_up_and_kept(spec, tmp_path, call):
    with calibrating(spec) as (terminal, press):
        terminal.until("actuator 1 of 3: row 1, column 1\r\n")
        press("u", "undo: nothing was found")
        press("c", "compare: no other actuator was found to be well")
        press("x", "no command: x; h says the keys")
        press("h", "q: leave; the same command goes on from here")
        press("d", "found: dead", "actuator 2 of 3: row 1, column 2")
        assert kept(tmp_path) == [{"row": 1, "column": 1, "state": "dead"}]
        press("u", "actuator 1 of 3: row 1, column 1")
        assert "actuator" not in tomllib.loads((tmp_path / FILE).read_text())
        press("y", "found: ok", "actuator 2 of 3: row 1, column 2")
        press("c", "swings: row 1, column 1")
        press("-", "gain: 95 %")
        press("-", "gain: 90 %")
        press("i", "inverted: yes")
        press("w", "found: weak", "actuator 3 of 3: row 1, column 3")
        press("p", "actuator 2 of 3: row 1, column 2; weak, inverted, gain 90 % so far")
        press("q", "kept: 2 tried")
        assert terminal.end() == 0
        assert terminal.settings() == terminal.before
        for line in terminal.lines.splitlines():
            assert re.fullmatch(r"[\x20-\x7e]*", line)
    assert kept(tmp_path) == [
        {"row": 1, "column": 1, "state": "ok"},
        {"row": 1, "column": 2, "state": "weak", "inverted": True, "gain": 0.9},
    ]
    with calibrating(spec) as (terminal, press):
        terminal.until(r"going on: tried 2 of 3\r\n\S*actuator 3 of 3: row 1, column 3\r\n")
        press("d", "dead: row 1, column 3", "kept: 3 tried")
        assert terminal.end() == 0
    shown = call("device", "calibrate", spec, "--show")
    assert shown.code == 0
    assert shown.out.splitlines()[:-1] == [
        "device: bench",
        "actuators tried: 3 of 3",
        "dead: row 1, column 3",
        "weak: row 1, column 2",
        "inverted: row 1, column 2",
        "gain of row 1, column 2: 90 %",
    ]
    shown = json.loads(call("device", "calibrate", spec, "--show", "--json").out)
    assert (shown["device"], shown["own_gains"]) == ("bench", False)
    assert shown["calibration"]["dead"] == [[0, 2]]
    assert shown["calibration"]["scale"] == [[1.0, -0.9, 0.0]]
    assert shown["file"].endswith(FILE)
    assert call("device", "calibrate", spec, "--json").code == 2
    assert "actuators tried: 3 of 3" in call("device", "info", spec).out
    assert call("device", "calibrate", spec, "--forget").out == "calibration: forgotten\n"
    assert call("device", "calibrate", spec, "--forget").out == "calibration: none was kept\n"
    shown = json.loads(call("device", "calibrate", spec, "--show", "--json").out)
    assert (shown["calibration"], shown["file"]) == (None, None)
    assert "calibration: none;" in call("device", "info", spec).out
    assert not (tmp_path / FILE).exists()


def test_nothing_that_was_found_is_lost_when_it_is_killed(spec, tmp_path):
    with calibrating(spec) as (terminal, press):
        terminal.until("actuator 1 of 3")
        press("d", "actuator 2 of 3: row 1, column 2")
        terminal.process.kill()
        terminal.process.wait()
    assert kept(tmp_path) == [{"row": 1, "column": 1, "state": "dead"}]
    assert [each.name for each in tmp_path.iterdir()] == [FILE]


@heavy
def test_ctrl_c_ends_it_with_what_was_found(spec, tmp_path):
    with calibrating(spec) as (terminal, press):
        terminal.until("actuator 1 of 3")
        press("w", "actuator 2 of 3: row 1, column 2")
        terminal.type("\x03")
        assert terminal.end() == 1
        assert "vbraille: stopped" in terminal.lines
        assert terminal.settings() == terminal.before
    assert kept(tmp_path)[0]["state"] == "weak"


def test_without_a_terminal_it_says_so(spec, call):
    said = call("device", "calibrate", spec)
    assert (said.code, said.out) == (2, "")
    assert said.err == (
        "vbraille: vbraille device calibrate is led by keys; start it at a terminal\n"
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("device = ", "is not TOML"),
        ('device = "bench"\nrows = 1\ncolumns = 3\n[[actuator]]\nrow = 2\ncolumn = 1', "not in an"),
        (
            'device = "bench"\nrows = 1\ncolumns = 3\n[[actuator]]\nrow = 1\ncolumn = 1\ngain = 2',
            "line 7: [[actuator]] number 1 gain is 2; it must be 0.05 to 1",
        ),
        ('device = "bench"\nrows = 1\ncolumns = 4', "is for 1 × 4 actuators and bench has 1 × 3"),
        ('device = "other"\nrows = 1\ncolumns = 3', "is of other and not of bench"),
        ('device = "bench"\nrows = 1\ncolumns = 3\nstate = 1', "has no key 'state'"),
    ],
)
def test_a_file_that_cannot_be_used_is_one_sentence(spec, tmp_path, call, text, said):
    (tmp_path / FILE).write_text(text)
    refused = call("device", "info", spec)
    assert refused.code == 2
    assert refused.err.count("\n") == 1
    assert said in refused.err


@heavy  # it waits for ten seconds; two are waited for in tests/engine/test_host_drivers.py
def test_a_driver_that_never_opens_its_device_is_named_and_ended(tmp_path):
    module = "import time\n\ndef open_never(address, wanted):\n    time.sleep(600)\n"
    environment = drivers.install(tmp_path, "never", "open_never", module)
    done = program.run("device", "info", "never:", env=environment)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith("vbraille: the driver never did not open its device within 10 s")
