"""``vbraille feel``: a picture under the hand of a real host process, at a terminal and without."""

import os
import re
import signal
import time

import pytest

from tests.cli import program
from tests.cli.test_read_serial import host_of
from tests.reading.felt import SCENE
from tests.tiers import heavy

SUMMARY = r"summary: seconds [0-9.]+"


@pytest.fixture
def scene(tmp_path):
    """A file of a picture with two elements."""
    path = tmp_path / "house.scene"
    path.write_text(SCENE)
    return path


def test_at_a_terminal_keys_move_the_hand_and_say_what_is_there(scene):
    with program.Terminal("feel", scene, "--cues", "none") as terminal:
        terminal.until("h says the keys")
        assert "picture: A house" in terminal.printed
        assert "description: A house and the sun." in terminal.printed
        terminal.type("gsun\n")
        terminal.until("going to: Sun")
        terminal.type("v")
        terminal.until("entering: said")
        terminal.until("entering: Sun")
        terminal.type("w")
        terminal.until("Sun: It shines.")
        terminal.type("gnowhere\n")
        terminal.until("element: none is called nowhere; shift-o says them all")
        terminal.type("O")
        terminal.until("element: wall, 43 mm × 53 mm, middle 40 mm from the left")
        terminal.type("\x1b[H")
        terminal.until("entering: wall")
        terminal.type("\x1b[1;2C")  # 10 mm right
        terminal.type("\x1b[A")  # 1 mm up
        terminal.type("C")
        terminal.until("contrast: 0.9")
        terminal.type(" ")
        terminal.until("paused")
        terminal.type(" ")
        said = ""
        while "place: 70 mm from the left, 44 mm from the top" not in said:  # the hand glides
            terminal.type("i")
            said = terminal.until("place: .*top")
        scene.write_text(SCENE.replace("A house", "A barn"))
        terminal.type("\x12")
        terminal.until("reloaded: A barn")
        scene.write_text(SCENE.replace("radius_mm = 10", "radius_mm = -1"))
        terminal.type("\x12")
        said = terminal.until("picture: as it was")
        assert re.search(r"not reloaded: .*house.scene.*radius", said)
        terminal.type("q")
        assert terminal.end() == 0
        assert re.search(SUMMARY, terminal.printed)


def test_a_device_that_a_person_moves_needs_no_hand(call, scene, tmp_path):
    done = call("feel", scene, "--device", f"serial:{tmp_path}/none")
    assert done.code == 2
    assert f"{tmp_path}/none" in done.err
    assert "hand" not in done.err


@heavy  # a host more, and a file that is looked at all the time
def test_a_file_that_changes_is_read_again_by_itself(scene):
    with program.Terminal("feel", scene, "--cues", "none") as terminal:
        terminal.until("h says the keys")
        scene.write_text(SCENE.replace("A house", "A hut"))
        terminal.until("reloaded: A hut")
        terminal.type("q")
        assert terminal.end() == 0


@heavy  # a host more
def test_a_hand_that_moves_by_itself_ends_the_feeling(scene):
    done = program.run("feel", scene, "--hand", "wide:30", "--say-entering")
    assert done.returncode == 0, done.stderr
    assert "entering: Sun" in done.stdout
    assert re.search(SUMMARY, done.stdout)


@heavy  # a host more
def test_on_a_slider_one_line_of_the_picture_is_felt_and_keys_choose_it(scene):
    arguments = ("feel", scene, "--model", "stress2", "--y", "55", "--cues", "none")
    with program.Terminal(*arguments) as terminal:
        terminal.until("one axis: .* now at 55 mm from the top; down and up choose another")
        terminal.type("\x1b[B")
        terminal.until("height: 56 mm from the top")
        terminal.type("gwall\n")
        terminal.until("going to: wall")
        terminal.type("q")
        assert terminal.end() == 0


@heavy  # a host is started twice
def test_a_hand_that_goes_its_way_sets_out_again_with_a_host_begun_again(scene):
    with program.Terminal("feel", scene, "--cues", "none", "--hand", "wide:20") as terminal:
        terminal.until("h says the keys")
        os.kill(host_of(terminal), signal.SIGKILL)
        terminal.until("fault: .*space begins again")
        terminal.type(" ")
        terminal.until("feeling")
        right_mm, end_s = 0, time.monotonic() + program.PATIENCE_S
        while right_mm < 20:
            assert time.monotonic() < end_s, "the hand stands still"
            terminal.type("i")
            said = terminal.until("place: .*\n")
            right_mm = int("".join(re.findall("place: ([0-9]+) mm", said)) or 0)
        terminal.type("q")
        assert terminal.end() == 0


def test_what_cannot_be_felt_is_one_sentence(call, scene, tmp_path):
    large = tmp_path / "large.scene"
    large.write_text(SCENE.replace("width_mm = 120", "width_mm = 1200"))
    for arguments, said in (
        ((tmp_path / "none.scene",), "there is no"),
        ((large, "--hand", "wide"), "the scene's canvas is 1200 × 90 mm, and the carriage of"),
        ((scene,), "nothing would move the hand: start vbraille feel at a terminal"),
        ((scene, "--y", "3"), "--y is for a device of one axis"),
        ((scene, "--model", "stress2", "--y", "95"), "--y is 95 mm; it must be 0 to 90 mm"),
        ((scene, "--hand", "spot:3"), "the place is '3'; write it as X,Y in mm"),
        ((scene, "--hand", "wide:0"), "spacing is 0 mm; it must be 0.5 to 1000 mm"),
        ((scene, "--device", "latero:127.0.0.1", "--hand", "wide"), "--hand is for the simulated"),
    ):
        done = call("feel", *arguments)
        assert done.code == 2, arguments
        assert said in done.err
        assert done.err.count("\n") == 1
