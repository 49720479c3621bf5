"""Sessions: what cannot be used is one sentence, and nothing is written."""

import os
import re
import sys

import pytest

from tests.cli import program
from tests.cli.test_bad_input import refused
from tests.sessions.sittings import MINI, Session
from vbraille.sessions.record import events, journal
from vbraille.sessions.record.folder import FORMAT
from vbraille.sessions.record.journal import encode, first_lines

FAST = ("--participant", "P07", "--seed", "1", "--answers", "simulated", "--fast")


@pytest.fixture
def room(tmp_path, monkeypatch):
    """An empty directory to work in; whatever was tried, it holds what it held."""
    room = tmp_path / "room"
    room.mkdir()
    (room / "mini.toml").write_text(MINI)
    (room / "few").write_text("l\nc\nl c\n")
    (room / "full").mkdir()
    (room / "full" / "notes.txt").write_text("mine")
    monkeypatch.chdir(room)
    monkeypatch.setattr(sys, "stdin", None)
    before = contents(tmp_path)
    yield room
    assert contents(tmp_path) == before


def contents(folder):
    """All there is, byte by byte."""
    return {
        path: path.read_bytes() if path.is_file() else None for path in sorted(folder.rglob("*"))
    }


@pytest.mark.parametrize(
    ("options", "pattern"),
    [
        ("", "the following arguments are required: PROTOCOL, --participant"),
        ("legibilty --participant P07", "no protocol 'legibilty'; the nearest is legibility, and"),
        ("./none.toml --participant P07", r"there is no file \./none\.toml; check the name"),
        ("./full --participant P07", "full is a directory; give a protocol in it"),
        ("mini.toml --participant ../P07", r"participant is '\.\./P07'; it must be a pseudonym"),
        ("mini.toml --participant a/b", "it must be a pseudonym"),
        ("mini.toml --participant P07 --seed 1.5", "'1.5' is not a whole number"),
        ("mini.toml --participant P07 --seed=-1", "seed is -1; it must be 0 or more"),
        ("mini.toml --participant P07 --seed 9999999999999999999", "is not a whole number"),
        ("mini.toml --participant P07 --order 1", "mini has no balanced orders; leave --order"),
        ("legibility --participant Px", "Px has none; give --order N, or a participant such as"),
        ("legibility --participant P07 --order 0", "order is 0; it must be 1 or more"),
        ("mini.toml --participant P07 --texture 2", "texture is 2; it must be 0 to 1"),
        ("mini.toml --participant P07 --contrast nan", "contrast is nan; it must be"),
        ("legibility --participant P07 --texture 0.5", "has its own texture; leave --texture out"),
    ],
)
@pytest.mark.parametrize("action", ["plan", "run"])
@pytest.mark.usefixtures("room")
def test_what_cannot_be_planned(call, action, options, pattern):
    assert re.search(pattern, refused(call("session", action, *options.split())))


@pytest.mark.parametrize(
    ("old", "new", "pattern"),
    [
        ("length", "lenght", r"\[design\] has no key 'lenght'; the nearest is length, and"),
        ("length = 1", "length = 40", r"\[design\] "),
        ('["a", "c", "4", "0"]', '["b"]', r"has the cell .*shows dots 1 and 4 only; leave"),
        ('kind = "comb', 'kind = "sets-', "kind is 'sets-inations'; the nearest is"),
        ("format = 1", "format = 2", "format"),
        ("[design]", "[design", "mini.toml"),
        ("", "\x00", "mini.toml"),
    ],
)
def test_protocols_of_no_use(call, room, old, new, pattern):
    text = MINI.replace(old, new) if old else new
    (room / "mini.toml").write_text(text)
    said = refused(call("session", "run", "mini.toml", *FAST, "--out", "s"))
    assert re.search(pattern, said)
    (room / "mini.toml").write_text(MINI)


