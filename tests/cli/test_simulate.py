"""``vbraille simulate``: a device made of software, until a signal ends it."""

import os
import signal
import time
from contextlib import contextmanager

import pytest

from tests.cli import program


@contextmanager
def simulating(*words):
    with program.start("simulate", *words) as process:
        try:
            yield process
        finally:
            process.kill()


def test_a_device_is_at_its_link_until_ctrl_c(call, tmp_path):
    link = tmp_path / "vb0"
    with simulating("serial", "--link", link, "--hand", "slow") as process:
        assert process.stdout.readline().startswith(b"port: /dev/")
        assert process.stdout.readline() == f"link: {link}\n".encode()
        assert os.path.islink(link)  # noqa: PTH114
        info = call("device", "info", f"serial:{link}")
        assert info.code == 0, info.err
        assert "name: simulated STReSS²" in info.out
        process.send_signal(signal.SIGINT)
        assert process.wait(program.PATIENCE_S) == 0
        assert b"\nsummary: seconds " in process.stdout.read()
    assert not os.path.lexists(link)


def test_a_latero_answers_at_its_port(call):
    with simulating("latero", "--udp-port", "0") as process:
        spec = process.stdout.readline().decode().removeprefix("device: ").strip()
        info = call("device", "info", spec)
        assert info.code == 0, info.err
        assert "actuators: 8 rows of 8" in info.out
        process.terminate()
        assert process.wait(program.PATIENCE_S) == 0
        assert b"blades at rest" in process.stdout.read()


def test_keys_press_buttons_and_turn_knobs():
    with program.Terminal("simulate", "serial", "--press", "1@0.5s-1s, knob 2 1@1s") as terminal:
        terminal.until("keys: 1 to 8 press a button")
        terminal.type("2")
        terminal.until("button 2: pressed")
        terminal.type("a")
        terminal.until("knob 1: 0.55")
        terminal.type("\x03")
        assert terminal.end() == 0
        assert terminal.settings() == terminal.before


@pytest.mark.parametrize(
    ("line", "named"),
    [
        ("serial --unplug-every 5s", "--link"),
        ("serial --hand glove", "glove"),
        ("serial --rate 333", "333"),
        ("serial --travel nan", "--travel"),
        ("serial --drop 2", "--drop"),
        ("serial --boot soon", "--boot"),
        ("serial --defect no-watchdg", "did you mean no-watchdog"),
        ("serial --press knob", "knob"),
        ("serial --press 99@1s", "99"),
        ("serial --late 0.1", "--late"),
        ("latero --press 3@1s", "two buttons"),
        ("latero --udp-port 70000", "--udp-port"),
        ("latero --axes xy", "--axes"),
        ("radio", "radio"),
    ],
)
def test_what_cannot_be_is_one_sentence(call, line, named):
    begun = time.monotonic()
    done = call("simulate", *line.split())
    assert (done.code, done.out) == (2, "")
    assert done.err.count("\n") == 1
    assert named in done.err
    assert time.monotonic() - begun < program.PATIENCE_S
