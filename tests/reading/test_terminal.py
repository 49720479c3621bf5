"""Reading at a terminal, as a reader has it: keys are typed, sentences are read."""

import os
import shutil
import signal
import sqlite3
import subprocess
import termios

import pytest

from tests.reading.terminal import PROGRAM, Terminal
from tests.tiers import heavy
from vbraille.reading.commands import Where, bindings
from vbraille.testing import simulated_controller

BOOK = "tests/translate/documents/files/pandoc-3.epub"
TEXT = "texts/english.txt"
STILL = ("--hand", "slow", "--cues", "none")


@pytest.fixture(autouse=True)
def own_files(tmp_path, monkeypatch):
    monkeypatch.setenv("VBRAILLE_PLACES", str(tmp_path / "places.sqlite"))
    monkeypatch.setenv("VBRAILLE_SETTINGS", str(tmp_path / "settings.toml"))
    (tmp_path / "settings.toml").touch()


def run(*arguments):
    return subprocess.run(
        [PROGRAM, *arguments], capture_output=True, text=True, check=False, timeout=90,
        stdin=subprocess.DEVNULL,
    )  # fmt: skip


@pytest.mark.parametrize("key_set", ["usual", "nvda"])
def test_every_key_is_answered_in_one_sentence(key_set):
    asked = 0
    with Terminal("read", BOOK, *STILL, "--keys", key_set) as terminal:
        for key, command in bindings(key_set, Where.BOOK).items():
            if (":" in key and len(key) > 1) or command.name in (
                "quit",
                "help",
                "learn",
                "contents",
            ):
                continue
            lines = terminal.press("space" if key == " " else key, wait_s=0.03).splitlines()
            assert len(lines) == 1, (key, lines)
            if command.name in ("search-forward", "search-backward", "go-to", "bookmark",
                                "language", "go-to-bookmark", "delete-bookmark"):  # fmt: skip
                assert terminal.press("escape") == "cancelled"
            asked += 1
        terminal.press("q" if key_set == "usual" else "ctrl-d")
        assert terminal.end() == 0
    assert asked >= 60


CASES = [
    (BOOK, (), ["y", "f", "r", "enter", "x"], "French contracted"),
    (BOOK, ("--echo", "text"), ["e"], "heading level 1: The Harbour"),
    (BOOK, ("--echo", "text"), ["E"], "no previous heading"),
    (BOOK, ("--keys", "nvda"), ["2"], "heading level 2: What is brought"),
    (BOOK, (), ["k", "enter"], "note 1"),
    (TEXT, ("--lines", "3-5"), ["g", "5", "enter"], "outside the lines"),
    (TEXT, (), ["g", "x", "!", "enter"], "is not a page number"),
    (TEXT, (), ["/", "a", "ctrl-c"], "cancelled"),
    (TEXT, (), ["m", "h", "i", "enter", ">", "o", "h", "i", "enter"], "bookmark hi, line 1"),
    (TEXT, (), ["?", "e", "q"], "e: next heading"),
    (TEXT, (), ["h"], "question mark, then any key"),
]


@pytest.mark.parametrize(("book", "options", "keys", "said"), CASES)
def test_cases(book, options, keys, said):
    with Terminal("read", book, *STILL, "--no-places", *options) as terminal:
        assert said in terminal.press(*keys)


@pytest.mark.parametrize("how", ["q", "ctrl-c", signal.SIGTERM, signal.SIGHUP])
def test_the_terminal_is_restored(how):
    with Terminal("read", TEXT, *STILL, "--no-places") as terminal:
        assert not termios.tcgetattr(terminal.fd)[3] & termios.ICANON
        if isinstance(how, str):
            terminal.press(how)
        code = terminal.end(None if isinstance(how, str) else how)
        assert code == (0 if how == "q" else 1)
        assert termios.tcgetattr(terminal.fd)[3] & termios.ICANON


@heavy
def test_a_place_is_kept_through_a_kill(tmp_path):
    for _ in range(4):
        with Terminal("read", TEXT, *STILL) as terminal:
            terminal.press("n", "n", wait_s=0.6)
            terminal.end(signal.SIGKILL)
    db = sqlite3.connect(tmp_path / "places.sqlite")
    assert db.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    with Terminal("read", TEXT, *STILL) as terminal:
        assert terminal.press("i").startswith("line 9,")


def test_a_book_goes_on_where_it_was_closed_and_a_changed_one_near_it(tmp_path):
    book = tmp_path / "book.txt"
    shutil.copy(TEXT, book)
    with Terminal("read", str(book), *STILL) as terminal:
        terminal.press("n", "n", "n", "n", "n", "n")
        line = terminal.press("V")
        terminal.press("q")
        terminal.end()
    with Terminal("read", *STILL) as terminal:  # the book that was read last
        assert terminal.press("V") == line
    book.write_text("A new beginning.\n\n" + book.read_text())
    with Terminal("read", str(book), *STILL) as terminal:
        assert "this is your place" in terminal.said.decode()
        assert terminal.press("V") == line
    assert run("books").stdout.startswith("1: book, ")
    assert run("books", "1", "--forget").returncode == 0
    assert "no books yet" in run("books").stdout


