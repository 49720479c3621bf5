"""Participants whose pseudonyms differ in case or zeros only are asked about, once."""

import pytest

from tests.cli.program import Terminal
from tests.sessions.sittings import MINI


def session(room, participant, name):
    (room / "mini.toml").write_text(MINI)
    return (
        "session", "run", room / "mini.toml", "--participant", participant, "--seed", "1",
        "--out", room / name,
    )  # fmt: skip


FAST = ("--answers", "simulated", "--fast", "--hand", "sweep:150")


@pytest.mark.parametrize("other", ["p07", "P7", "P-07"])
def test_a_script_is_refused_unless_it_says_that_it_is_another_person(call, tmp_path, other):
    assert call(*session(tmp_path, "P07", "one"), *FAST).code == 0
    said = call(*session(tmp_path, other, "two"), *FAST)
    assert (said.code, said.out) == (2, "")
    assert said.err == (
        f"vbraille: {other} is new here, and P07 has the session one; give --participant P07, "
        f"or --another if {other} is another person\n"
    )
    assert not (tmp_path / "two").exists()
    assert call(*session(tmp_path, other, "two"), *FAST, "--another").code == 0
    # Who is known is not asked about again.
    assert call(*session(tmp_path, other, "three"), *FAST).code == 0
    assert call(*session(tmp_path, "P07", "four"), *FAST).code == 0
    assert call(*session(tmp_path, "P70", "five"), *FAST).code == 0


def test_at_a_terminal_it_is_asked_and_an_answer_taken(call, tmp_path):
    assert call(*session(tmp_path, "P07", "one"), *FAST).code == 0
    with Terminal(*session(tmp_path, "p7", "two"), "--cues", "none") as terminal:
        terminal.until(r"is p7 another person\? \(yes or no\):")
        terminal.type("perhaps\n")
        terminal.until("type yes or no:")
        terminal.type("no\n")
        assert terminal.end() == 2
        assert "nothing was begun; give --participant P07" in terminal.printed
    assert not (tmp_path / "two").exists()
    with Terminal(*session(tmp_path, "p7", "two"), "--cues", "none") as terminal:
        terminal.until("another person")
        terminal.type("yes\n")
        terminal.until("session: ")
        terminal.type("stop\n")
        assert terminal.end() == 0
