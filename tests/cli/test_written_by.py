"""What earlier versions wrote: it opens, checks, exports, replays, is analysed and gone on with.

`tests/written-by` has a folder for each version whose files are kept; its README.md says how
they were made, and its `golden` what that version itself made of them.
"""

import csv
import io
import json
import re
import shutil
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest

from tests.cli.test_session_bad_input import contents
from tests.tiers import heavy
from vbraille.braille.cells import Cells
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.record.events import Presented
from vbraille.sessions.record.folder import load
from vbraille.sessions.record.replay import frames
from vbraille.sessions.record.traces import LEFT_TRACE, TRACE, read_trace

WRITTEN = Path(__file__).parent.parent / "written-by"
VERSIONS = sorted(path.parent for path in WRITTEN.glob("*/sessions"))
SESSIONS = sorted(WRITTEN.glob("*/sessions/*"))
PLANS = sorted(WRITTEN.glob("*/plans/*.txt"))


def named(path):
    return path.stem


def golden(folder, ending):
    """What the version that wrote a session made of it itself."""
    return (folder.parent.parent / "golden" / f"{folder.name}.{ending}").read_text()


def table(text):
    return list(csv.DictReader(io.StringIO(text)))


def ended(folder):
    return "the session is ended" in golden(folder, "check.txt")


@pytest.fixture(autouse=True)
def _never_rewritten(request):
    """Whatever is done with a file that is kept, it stays as it was."""
    kept = request.node.callspec.params if hasattr(request.node, "callspec") else {}
    folders = [path for path in kept.values() if isinstance(path, Path) and path.is_dir()]
    before = [contents(folder) for folder in folders]
    yield
    assert [contents(folder) for folder in folders] == before


def test_there_is_of_every_kind():
    protocols = {load(folder).protocol.name for folder in SESSIONS}
    assert protocols == {
        "control", "legibility", "letters", "tuning-spacing", "tuning-width", "words",
    }  # fmt: skip
    happened = {event.kind for folder in SESSIONS for event in load(folder).told.events}
    assert happened >= {
        "answer", "undo", "repeat", "fault", "pause", "go", "note", "stop", "end", "tuning",
        "break", "device", "closed",
    }  # fmt: skip
    assert {folder.name for folder in SESSIONS if load(folder).told.torn} == {"letters-torn"}
    of = {form: sum(load(folder).told.format == form for folder in SESSIONS) for form in (1, 2, 3)}
    assert of == {1: 9, 2: 9, 3: 9}
    assert {ended(folder) for folder in SESSIONS} == {True, False}


@pytest.mark.parametrize("path", PLANS, ids=named)
def test_a_plan_that_was_printed_is_that_of_the_session(path):
    printed = [line for line in path.read_text().splitlines() if line.startswith("trial ")]
    for folder in sorted(path.parent.parent.glob("sessions/*")):
        text = (folder / "plan.json").read_text()
        plan = Plan.from_json(text)
        assert plan.to_json() == text
        if plan.protocol != path.stem:
            continue
        for trial, line in zip(plan.trials, printed, strict=True):
            if len(trial.stimuli) == 2:
                said = ", then ".join(f"{stimulus.value:g} mm" for stimulus in trial.stimuli)
            else:
                said = Cells.bare(np.array(trial.stimuli[0].masks, np.uint8)).to_unicode()
            assert line.startswith(f"trial {trial.number}: ")
            assert said in line


def test_a_plan_that_was_printed_to_emboss_has_the_strings_of_its_session():
    for path in WRITTEN.glob("*/plans/*.brf"):
        plan = load(path.parent.parent / "sessions" / f"{path.stem}-ended").plan
        strings = [Cells.bare(np.array(t.stimuli[0].masks, np.uint8)) for t in plan.trials]
        assert path.read_text().splitlines() == [string.to_brf() for string in strings]


@pytest.mark.parametrize("folder", SESSIONS, ids=named)
def test_a_session_checks_as_it_did(call, folder):
    said = call("session", "check", folder)
    assert (said.code, said.err) == (0, "")
    today = said.out.splitlines()
    assert [line for line in golden(folder, "check.txt").splitlines() if line not in today] == []
    untied = load(folder).told.format == 1 and bool(list(folder.glob("trace-*.gz")))
    assert ("traces: of format 1, which does not tie them to the journal" in said.out) == untied