@pytest.mark.parametrize(
    ("options", "pattern"),
    [
        ("--answers typed", "--fast is for answers that are not typed; give --answers simulated"),
        (
            "--device serial:/dev/ttyACM0 --hand device",
            "^--hand is for the simulated device, and serial:/dev/ttyACM0 is moved by a",
        ),
        ("--device serial:/dev/ttyACM0", "--fast is for the simulated device; leave out --device"),
        ("--answers simulated:loud", "'loud' is no habit of a simulated reader; give its noise"),
        ("--answers simulated:-1", "noise is -1; it must be 0 to"),
        ("--answers simulated:nan", "noise is nan; it must be 0 to"),
        ("--answers none", "none cannot be read: No such file or directory"),
        ("--answers full", "full cannot be read: Is a directory"),
        ("--answers few", "few line 3: "),
        ("--field nose=big", "mini does not ask for 'nose'; it asks for nothing"),
        ("--field nose", "argument --field: 'nose' is not NAME=VALUE"),
        ("--hand glove", "there is no hand 'glove'; give sweep:SPEED"),
        ("--hand sweep:0", "sweep speed is 0 mm/s"),
        ("--hand recorded:none.csv", "there is no file none.csv"),
        ("--rate 0", "rate is 0 Hz; it must be 1 to 10000 Hz"),
        ("--rate nan", "rate is nan Hz"),
        ("--rate 1e9", "it must be 1 to 10000 Hz"),
        ("--cues drum", "argument --cues: invalid choice: 'drum'"),
        ("--out full", "full is there already; give a new directory with --out"),
        ("--out few", "few is there already; give a new directory with --out"),
        ("--out few/s", "few/s cannot be written: Not a directory"),
        ("--out /proc/none/s", "/proc/none/s cannot be written: No such file or directory"),
        ("--out .", "is there already"),
        (f"--out {'a' * 300}", "cannot be written: File name too long"),
        (f"--out new/deep/{'a' * 250}", "cannot be written: File name too long"),
        ("--out s --no-such", "unrecognized arguments: --no-such"),
    ],
)
@pytest.mark.usefixtures("room")
def test_options_of_a_session(call, options, pattern):
    out = () if "--out" in options else ("--out", "s")
    said = call("session", "run", "mini.toml", *FAST, *out, *options.split())
    assert re.search(pattern, refused(said))
    assert said.err.count("\n") == 1


@pytest.mark.parametrize(
    ("options", "pattern"),
    [
        ("--field finger=thumb", "finger is 'thumb'; it must be index or middle"),
        ("--field toe=1", "does not ask for 'toe'; it asks for finger, hand, masking_noise"),
    ],
)
@pytest.mark.usefixtures("room")
def test_what_a_protocol_asks_about_the_participant(call, options, pattern):
    said = call("session", "run", "legibility", *FAST, "--out", "s", *options.split())
    assert re.search(pattern, refused(said))


def test_enter_alone_is_no_choice(room):
    done = program.run(
        "session", "run", "legibility", "--participant", "P07", "--seed=1", "--out", "s",
        "--field", "masking_noise=yes", "--field", "hand=right", stdin=None, input="\n", cwd=room,
    )  # fmt: skip
    assert done.returncode == 2
    assert "finger was not answered" in done.stderr
    assert not (room / "s").exists()


def test_an_answer_to_a_field_is_one_line_of_text(call, room):
    (room / "asks.toml").write_text(MINI + '[[fields]]\nname = "age"\nask = "Age"\n')
    for value in ("a\nb", "\x1b[2J", "\udcff"):
        said = call("session", "run", "asks.toml", *FAST, "--out", "s", "--field", f"age={value}")
        assert re.search("age is .*; it must be one line of text", refused(said))
    (room / "asks.toml").unlink()


def test_a_field_that_nobody_fills_in(call, room):
    asks = MINI + '[[fields]]\nname = "age"\nask = "Age"\n'
    (room / "asks.toml").write_text(asks)
    said = call("session", "run", "asks.toml", "--participant", "P07", "--seed", "1", "--out", "s")
    assert (said.code, said.out) == (2, "Age:\n")
    assert said.err == "vbraille: age was not answered; give --field age=…\n"
    said = call("session", "run", "asks.toml", "--participant", "P07", "--out", "full")
    assert "full is there already" in refused(said)  # before anything is asked
    (room / "asks.toml").unlink()


@pytest.mark.usefixtures("room")
def test_on_paper_nothing_can_be_felt(call):
    said = call("session", "run", "control", *FAST, "--out", "s")
    assert "control is read on paper, which the simulated reader cannot feel" in refused(said)


@pytest.mark.usefixtures("room")
def test_a_device_that_cannot_be_opened(call):
    options = ("--participant", "P1", "--seed", "1", "--answers", "simulated", "--out", "s")
    said = call("session", "run", "mini.toml", *options, "--device", "serial:/dev/nonexistent")
    assert re.search("there is no port /dev/nonexistent; there is ", refused(said))


@pytest.mark.parametrize(
    ("answers", "line", "what"),
    [
        ("l\nq\n", 2, "."),
        ("\n# a remark\nll\n", 3, "."),
        ("l\nnote it went well\nanswer\n", 3, "."),
        ("l\nc\nl\n?\nl\n", 5, "there is no trial left to answer"),
        ("l\nundo\nc\nl\nc\n?\nl\n", 7, "there is no trial left to answer"),
    ],
)
def test_answers_that_are_none(call, room, answers, line, what):
    (room / "given").write_text(answers)
    said = call("session", "run", "mini.toml", *FAST, "--out", "s", "--answers", "given")
    assert re.search(f"^given line {line}: {what}", refused(said))
    (room / "given").unlink()


def test_an_undone_answer_is_not_counted_twice(call, tmp_path):
    (tmp_path / "mini.toml").write_text(MINI)
    (tmp_path / "given").write_text("l\nundo\nc\nl\nc\n?\nundo\nl\n")
    out = ("--out", tmp_path / "s", "--answers", tmp_path / "given")
    said = call("session", "run", tmp_path / "mini.toml", *FAST, *out)
    assert (said.code, said.err) == (0, "")
    assert "4 of 4 have answers" in said.out


