"""``vbraille simulate latero``, a real process at a real port, and what is read on it."""

import re
import signal
import subprocess

import pytest

from tests.cli import program
from tests.tiers import heavy
from vbraille.cli.old.commands.simulate import LATERO_ONLY, SERIAL_ONLY
from vbraille.cli.old.commandtable import COMMANDS
from vbraille.cli.old.parser import CommandParser
from vbraille.config.options import COMMON


class Simulated:
    """The process, and the spec by which it is found."""

    def __init__(self, *options):
        command = [*program.PROGRAM, "simulate", "latero", "--udp-port", "0", *options]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        self.spec = self.process.stdout.readline().strip().partition(": ")[2]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()

    def summary(self):
        """End it; what it says last."""
        self.process.send_signal(signal.SIGTERM)
        return self.process.stdout.read().splitlines()[-1]


def test_device_info_finds_it_and_leaves_it_at_rest(call):
    with Simulated("--hand", "sweep:60") as latero:
        assert re.fullmatch(r"latero:127\.0\.0\.1:\d+\?offsets=\d+,\d+,\d+", latero.spec)
        said = call("device", "info", latero.spec)
        assert said.code == 0
        assert "name: Latero\nactuators: 8 rows of 8\n" in said.out
        assert "firmware: controller 1.0, I/O interface 1.0" in said.out
        assert latero.spec.partition("?")[2] in said.out
        ended = latero.summary()
    assert "blades at rest, motor power off" in ended
    assert "beyond rest 0" in ended


@heavy
def test_a_text_is_read_on_it_to_its_end(tmp_path):
    text = tmp_path / "book.txt"
    text.write_text("a text")
    with Simulated("--hand", "sweep:200", "--wait", "100ms") as latero:
        said = subprocess.run(
            [*program.PROGRAM, "read", str(text), "--device", latero.spec],
            capture_output=True,
            text=True,
            timeout=120,
        )
        assert said.returncode == 0, said.stderr
        assert "summary: lines 1" in said.stdout
        assert "blades at rest, motor power off" in latero.summary()


@pytest.mark.parametrize(
    ("options", "why"),
    [
        ("latero --link ./vb0", "--link is not for a simulated latero"),
        ("latero --defect no-watchdog", "--defect is not for a simulated latero"),
        ("latero --rate 500", "--rate is not for a simulated latero"),
        ("latero --unplug-every 5s", "--unplug-every is not for a simulated latero"),
        ("serial --late 0.1", "--late is not for a simulated serial"),
        ("--udp-port 8900", "--udp-port is not for a simulated serial"),
        ("latero --udp-port 70000", "port is 70000"),
        ("latero --page-lines 99", "lines are 99"),
        ("latero --late 2", "late is 2"),
        ("latero --press 3@1s", "a Latero has 1 and 2"),
    ],
)
def test_what_it_cannot_be_is_said_in_a_sentence(call, options, why):
    said = call("simulate", *options.split())
    assert said.code == 2
    assert why in said.err
    assert said.out == ""


def test_each_option_is_of_one_kind_of_device_or_of_both():
    parser = CommandParser(command=COMMANDS["simulate"])
    options = vars(parser.parse_args([]))
    of_both = {"what", "hand", "seed", "script", "press", "drop"}
    assert set(options) - {*COMMON} == LATERO_ONLY.keys() | SERIAL_ONLY.keys() | of_both
    assert {**LATERO_ONLY, **SERIAL_ONLY}.items() <= options.items()


@pytest.mark.parametrize(
    ("line", "why"),
    [("1s knob 1 0.5", "turns a knob, and a Latero has none"), ("1s press 3", "button is 3")],
)
def test_a_script_that_moves_what_a_latero_has_not_is_refused(call, tmp_path, line, why):
    script = tmp_path / "script.txt"
    script.write_text(line)
    said = call("simulate", "latero", "--script", str(script))
    assert said.code == 2
    assert why in said.err
