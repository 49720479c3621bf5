"""``vbraille tune`` at a terminal: this or that, left, taken up again, and saved."""

import re
import tomllib

from tests.cli import program
from vbraille.reading.tuning_course import TuningCourse
from vbraille.render import STRESS2

FAST = ("--hand", "sweep:300")


def kept(path):
    return tomllib.loads(path.read_text())["profile"]


def test_a_course_is_led_left_taken_up_and_saved(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("# my own\n")
    command = ("tune", "--settings", path, "--profile", "evening", *FAST)
    with program.Terminal(*command) as terminal:

        def press(keys, said):
            terminal.type(keys)
            return terminal.until(rf"(^|\n){re.escape(said)}\r\n")

        said = terminal.until("choice 1 of 28: texture\r\nnow: 1\r\n")
        assert "profile: evening is new, and is made when it is saved\r\n" in said
        press("u", "undo: nothing was chosen")
        press("x", "no command: x; h says the keys")
        press("h", "q: leave; the same command goes on from here")
        press(" ", "now: 2")
        press(" ", "now: 1")
        press("2", "choice 2 of 28: texture")
        press("u", "choice 1 of 28: texture")
        press("p", "first line")
        press("2", "choice 2 of 28: texture")
        press("1", "choice 3 of 28: texture")
        press("q", "left: 2 of 28 choices made")
        assert terminal.end() == 0
    assert path.read_text() == "# my own\n"
    with program.Terminal(*command) as terminal:
        terminal.until("going on: choices made 2\r\nchoice 3 of 28: texture\r\nnow: 1\r\n")
        terminal.type("212121212121")
        said = terminal.until("choice 15 of 28: dot width\r\nnow: 1\r\n")
        assert re.search(r"contrast: \S+\r\n95 % interval: \S+ to \S+\r\n", said)
        terminal.type("21212121212121")
        terminal.until("saved: profile evening for the STReSS²\r\n")
        assert terminal.end() == 0
        assert terminal.settings() == terminal.before
        for line in terminal.lines.splitlines():
            assert re.fullmatch(r"[\x20-\x7e²]*", line)
    course = TuningCourse(STRESS2, (2, 1) * 14)
    saved = kept(path)["evening"]["stress2"]
    for found in course.found:
        assert saved[found.knob.key] == found.value
    assert path.read_text().startswith("# my own\n")
    assert [each.name for each in tmp_path.iterdir()] == ["mine.toml"]


def test_without_a_terminal_it_says_so_and_what_was_kept_must_be_whole(tmp_path, call):
    path = tmp_path / "mine.toml"
    path.write_text("")
    said = call("tune", "--settings", path)
    assert (said.code, said.out) == (2, "")
    assert said.err == "vbraille: vbraille tune is led by keys; start it at a terminal\n"
    (tmp_path / "mine-tune-default-stress2.json").write_text("{")
    with program.Terminal("tune", "--settings", path) as terminal:
        terminal.until("cannot be gone on with; begin anew with --again\r\n")
        assert terminal.end() == 2