@pytest.mark.parametrize("folder", SESSIONS, ids=named)
def test_a_session_is_exported_as_it_was(call, folder, tmp_path):
    said = call("session", "export", folder, "--out", tmp_path / "t.csv")
    assert (said.code, said.err) == (0, "")
    then = table(golden(folder, "csv"))
    columns = list(then[0])  # there may be more today
    assert [
        {name: row[name] for name in columns} for row in table((tmp_path / "t.csv").read_text())
    ] == then
    said = call("session", "export", folder, "--bids", "--out", tmp_path / "set")
    assert (said.code, said.err) == (0, "")


@pytest.mark.parametrize("folder", SESSIONS, ids=named)
def test_a_session_is_replayed_bit_for_bit(folder):
    sums = (folder.parent.parent / "golden" / "frames.sha256").read_text()
    then = dict(reversed(line.split()) for line in sums.splitlines())
    replayed = sha256()
    for _, _, deflections in frames(load(folder)):
        replayed.update(deflections.tobytes())
    assert replayed.hexdigest() == then[folder.name]


@pytest.mark.parametrize("folder", VERSIONS, ids=named)
def test_the_sessions_of_a_version_are_analysed_together(call, folder):
    check_analysed(call, sorted(folder.glob("sessions/*")))


@heavy  # to analyse one takes as long as to analyse all
@pytest.mark.parametrize("folder", SESSIONS, ids=named)
def test_a_session_is_analysed(call, folder):
    check_analysed(call, [folder])


def check_analysed(call, folders):
    said = call("analyse", *folders, "--json")
    assert (said.code, said.err) == (0, "")
    about = json.loads(said.out)["about"]
    for folder in folders:
        answered = sum(row["answered"] != "" for row in table(golden(folder, "csv")))
        assert answered
        assert f", {answered} of " in about[f"Session {folder.name}"]


@pytest.mark.parametrize("folder", [f for f in SESSIONS if not ended(f)], ids=named)
def test_a_session_is_gone_on_with_in_its_own_format(call, folder, tmp_path):
    copy = shutil.copytree(folder, tmp_path / "s")
    how = ("--answers", "simulated", "--device", "sim", "--hand", "sweep:200", "--fast")
    said = call("session", "resume", copy, *how)
    assert (said.code, said.err) == (0, "")
    checked = call("session", "check", copy)
    assert checked.code == 0
    assert re.search(r"answers: (\d+) of \1; the session is ended", checked.out)
    then = [row for row in table(golden(folder, "csv")) if row["answered"]]
    now = table(call("session", "export", copy).out)
    assert [row["answered"] for row in now][: len(then)] == [row["answered"] for row in then]
    assert all(row["answered"] for row in now)
    # What was there is there, and what was added is of the same format.
    for path in folder.iterdir():
        before, after = path.read_bytes(), (copy / path.name).read_bytes()
        if path.name == "journal.jsonl":
            before = before[: before.rfind(b"\n") + 1]
            assert after.startswith(before)
        else:
            assert after == before
    formats = load(folder).head["format"], load(copy).told.format
    assert formats[0] == formats[1]
    if formats[1] == 1:
        assert not any(event.up_s for event in load(copy).told.events)
        assert not any(read_trace(path).ties for path in copy.glob("trace-*.gz"))
    for path in copy.glob("trace-*.gz"):
        assert read_trace(path).ticks.dtype == (LEFT_TRACE if formats[1] < 3 else TRACE)
    assert not any(event.shown for event in load(copy).told.events if isinstance(event, Presented))


@pytest.mark.parametrize("folder", [f for f in SESSIONS if ended(f)], ids=named)
def test_a_session_that_has_ended_is_not_gone_on_with(call, folder, tmp_path):
    copy = shutil.copytree(folder, tmp_path / "s")
    said = call("session", "resume", copy)
    assert (said.code, said.out) == (2, "")
    assert said.err == f"vbraille: {copy} has ended; session export makes tables of it\n"
    assert {p.name: c for p, c in contents(copy).items()} == {
        p.name: c for p, c in contents(folder).items()
    }
