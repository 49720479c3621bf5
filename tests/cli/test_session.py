"""``vbraille session``: plans, sessions, tables and what is said of them."""

import csv
import hashlib
import io
import json
import os
import re
import resource
import shutil
import subprocess
import sys
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from tests.cli import program
from tests.cli.test_session_bad_input import contents
from tests.sessions.sittings import COMPARED, MINI, crash
from vbraille.sessions.planning.protocolfiles import builtin_names
from vbraille.sessions.record.traces import read_trace

WHO = ("--participant", "P07")
PAPER = MINI.replace('model = "vbd"', 'model = "vbd"\nmedium = "paper"')
# Root without its privileges, to whom a directory can be read-only.
PLAIN = ["setpriv", "--bounding-set=-all", "--inh-caps=-all"] if os.geteuid() == 0 else []


def words(room, protocol=MINI):
    """Arguments to run a session."""
    (room / "mini.toml").write_text(protocol)
    how = ("--seed", "1", "--answers", "simulated", "--hand", "sweep:150", "--fast")
    return "session", "run", room / "mini.toml", *WHO, *how, "--out", room / "s"


@pytest.fixture(scope="module")
def ended(tmp_path_factory):
    """A session that was run to its end, and what was said."""
    room = tmp_path_factory.mktemp("session")
    return room / "s", program.run(*words(room))


@pytest.fixture
def folder(ended, tmp_path):
    """A copy of its directory."""
    return shutil.copytree(ended[0], tmp_path / "s")


@pytest.mark.new_processes
def test_nobody_else_may_read_a_session_whatever_the_umask_says(tmp_path):
    (tmp_path / "mini.toml").write_text(MINI)
    folder = tmp_path / "sessions" / "s"
    arguments = ("run", tmp_path / "mini.toml", *WHO, "--seed=1", "--hand=sweep:150", "--fast")
    answers = tmp_path / "answers"
    answers.write_text("l\n")
    how = {"umask": 0, "capture_output": True}
    trigger, port = os.openpty()
    more = ("--answers", answers, "--out", folder, "--markers", f"serial:{os.ttyname(port)}")
    program.run("session", *arguments, *more, **how)  # there are too few answers
    with (folder / "journal.jsonl").open("ab") as file:
        file.write(b"torn")
    program.run("session", "resume", folder, "--answers", "simulated", "--fast", **how)
    os.close(trigger)
    os.close(port)
    modes = {path.name: path.stat().st_mode & 0o777 for path in folder.iterdir()}
    assert {"journal.torn", "journal.jsonl", "protocol.toml"} <= modes.keys()
    assert any(name.startswith("trace") for name in modes)
    assert any(name.startswith("markers") for name in modes)
    assert set(modes.values()) == {0o600}
    assert {p.stat().st_mode & 0o777 for p in (folder, folder.parent)} == {0o700}


def test_protocols_are_listed_a_line_each(call):
    said = call("session", "protocols")
    assert (said.code, said.err) == (0, "")
    lines = said.out.splitlines()
    assert [line.split(":")[0] for line in lines] == builtin_names()
    assert "letters: Identification of letters; 78 trials, STReSS²" in lines


@pytest.mark.parametrize("name", ["legibility", "letters", "tuning-width"])
def test_a_protocol_that_was_printed_and_kept_plans_the_same(call, tmp_path, name):
    mine = tmp_path / "mine.toml"
    mine.write_text(call("session", "protocols", name).out)
    plans = [call("session", "plan", p, *WHO, "--seed", "42") for p in (name, mine)]
    assert plans[0].code == 0
    assert plans[0] == plans[1]


def test_a_plan_is_a_line_a_trial(call):
    said = call("session", "plan", "legibility", *WHO, "--seed", "42")
    assert (said.code, said.err) == (0, "")
    lines = said.out.splitlines()
    assert lines[0] == "protocol: legibility, 160 trials, participant P07, seed 42"
    trials = [line for line in lines if line.startswith("trial ")]
    assert len(trials) == 160
    for number, line in enumerate(trials, 1):
        assert re.fullmatch(rf"trial {number}: (nominal|textured), ⠉[⠁⠉⠈⠀]{{2}}⠉, dots .+", line)
    assert len([line for line in lines if line.startswith("practice ")]) == 8
    assert lines[1].startswith("analysis: legibility of strings by condition")
    assert re.fullmatch(r"length: some \d\d minutes, .+", lines[2])
    assert len(lines) == 3 + 160 + 8 + 3  # practice, two blocks


