"""Reading on a device at a serial line: the whole path, pseudo-terminal and processes included."""

import ctypes
import json
import os
import re
import resource
import signal
from contextlib import contextmanager

import pytest

from tests import drivers, forking
from tests.cli import program
from tests.cli.program import Terminal
from tests.tiers import TIER, Tier, by_tier, heavy
from vbraille import __version__

_PR_CAPBSET_DROP, _CAP_SYS_NICE = 24, 23


@contextmanager
def simulated(tmp_path, *options):
    """A simulated device; the spec by which it is read on, and its process."""
    link = tmp_path / "vb0"
    process = program.start(
        "simulate", "serial", "--link", link, "--hand", "sweep:1000", *options, text=True
    )
    try:
        while not process.stdout.readline().startswith("link: "):
            assert process.poll() is None
        yield f"serial:{link}", process
    finally:
        process.terminate()
        process.communicate()


def without_real_time():
    """Take away the right to real-time priority before a program is started."""
    resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0))
    ctypes.CDLL(None).prctl(_PR_CAPBSET_DROP, _CAP_SYS_NICE, 0, 0, 0)  # which root would have


def lines(said):
    return [line for line in said.splitlines() if line.startswith("line:")]


def host_of(terminal):
    """Process of the loop: the child of the program at a terminal."""
    return forking.children(terminal.process.pid)[0]


def test_a_text_is_read_to_its_end_on_a_device_that_has_passed_its_mark(tmp_path, text):
    # It is a VBD, and the page is laid out for its actuators.
    with simulated(tmp_path, "--encoder", "index", "--model", "vbd") as (spec, device):
        done = program.run("read", text, "--device", spec, "--lines", "1-2", "--dot-row", "2")
        assert done.returncode == 0, done.stderr
        assert done.stderr == program.line_width(28)
        assert lines(done.stdout) == ["line: 1", "line: 2"]
        assert done.stdout.splitlines()[-1].startswith("summary: lines 2,")
        device.send_signal(signal.SIGTERM)
        told = device.communicate()[0]
    assert "greeted by a host" in told
    assert int(re.search(r"frames (\d+)", told)[1]) > 1000
    assert "Traceback" not in done.stderr


def test_a_real_device_is_told_of_ticks_and_priority_and_a_simulated_one_is_not(tmp_path, text):
    options = ("--lines", "1", "--no-places")
    done = program.run("read", text, "--hand", "sweep:1000", *options, preexec_fn=without_real_time)
    assert done.returncode == 0, done.stderr
    assert not re.search("timing|real-time|tick", done.stdout + done.stderr)
    with simulated(tmp_path) as (spec, _):
        done = program.run("read", text, "--device", spec, *options, preexec_fn=without_real_time)
        assert done.returncode == 0, done.stderr
    assert "timing: no real-time priority, so that ticks may come late" in done.stdout
    assert re.search(r", ticks \d+, late ticks \d+\n$", done.stdout)


def test_a_slower_device_is_read_on_at_its_own_rate_unless_another_is_asked_for(
    call, tmp_path, text
):
    with simulated(tmp_path, "--rate", "500") as (spec, device):
        done = call("read", text, "--device", spec, "--lines", "1")
        assert done.code == 0, done.err
        seconds, ticks, late = (
            float(re.search(rf"{what} ([\d.]+)", done.out)[1])
            for what in ("seconds", " ticks", "late ticks")
        )
        # So many deadlines a second; that of the first and the last is not the clock's.
        assert (ticks + late) / seconds == pytest.approx(500, rel=0.3)
        done = call("read", text, "--device", spec, "--lines", "1", "--rate", "1000")
        assert done.code == 2
        assert "made for 500 frames a second and 1000 are asked for; choose --rate 500" in done.err
        device.send_signal(signal.SIGTERM)
        frames = int(re.search(r"frames (\d+)", device.communicate()[0])[1])
    assert frames <= 500 * (seconds + 5)