def of_format(number):
    def made(room):
        first = events.Session(format=number, sha256={}, t_s=0.0)
        (room / journal.NAME).write_bytes(first_lines(first))

    return made


def of_something_else(room):
    (room / journal.NAME).write_bytes(encode(events.Begin(n=1, t_s=0.0), 0)[0])


def of_no_event(room):
    (room / journal.NAME).write_bytes(b"today was a good day\n")


def without_its_journal(room):
    for name in ("session.json", "plan.json", "protocol.toml"):
        (room / name).write_text("")


@pytest.mark.parametrize("action", ["check", "export", "resume"])
@pytest.mark.parametrize(
    ("made", "code", "pattern"),
    [
        *(
            (
                of_format(number),
                2,
                f"is a session of format {number}, and this vbraille knows format {FORMAT}; use",
            )
            for number in (1, FORMAT - 1, FORMAT + 1)
        ),
        (of_something_else, 2, r"journal\.jsonl is not the journal of a session"),
        (of_no_event, 1, r"is damaged in its first line; there is nothing to go by"),
        (without_its_journal, 1, r"has lost its journal\.jsonl; there is nothing to go by"),
        (os.listdir, 2, r"is not the directory of a session: it has no journal\.jsonl"),
        (lambda folder: folder.rmdir(), 2, r"there is no directory "),
        (lambda f: (f.rmdir(), f.write_text("")), 2, "cannot be read: Not a directory; give a"),
    ],
)
def test_what_is_no_session(call, tmp_path, action, made, code, pattern):
    folder = tmp_path / "s"
    folder.mkdir()
    made(folder)
    before = contents(tmp_path)
    assert re.search(pattern, refused(call("session", action, folder), code=code))
    assert contents(tmp_path) == before


@pytest.mark.usefixtures("room")
def test_names_that_no_directory_has(call):
    for action in ("check", "export", "resume"):
        assert "File name too long" in refused(call("session", action, "a" * 300))


def test_where_no_table_is_written(call, tmp_path):
    Session(tmp_path / "s")
    (tmp_path / "mine").write_text("mine")
    assert call("session", "export", tmp_path / "s", "--bids", "--out", tmp_path / "set").code == 0
    before = contents(tmp_path)
    long = tmp_path / ("a" * 300)
    for options, pattern in [
        (("--out", tmp_path / "mine"), "mine already exists"),
        (("--out", tmp_path / "s"), "s is there already"),
        (("--out", ""), "is a directory; give the name of a file"),
        (("--out", tmp_path / "no" / "t.csv"), "cannot be written: No such file or directory"),
        (("--out", tmp_path / "mine" / "t.csv"), "cannot be written: Not a directory"),
        (("--out", "/proc/t.csv"), "/proc/t.csv cannot be written"),
        (("--out", long), "cannot be written: File name too long"),
        (("--bids",), "--bids needs a directory; give one with --out"),
        (("--bids", "--out", ""), "--bids needs a directory"),
        (("--bids", "--out", tmp_path / "set"), "is there already, as .*; give another directory"),
        (("--bids", "--out", tmp_path / "mine"), "mine cannot be written: Not a directory"),
        (("--bids", "--out", "/proc/t"), "/proc/t cannot be written: No such file or directory"),
        (("--bids", "--out", tmp_path / "new" / ("a" * 300)), "cannot be written: File name too"),
    ]:
        said = refused(call("session", "export", tmp_path / "s", *options))
        assert re.search(pattern, said), (options, said)
        assert contents(tmp_path) == before


def test_a_session_that_has_ended_is_not_resumed(call, tmp_path):
    Session(tmp_path / "s").sit()
    before = contents(tmp_path)
    said = call("session", "resume", tmp_path / "s")
    assert "s has ended; session export makes tables of it" in refused(said)
    assert contents(tmp_path) == before


@pytest.mark.no_cover
@pytest.mark.usefixtures("room")
def test_nothing_that_is_tried_is_a_fault_of_its_own(call, rng):
    values = [
        "",
        "-",
        "--",
        ".",
        "/",
        "x" * 300,
        "0",
        "1e400",
        "é\n",
        "\x1b[2J",
        "simulated",
        "a:b",
    ]
    options = ["--seed", "--order", "--out", "--hand", "--rate", "--answers", "--field", "--device"]
    for _ in range(80):
        name, value = str(rng.choice(options)), str(rng.choice(values))
        # As --fast is for answers that are not typed, nothing is ever begun.
        said = call(
            "session", "run", "mini.toml", "--participant", "P07", "--answers", "typed", "--fast",
            *(() if name == "--answers" else (f"{name}={value}",)),
            *((f"{name}={value}", "--field=x") if name == "--answers" else ()),
        )  # fmt: skip
        refused(said)