def test_of_a_comparison_the_plan_tells_both_values(call, tmp_path):
    (tmp_path / "two.toml").write_text(COMPARED)
    said = call("session", "plan", tmp_path / "two.toml", *WHO, "--seed", "1")
    trials = [line for line in said.out.splitlines() if line.startswith("trial ")]
    assert trials
    assert all(re.fullmatch(r"trial \d+: [12] mm, then [12] mm", line) for line in trials)
    said = call("session", "plan", tmp_path / "two.toml", *WHO, "--seed", "1", "--brf")
    assert (said.code, said.out) == (2, "")
    assert "widths compares dots, which cannot be embossed" in said.err


def test_a_plan_whose_values_the_answers_choose_says_where_the_standard_is(call, tmp_path):
    (tmp_path / "three.toml").write_text(
        COMPARED.replace("[1.0, 2.0]", "[2.1, 3.0]") + 'reference = 2.0\nform = "triangle"\n'
        '[question]\nkind = "odd"\n[procedure]\nkind = "staircase"\nstart = [0.8]\n'
        "steps = [0.1]\n"
    )
    said = call("session", "plan", tmp_path / "three.toml", *WHO, "--seed", "1")
    assert said.code == 0
    trials = [line.split(": all, ")[1] for line in said.out.splitlines() if ": all, " in line]
    orders = {tuple(trial.split(", then ")) for trial in trials}
    assert len(orders) == 6
    assert {part for order in orders for part in order} == {"a value", "the standard"}


def test_a_seed_that_was_drawn_is_said_and_makes_the_plan_again(call):
    drawn = call("session", "plan", "letters", *WHO)
    seed = re.fullmatch(r"seed: (\d+)\n", drawn.err)[1]
    again = call("session", "plan", "letters", *WHO, "--seed", seed)
    assert (again.out, again.err) == (drawn.out, "")
    other = call("session", "plan", "letters", *WHO, "--seed", int(seed) + 1)
    assert other.out != drawn.out


def test_participants_have_hands_of_their_own(call, tmp_path):
    (tmp_path / "mini.toml").write_text(MINI)
    places = []
    for name, who in (("a", "P01"), ("b", "P02"), ("c", "P01")):
        how = ("--seed", "1", "--answers", "simulated", "--hand", "fluent", "--fast")
        run = call(
            "session", "run", tmp_path / "mini.toml", "--participant", who, *how,
            "--out", tmp_path / name,
        )  # fmt: skip
        assert run.code == 0, run.err
        places.append(read_trace(tmp_path / name / "trace-001.gz").ticks["x_mm"])
    assert (places[0] == places[2]).all()
    assert not np.array_equal(places[0], places[1])


def test_the_strings_of_a_plan_can_be_embossed(call):
    said = call("session", "plan", "control", *WHO, "--seed", "3", "--brf")
    assert said.code == 0
    lines = said.out.splitlines()
    trials = call("session", "plan", "control", *WHO, "--seed", "3").out.splitlines()
    trials = [line for line in trials if line.startswith("trial ")]
    assert len(lines) == len(trials)
    north_american = " A1B'K2L@CIF/MSP\"E3H9O6R^DJG>NTQ,*5<-U8V.%[$+X!&;:4\\0Z7(_?W]#Y)="
    for line, trial in zip(lines, trials, strict=True):
        shown = trial.split(", ")[1]
        assert line == "".join(north_american[ord(cell) - 0x2800] for cell in shown)


def test_a_session_says_what_happens_and_has_its_files(ended):
    folder, said = ended
    assert (said.returncode, said.stderr) == (0, "")
    lines = said.stdout.splitlines()
    assert lines[0] == f"session: {folder}"
    assert lines[-2] == "end: all trials are done; 4 of 4 have answers"
    journal = (folder / "journal.jsonl").read_bytes()
    sum_of = hashlib.sha256(journal).hexdigest()
    assert lines[-1] == f"record: {len(journal.splitlines())} events, SHA-256 {sum_of}"
    assert [line[:17] for line in lines if line.startswith("answer")] == [
        f"answer: trial {n} o" for n in range(1, 5)
    ]
    assert sorted(path.name for path in folder.iterdir()) == [
        "journal.jsonl", "plan.json", "protocol.toml", "session.json", "trace-001.gz",
    ]  # fmt: skip
    assert list(folder.parent.glob(".*")) == []