def test_an_unplugged_device_is_read_on_in_place_when_it_is_back(call, tmp_path, text):
    with simulated(tmp_path, "--unplug-every", "1s") as (spec, device):
        done = call("read", text, "--device", spec)
        assert done.code == 0, done.err
        assert lines(done.out) == ["line: 1", "line: 2", "line: 3"]
        device.send_signal(signal.SIGTERM)
        told = device.communicate()[0]
    assert "plugged in again" in told
    assert "device: unplugged; plug it in again and reading goes on" in done.out
    assert "device: back" in done.out
    assert "Traceback" not in done.err


def test_what_was_lost_on_the_line_is_said_at_the_end(call, tmp_path, text):
    with simulated(tmp_path, "--drop", "0.05", "--corrupt", "0.05") as (spec, _):
        done = call("read", text, "--device", spec, "--lines", "1")
    assert done.code == 0, done.err
    said = done.out.splitlines()
    assert said[-1].startswith("summary: lines 1,")
    assert re.fullmatch(r"device: (frames not sent \d+, )?states missed \d+, .*bad .*", said[-2])


def test_a_device_is_shown_its_left_stop_by_a_key_of_a_terminal(call, tmp_path, text):
    with simulated(tmp_path, "--encoder", "incremental") as (spec, _):
        done = call("read", text, "--device", spec)
        assert done.code == 2
        assert "left stop" in done.err
        assert "read at a terminal" in done.err
        with Terminal("read", text, "--device", spec, "--echo", "text") as terminal:
            terminal.until("place: move left to the stop, then press a key")
            terminal.type("x")
            terminal.until("place: known")
            terminal.until("line: 2")
            terminal.type("q")
            assert terminal.end() == 0


def test_a_host_that_dies_is_said_and_begun_again_when_asked(text):
    arguments = ("--hand", "sweep:5", "--echo", "text", "--rate", "300")
    with Terminal("read", text, *arguments) as terminal:
        terminal.until("h says the keys")
        os.kill(host_of(terminal), signal.SIGKILL)
        terminal.until(
            r"fault: the process that drives the device has ended \(killed by signal 9\)"
        )
        terminal.type(" ")
        terminal.until("reading")
        terminal.type("n")
        terminal.until("line: 2")
        terminal.type("q")
        assert terminal.end() == 0
    assert "summary: lines 2," in terminal.printed


def test_without_a_terminal_a_host_that_dies_ends_the_reading(text):
    process = program.start("read", text, "--hand", "sweep:5", "--rate", "300", text=True)
    process.stdout.readline()
    os.kill(forking.children(process.pid)[0], signal.SIGKILL)
    said = process.communicate(timeout=program.PATIENCE_S)[1]
    assert process.returncode == 1
    assert said.splitlines()[-1] == (
        "vbraille: the process that drives the device has ended (killed by signal 9)"
    )


_RATE = ("--rate", "2000", "choose --rate 1000 or less")
# Each costs the start of a process; both are refused in one place.
REFUSED = (
    ("--travel", "300", "goes 60 mm and --travel asks for 300 mm; leave --travel out"),
    *by_tier((), (_RATE,), (_RATE,)),
)


def test_the_page_is_laid_out_for_the_travel_that_there_is(call, tmp_path, text):
    with simulated(tmp_path, "--travel", "60") as (spec, _):
        done = call("read", text, "--device", spec, "--lines", "1-3")
        assert done.code == 0, done.err
        assert done.err == program.line_width(4)
        said = [line for line in done.out.splitlines() if line.startswith("text: ")]
        assert " ".join(line.removeprefix("text: ") for line in said) == "one two three"
        if TIER > Tier.TEST:  # a shorter travel is laid out for without a device, too
            narrower = call("read", text, "--device", spec, "--travel", "50", "--lines", "1")
            assert narrower.code == 0, narrower.err
            assert narrower.err == program.line_width(3)
        for option, value, sentence in REFUSED:
            done = call("read", text, "--device", spec, option, value)
            assert done.code == 2
            assert sentence in done.err
            assert len(done.err.splitlines()) == 1


@heavy  # the same is tested of devices that no model names
def test_what_the_actuators_cannot_show_is_one_sentence(call, tmp_path, text):
    with simulated(tmp_path, "--model", "vbd") as (spec, _):
        other = call("read", text, "--device", spec, "--mapping", "paired")
        assert other.code == 2
        assert other.err == "vbraille: the VBD has one row of actuators; --dot-row chooses dots\n"