def test_options_of_a_book_are_kept_and_a_language_that_was_chosen(call, tmp_path):
    book = tmp_path / "book.txt"
    book.write_text("un deux")
    read = ("read", str(book), "--hand", "sweep:900", "--echo", "none")
    assert "French" in call(*read, "--language", "fr").err
    assert "French" in call(*read).err
    assert "English" in call(*read, "--language", "en").err
    with Terminal("read", str(book), *STILL) as terminal:
        terminal.press("y", "d", "e", "enter")
        terminal.press("q")
        terminal.end()
    assert "German" in call("books", "1").err


def test_a_file_that_changes_while_it_is_read_is_read_anew(tmp_path):
    book = tmp_path / "book.txt"
    shutil.copy(TEXT, book)
    with Terminal("read", str(book), *STILL, "--no-places") as terminal:
        terminal.press("n", "n", "n", "n", "n", "n")
        line = terminal.press("V")
        book.write_text("A new beginning.\n\n" + book.read_text())
        terminal.wait("the file has changed")
        assert terminal.press("V") == line


def test_an_option_beats_the_profile_and_a_tuning_is_saved(tmp_path):
    settings = tmp_path / "settings.toml"
    settings.write_text('[profile.evening.stress2]\ntexture = 0.2\n[keys]\npause = "f12"\n')
    with Terminal("read", TEXT, *STILL, "--profile", "evening", "--texture", "0.8") as terminal:
        assert terminal.press("T") == "texture: 0.7"
        assert terminal.press("P") == "profile evening: saved"
        assert terminal.press("\x1b[24~") == "paused"
    assert "texture = 0.7" in settings.read_text()


def test_standard_input_is_read_with_keys_from_the_terminal():
    script = f"cat {TEXT} | {PROGRAM} read - --hand slow --cues none"
    with Terminal(program=["sh", "-c", script]) as terminal:
        assert terminal.press("n") == "line 2"
        terminal.press("q")
        assert terminal.end() == 0


def test_a_text_is_read_on_a_controller_at_a_port():
    with simulated_controller(hand="sweep:200") as spec:
        done = run("read", TEXT, "--device", spec, "--lines", "1-2", "--echo", "text")
        assert done.returncode == 0, done.stderr
        assert [line for line in done.stdout.splitlines() if line.startswith("line: ")] == [
            "line: 1", "line: 2",
        ]  # fmt: skip
        assert "late ticks" in done.stdout.splitlines()[-1]


@pytest.mark.parametrize(
    ("told", "says"),
    [
        (("--travel", "500"), "and --travel asks for 500 mm; leave --travel out, or give"),
        (("--height", "60"), "goes along x only and --height asks for 60 mm; leave --height out"),
    ],
)
def test_a_page_that_the_carriage_of_a_device_does_not_cross_is_refused(told, says):
    with simulated_controller(hand="sweep:200") as spec:
        done = run("read", TEXT, "--device", spec, *told, "--lines", "1")
    assert (done.returncode, done.stdout) == (2, "")
    assert says in done.stderr


def test_a_host_that_dies_is_said_and_is_begun_again_by_a_key():
    with Terminal("read", TEXT, *STILL, "--no-places") as terminal:
        found = subprocess.run(
            ["pgrep", "-P", str(terminal.pid)], capture_output=True, text=True, check=True
        )
        for pid in found.stdout.split():
            os.kill(int(pid), signal.SIGKILL)
        terminal.wait("space begins again")
        assert "space begins again" in terminal.press("n")
        assert "reading" in terminal.press("space", wait_s=1.0)
        assert "line 2" in terminal.press("n")
        terminal.press("q")
        assert terminal.end() == 0


REFUSED = [
    ("read", "nowhere.txt"), ("read", TEXT, "--device", "foo"), ("read", TEXT, "--hand", "foo"),
    ("read", TEXT, "--texture", "2"), ("read", TEXT, "--lines", "0"), ("books", "7"),
    ("read", TEXT, "--lines", "4000"), ("read",), ("books", "--forget"), ("tune",), ("play",),
    ("feel", "texts/scenes/house.scene"), ("feel", TEXT), ("read", TEXT, "--also", "foo"),
    ("play", "--deck", "nowhere"), ("feel", "texts/scenes/house.scene", "--y", "3"),
]  # fmt: skip


@pytest.mark.parametrize("arguments", REFUSED, ids=" ".join)
def test_refusals_are_one_sentence(call, arguments):
    done = call(*arguments)
    assert done.code == 2
    assert len(done.err.splitlines()) == 1, done.err