def test_check_says_what_is_whole(call, folder):
    before = contents(folder)
    said = call("session", "check", folder)
    assert (said.code, said.err) == (0, "")
    assert re.fullmatch(
        r"session\.json, plan\.json, protocol\.toml: as they were when the session began\n"
        r"plan: 4 trials, as the seed makes them\n"
        r"journal\.jsonl: \d+ events, whole\n"
        r"trace-001\.gz: \d+ ticks, 0 missing, 0 deadlines late\n"
        r"answers: 4 of 4; the session is ended\n"
        r"record: \d+ events, SHA-256 [0-9a-f]{64}\n",
        said.out,
    )
    found = json.loads(call("session", "check", folder, "--json").out)
    assert found == {
        "good": True,
        "findings": [{"text": text, "good": True} for text in said.out.splitlines()],
    }
    assert contents(folder) == before


def test_what_a_crash_cut_short_is_said_and_all_else_is_clean(call, folder):
    path = folder / "journal.jsonl"
    path.write_bytes(path.read_bytes()[:-200])  # in the last line, which no trace was written after
    said = call("session", "check", folder)
    assert (said.code, said.err) == (0, "")
    assert "journal.jsonl: its last line was cut short, " in said.out
    assert "fault" not in said.out


def test_damage_is_said_by_all_and_mended_by_none(call, folder, tmp_path):
    path = folder / "journal.jsonl"
    lines = path.read_bytes().splitlines(keepends=True)
    second = [n for n, line in enumerate(lines) if b'"answer"' in line][1]
    lines[second + 1] = lines[second + 1].replace(b'"wall":"2', b'"wall":"3')
    path.write_bytes(b"".join(lines))
    before = contents(folder)
    what = f"line {second + 2} does not match its checksum"

    said = call("session", "check", folder)
    assert (said.code, said.err) == (1, "")
    assert f"fault: journal.jsonl: damaged, {what}; the {second + 1} events before it" in said.out
    assert "after it, which session export --salvage has too" in said.out
    assert said.out.count("fault: ") == 1
    assert "answers: 4 of 4" in said.out

    said = call("session", "resume", folder)
    assert (said.code, said.out) == (1, "")
    assert said.err.count("\n") == 1
    assert f"the {second + 1} events before it are whole, and nothing was changed" in said.err

    said = call("session", "export", folder, "--out", tmp_path / "t.csv")
    assert (said.code, said.out.splitlines()[0]) == (1, f"written: {tmp_path}/t.csv, 4 rows")
    assert said.err == f"vbraille: exported is what is whole; journal.jsonl is damaged, {what}\n"
    table = list(csv.DictReader(io.StringIO((tmp_path / "t.csv").read_text())))
    assert [row["answered"] != "" for row in table] == [True, True, False, False]
    assert contents(folder) == before


def test_a_missing_trace_is_said_and_the_answers_are_exported(call, folder):
    (folder / "trace-001.gz").unlink()
    said = call("session", "check", folder)
    assert said.code == 1
    assert "fault: trace-001.gz: damaged, it is gone" in said.out
    said = call("session", "export", folder)
    assert said.code == 1
    assert "exported is what is whole; trace-001.gz is damaged, it is gone" in said.err
    assert [row["answered"] != "" for row in csv.DictReader(io.StringIO(said.out))] == [True] * 4


def test_a_missing_plan_is_said_and_nothing_goes_on_without(call, folder):
    (folder / "plan.json").unlink()
    said = call("session", "check", folder)
    assert said.code == 1
    assert said.out.startswith(f"fault: {folder}/plan.json cannot be read: No such file")
    assert "events, whole" in said.out
    for action in ("export", "resume"):
        said = call("session", action, folder)
        assert (said.code, said.out) == (1, "")
        assert "plan.json cannot be read: No such file or directory" in said.err


def test_tables_can_always_be_made_again_byte_for_byte(call, folder, tmp_path):
    printed = call("session", "export", folder)
    assert printed.code == 0
    assert re.fullmatch(r"record: \d+ events, SHA-256 [0-9a-f]{64}\n", printed.err)
    for name in ("one", "two"):
        said = call("session", "export", folder, "--out", tmp_path / f"{name}.csv")
        assert (said.code, said.err) == (0, "")
        assert said.out == f"written: {tmp_path}/{name}.csv, 4 rows\n{printed.err}"
        assert (tmp_path / f"{name}.csv").read_text() == printed.out
        said = call("session", "export", folder, "--bids", "--out", tmp_path / name)
        assert (said.code, said.err, said.out.count("written: ")) == (0, "", 10)
    sets = [{p.relative_to(tmp_path / n): c for p, c in contents(tmp_path / n).items()}
            for n in ("one", "two")]  # fmt: skip
    assert sets[0] == sets[1]
    assert len(printed.out.splitlines()) == 5


def test_what_is_there_is_never_written_over(call, folder):
    before = contents(folder)
    said = call(*words(folder.parent))
    assert (said.code, said.out) == (2, "")
    assert said.err.endswith("s is there already; give a new directory with --out\n")
    assert contents(folder) == before