def test_a_port_that_is_not_there(call, text):
    done = call("read", text, "--device", "serial:/dev/nothing")
    assert done.code == 2
    assert "there is no port /dev/nothing" in done.err


# Its carriage goes no further than 60 mm, whatever it says; its hand tries four times.
SHORT = """
from vbraille.display import Pose
from vbraille.simulation.motion import Way
from vbraille.simulation.simulated import SimulatedDevice

class Hand:
    def read_line(self, start_mm, end_mm):
        way = Way(start_mm)
        for _ in range(4):
            way.move(end_mm, 900.0)
            way.move(start_mm, 900.0)
        return way.motion()

class Short(SimulatedDevice):
    def __init__(self, address, wanted):
        super().__init__(wanted, hand=Hand())
        self.taking = address != "refusing"

    def read(self):
        sample = super().read()
        return Pose(sample.time_ns, min(sample.x_mm, 65.0))
"""


def test_a_line_that_the_carriage_cannot_finish_ends_the_reading_where_nobody_can_act(
    tmp_path, text
):
    driver = drivers.install(tmp_path, "short", "Short", SHORT)
    done = program.run("read", text, "--device", "short:", "--rate", "500", env=driver)
    assert done.returncode == 1
    assert "waiting: the finger turns back at 65 mm, and line 1 ends at" in done.stdout
    assert done.stderr.splitlines()[1:] == [
        "vbraille: line 1 cannot be read to its end: the finger turns back at 65 mm each time, and "
        "the line ends at 140 mm; see what is in the carriage's way, or give a shorter --travel"
    ]


@heavy  # what is said where a key can bring the next line is tested without a process
def test_a_line_that_the_carriage_cannot_finish_is_passed_by_a_key(tmp_path, text):
    driver = drivers.install(tmp_path, "short", "Short", SHORT)
    with Terminal(
        "read", text, "--device", "short:", "--rate", "500", PYTHONPATH=driver["PYTHONPATH"]
    ) as terminal:
        terminal.until("waiting: the finger turns back at 65 mm.* or n brings the next line\r\n")
        terminal.type("n")
        terminal.until("line: 2")
        terminal.type("q")
        assert terminal.end() == 0


@heavy  # what is said of such a device is tested without a process
def test_a_device_that_takes_nothing_is_not_read_on(tmp_path, text):
    driver = drivers.install(tmp_path, "short", "Short", SHORT)
    text.write_text("a\n\nb\n")
    with program.start(
        "read", text, "--device", "short:refusing", env=driver, text=True
    ) as process:
        said = [process.stdout.readline()]
        while not said[-1].startswith("waiting: "):
            assert process.poll() is None, said
            said.append(process.stdout.readline())
        process.send_signal(signal.SIGINT)
        said += process.stdout.readlines()
    assert "line: 1\n" in said
    assert "line: 2\n" not in said
    assert [line for line in said if line.startswith("waiting: ")] == [
        "waiting: the device takes no frames, so that nothing is felt; switch it off and on, "
        "and line 1 goes on\n"
    ]


def test_device_info(call, tmp_path):
    with simulated(tmp_path, "--model", "vbd") as (spec, _):
        told = call("device", "info", spec)
        assert told.code == 0
        assert told.out.splitlines() == [
            "name: simulated VBD",
            "actuators: 1 row of 12",
            "pitch: 0.7 mm along the line, 0.7 mm across",
            "levels: 1024",
            "rest side: left",
            "travel: 300 mm",
            "axes: along the line",
            "encoder: 200 counts a mm, absolute",
            "rate: 1000 Hz",
            "protocol: serial, version 2",
            "buttons: 8",
            "knobs: 4",
            f"firmware: {__version__}",
            "slew: without a limit",
            "disabled actuators: none",
            "inverted actuators: none",
            "calibration: none; vbraille device calibrate makes one",
        ]
        assert call("device", "info", spec, "--model", "stress2").code == 2


