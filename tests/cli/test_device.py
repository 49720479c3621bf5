"""``vbraille device``: what a device is, and its calibration by keys at a terminal."""

import json
import re
import tomllib
from contextlib import contextmanager

import pytest

from tests.cli import program
from vbraille.devices.calibration import Calibration
from vbraille.display import Display
from vbraille.engine.calibrating import CalibrationRound, gains_said
from vbraille.engine.clock import ManualClock
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.testing import simulated_controller

SMALL = Display("bench", rows=1, columns=3, column_pitch_mm=1.2, row_pitch_mm=1.2, rate_hz=200.0)


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

        terminal.until("actuator 1 of 3: row 1, column 1")
        yield terminal, press


def kept(tmp_path):
    (path,) = tmp_path.glob("mine-calibration-bench*.toml")
    return tomllib.loads(path.read_text())["gain"]


def test_a_round_is_led_by_keys_and_each_finding_is_kept_at_once(spec, tmp_path, call):
    with calibrating(spec) as (terminal, press):
        press("x", "press h for the keys")
        press("h", "q: leave")
        press("d", "actuator 2 of 3: row 1, column 2, gain 100 %")
        assert kept(tmp_path) == [[0, 1, 1]]
        press("-", "gain 95 %")
        press("-", "gain 90 %")
        press("i", "gain 90 %, inverted")
        assert kept(tmp_path) == [[0, -0.9, 1]]
        press("y", "actuator 3 of 3: row 1, column 3, gain 100 %")
        press("p", "actuator 2 of 3: row 1, column 2, gain 90 %, inverted")
        terminal.type("q")
        assert terminal.end() == 0
        assert terminal.settings() == terminal.before
    shown = call("device", "calibrate", spec, "--show").out.splitlines()
    assert shown[:3] == [
        "dead: row 1, column 1", "inverted: row 1, column 2", "row 1, column 2: gain 90 %, inverted"
    ]  # fmt: skip
    told = json.loads(call("device", "calibrate", spec, "--show", "--json").out)
    assert told["calibration"]["gain"] == [[0, -0.9, 1]]
    assert "calibration: " in call("device", "info", spec).out
    assert call("device", "calibrate", spec, "--forget").out == "calibration: deleted\n"
    assert call("device", "calibrate", spec, "--forget").out == "calibration: none\n"
    assert "calibration: none" in call("device", "info", spec).out


def test_nothing_that_was_found_is_lost_when_it_is_killed(spec, tmp_path):
    with calibrating(spec) as (terminal, press):
        press("d", "actuator 2 of 3: row 1, column 2, gain 100 %")
        terminal.process.kill()
        terminal.process.wait()
    assert kept(tmp_path) == [[0, 1, 1]]


def test_ctrl_c_ends_it_and_leaves_the_terminal_as_it_was(spec, tmp_path):
    with calibrating(spec) as (terminal, press):
        press("d", "actuator 2 of 3: row 1, column 2, gain 100 %")
        terminal.type("\x03")
        assert terminal.end() == 1
        assert "vbraille: stopped" in terminal.lines
        assert terminal.settings() == terminal.before
    assert kept(tmp_path) == [[0, 1, 1]]


@pytest.mark.parametrize(
    ("line", "named"),
    [
        ("calibrate {spec}", "terminal"),
        ("calibrate {spec} --json", "--show"),
        ("info nosuch:x", "unknown device kind 'nosuch'"),
        ("check nosuch:x", "unknown device kind 'nosuch'"),
        ("info sim", "--model"),
        ("info {spec} --model stress2", "--model"),
    ],
)
def test_what_cannot_be_is_one_sentence(spec, call, line, named):
    done = call("device", *line.format(spec=spec).split())
    assert (done.code, done.out) == (2, "")
    assert done.err.count("\n") == 1
    assert named.lower() in done.err.lower()


def test_a_device_is_described_in_lines_and_as_json(spec, call):
    lines = call("device", "info", spec).out.splitlines()
    assert lines[:2] == ["name: bench", "actuators: 1 row of 3"]
    assert all(re.fullmatch(r"[a-z ]+: .+", line) for line in lines)
    told = json.loads(call("device", "info", spec, "--json").out)
    assert (told["display"]["rows"], told["display"]["columns"]) == (1, 3)
    listed = json.loads(call("device", "list", "--json").out)
    assert "sim" in [driver["kind"] for driver in listed["drivers"]]


def test_a_round_keeps_gains_in_bounds_and_shows_dead_actuators():
    clock = ManualClock()
    device = SimulatedDevice(Display("bench", 2, 2, 1.0, 1.0), clock.now_ns)
    turn = CalibrationRound(device, clock, Calibration("bench", [[1.0, 0.0], [-0.5, 1.0]]))
    for _ in range(30):
        turn.press("-")
    assert turn.found.gain[0][0] == 0.05
    for _ in range(30):
        turn.press("+")
    assert turn.found.gain[0][0] == 1.0
    turn.press("n")
    assert turn.found.gain[0][1] == 0.0  # passed over, and left as it was
    turn.swing()
    assert device.calibration.gain[0][1] == 1.0  # or it could not be seen to swing
    turn.press("p")
    turn.press("p")
    assert turn.place == (1, 1)
    turn.press("y")
    assert turn.place == (0, 0)
    assert gains_said(turn.found)[:2] == ["dead: row 1, column 2", "inverted: row 2, column 1"]