def test_texture_and_contrast_that_are_given_are_in_the_record(call, tmp_path):
    assert call(*words(tmp_path), "--texture", "0.5", "--contrast", "0.75").code == 0
    table = list(csv.DictReader(io.StringIO(call("session", "export", tmp_path / "s").out)))
    assert {(row["texture"], row["contrast"]) for row in table} == {("0.5", "0.75")}
    assert call("session", "check", tmp_path / "s").code == 0


@pytest.mark.skipif(bool(PLAIN) and not shutil.which("setpriv"), reason="root may write anywhere")
def test_a_directory_that_is_read_only_is_checked_and_exported_and_not_resumed(folder):
    path = folder / "journal.jsonl"
    crash(folder, path.read_bytes().index(b'"event":"end"'))
    before = contents(folder)
    for each in folder.iterdir():
        each.chmod(0o444)
    folder.chmod(0o555)
    said = {}
    for action in ("check", "export", "resume"):
        said[action] = subprocess.run(
            [*PLAIN, *program.PROGRAM, "session", action, folder],
            capture_output=True, encoding="utf-8", check=False,
        )  # fmt: skip
    folder.chmod(0o755)
    assert [done.returncode for done in said.values()] == [0, 0, 2]
    assert said["check"].stderr == ""
    assert said["resume"].stderr.count("\n") == 1
    assert "journal.jsonl cannot be opened for writing: Permission denied" in said["resume"].stderr
    assert contents(folder) == before


@pytest.mark.parametrize(
    ("protocol", "limit", "what"),
    [(MINI, 6_000, r"trace-001\.gz"), (PAPER, 2_500, r"journal\.jsonl"), (MINI, 400, "s")],
    ids=["trace", "journal", "birth"],
)
def test_a_full_disk_costs_no_answer_that_was_acknowledged(call, tmp_path, protocol, limit, what):
    answers = tmp_path / "answers"
    answers.write_text("l\nc\n?\nl\n")
    more = ("--answers", answers) if protocol is PAPER else ()
    full = partial(resource.setrlimit, resource.RLIMIT_FSIZE, (limit, limit))
    # Python would write a part of what it has compiled of a module, and fail ever after.
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    said = program.run(*words(tmp_path, protocol), *more, preexec_fn=full, env=environment)
    assert said.returncode == 1
    assert said.stderr.count("\n") == 1
    assert re.search(rf"/{what} cannot be written: File too large", said.stderr)
    if what == "s":
        assert sorted(path.name for path in tmp_path.iterdir()) == ["answers", "mini.toml"]
        return
    acknowledged = re.findall(r"^answer: trial (\d) of 4", said.stdout, re.MULTILINE)
    assert 0 < len(acknowledged) < 4
    assert (tmp_path / "s" / "journal.jsonl").read_bytes().endswith(b"\n")
    checked = call("session", "check", tmp_path / "s")
    assert checked.code == 0
    assert f"answers: {len(acknowledged)} of 4; the session is not ended" in checked.out
    again = call("session", "resume", tmp_path / "s")
    assert (again.code, again.err) == (0, "")
    checked = call("session", "check", tmp_path / "s")
    assert checked.code == 0
    assert "answers: 4 of 4; the session is ended" in checked.out


def test_what_a_killed_birth_left_is_gone_after_the_next_run(call, tmp_path):
    unborn = tmp_path / ".s.partial"
    unborn.mkdir()
    (unborn / "plan.json").write_text("{")
    assert call(*words(tmp_path)).code == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mini.toml", "s"]


def test_a_session_without_a_name_is_named_after_who_and_what_and_when(call, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("mini.toml").write_text(MINI)
    said = call("session", "run", "mini.toml", *WHO, "--answers", "simulated", "--fast")
    assert said.code == 0
    assert re.fullmatch(r"seed: \d+\n", said.err)
    name = re.match(r"session: (P07-mini-\d{8}-\d{6})\n", said.out)[1]
    assert (tmp_path / name / "journal.jsonl").is_file()


def test_a_session_of_strings_loads_nothing_heavy():
    code = "import vbraille.cli.old.commands.session, vbraille.sessions.session, sys\n"
    code += "from vbraille.sessions.planning.protocolfiles import load_protocol\n"
    code += "import vbraille.sessions.running.apparatus; load_protocol('legibility')\n"
    done = subprocess.run(
        [sys.executable, "-c", f"{code}print(*sys.modules)"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    loaded = set(done.stdout.split())
    assert "vbraille.sessions.session" in loaded
    assert not loaded & {"numba", "louis", "scipy", "pandas", "matplotlib", "h5py", "serial"}