@heavy  # what is measured is tested on a clock of its own; here all of a check goes by in real time
def test_device_check(tmp_path):
    with simulated(tmp_path, "--model", "vbd") as (spec, _):
        checked = program.run("device", "check", spec)
    said = checked.stdout.splitlines()
    swung = [line for line in said if line.startswith("actuator: ")]
    assert swung == [f"actuator: row 1, column {n}" for n in range(1, 13)]
    for measured in (
        r"rate: 1000 Hz, \d+ of \d+ ticks late",
        r"clock: \d\.\d{3} s pass on it in a second, 0.98 to 1.02 s are allowed",
        r"place: [\d.]+ to [\d.]+ mm from the left stop, of 300 mm; 2 mm beyond .*",
        r"round trip: median \d+\.\d\d ms, .*",
        r"bad CRC: \d+",
        r"watchdog: tripped \d of 3 times, median [\d.]+ ms after the last frame, .* 71 ms are .*",
    ):
        assert re.search(f"^{measured}$", checked.stdout, re.MULTILINE), checked.stdout
    # The machine at hand may stall, and a terminal's buffer then drops bytes: only a line that lost
    # nothing must be a clean one. What the verdict is, is not tested; that there is one, is.
    if "states missed: 0" in said:
        assert "bad CRC: 0" in said
    assert said[-1].startswith(("verdict: fit to be read on", "verdict: not fit to be read on: "))
    assert checked.returncode == (0 if said[-1] == "verdict: fit to be read on" else 1)


@heavy  # verdicts are tested on a clock of their own; here all of a check goes by in real time
def test_a_device_without_a_watchdog_is_not_fit_to_be_read_on(tmp_path):
    with simulated(tmp_path, "--model", "vbd", "--defect", "no-watchdog") as (spec, _):
        checked = program.run("device", "check", spec, "--json")
    verdict = checked.stderr.splitlines()[-1]
    assert verdict.startswith("verdict: not fit to be read on: ")
    assert "its watchdog does not trip in time when no frame comes" in verdict
    found = json.loads(checked.stdout)
    assert (checked.returncode, found["fit"], found["trips_ms"]) == (1, False, [None] * 3)
    assert verdict.endswith("; ".join(found["wrong"]))


def test_device_list_and_a_simulated_device_without_a_model(call):
    listed = call("device", "list")
    assert listed.code == 0
    assert all(line.startswith("port: ") for line in listed.out.splitlines())
    assert listed.out
    done = call("device", "info", "sim")
    assert done.code == 2
    assert "--model" in done.err


def test_a_page_is_turned_by_keys_and_says_where_the_finger_is(tmp_path):
    book = tmp_path / "book.txt"
    book.write_text("".join(f"line {n}\n" for n in range(1, 13)))
    options = ("--model", "stress2-8x8", "--axes", "xyθ", "--height", "60")
    how = ("--keep-lines", "--advance", "key")
    with (
        simulated(tmp_path, *options) as (spec, _),
        Terminal("read", book, "--device", spec, *how) as terminal,
    ):
        terminal.until("h says the keys\r\n")

        def line():
            terminal.type("i")
            return int(re.search(r"line: (\d+)", terminal.until(r"line: \d+\r"))[1])

        assert 1 <= line() <= 5
        for key, first, last in (("]", 6, 10), ("]", 11, 12), ("[", 6, 10)):
            terminal.type(key)
            terminal.until(f"page: lines {first} to {last}\r\n")
            assert first <= line() <= last
        terminal.type("[[")
        terminal.until("page: lines 1 to 5\r\nfirst page\r\n")
        terminal.type("q")
        assert terminal.end() == 0


@heavy  # the same of one axis is tested in every run
def test_a_device_of_two_axes_is_shown_its_corner(tmp_path, text):
    options = ("--encoder", "incremental", "--axes", "xyθ", "--height", "60")
    with (
        simulated(tmp_path, *options) as (spec, _),
        Terminal("read", text, "--device", spec, "--echo", "text") as terminal,
    ):
        terminal.until("place: move to the far left corner, with the array straight, then press")
        terminal.type("x")
        terminal.until("place: known")
        terminal.until("line: 1")
        terminal.type("q")
        assert terminal.end() == 0
