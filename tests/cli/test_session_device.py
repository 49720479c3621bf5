"""Sessions on devices, real processes and lines between: what the participant feels and does."""

import json
import os
import re
import shutil
import signal

import numpy as np
import pytest

from tests import drivers, forking
from tests.cli import program
from tests.cli.program import Terminal
from tests.cli.test_read_serial import simulated
from tests.sessions.sittings import MINI
from tests.tiers import TIER, Tier, by_tier, heavy
from vbraille.sessions.record import export
from vbraille.sessions.record.folder import check, load
from vbraille.sessions.record.replay import frames

STRINGS = """
format = 1
name = "strings"
title = "Two strings of three"
source = "ours"
model = "stress2"
[display]
mapping = "sheared"
[design]
kind = "list"
strings = ["cab", "xyz"]
[[conditions]]
name = "plain"
texture = 0.5
[trial]
gap_s = 0.1
"""


@pytest.fixture
def mini(tmp_path):
    path = tmp_path / "mini.toml"
    path.write_text(MINI.replace('["a", "c", "4", "0"]', '["a", "0"]') + "[trial]\ngap_s = 0.1\n")
    return path


def session(protocol, folder, *options):
    who = ("--participant", "P1", "--seed", "3")
    return ("session", "run", protocol, *who, "--out", folder, *options)


def until(process, said):
    """Read what a process says up to a line that begins so."""
    while not (line := process.stdout.readline()).startswith(said):
        assert line, process.communicate()


def rows(folder):
    return export.rows(load(folder))


def whole(folder):
    return all(finding.good for finding in check(load(folder)))


def events(folder, name):
    lines = (folder / "journal.jsonl").read_text().splitlines()
    return [event for event in map(json.loads, lines) if event["event"] == name]


def longest_gap_ms(folder):
    """Longest time between two ticks of a showing, in ms."""
    made = [ticks["time_ns"] for line, ticks, _ in frames(load(folder)) if line]
    return max(np.diff(times).max() for times in made) / 1e6


@heavy  # what an engine did is made again without a process; here it goes by in real time
def test_every_frame_that_was_sent_is_made_again_bit_for_bit(tmp_path):
    protocol, answers, log = (tmp_path / name for name in ("p.toml", "answers", "log"))
    protocol.write_text(STRINGS.replace("texture = 0.5", "contrast = 0.9"))
    # With a repeat, a pause and another texture in the middle of a trial.
    answers.write_text("repeat\ntexture 0.3\npause\ngo\ncab\nxyz\n")
    done = program.run(
        *session(protocol, tmp_path / "s", "--answers", answers, "--device", f"logged:{log},"),
        env=drivers.install(tmp_path),
    )
    assert done.returncode == 0, done.stderr
    sent = np.fromfile(log).reshape(-1, 6, 10)
    made = list(frames(load(tmp_path / "s")))
    assert [line for line, _, _ in made] == [0, 1, 2, 3, 4]
    assert len({ticks["flags"][n] & 1 for _, ticks, _ in made for n in range(len(ticks))}) == 2
    again = np.concatenate([deflections for _, _, deflections in made])
    ticks = np.concatenate([ticks for _, ticks, _ in made])
    assert (ticks["tick"] == np.arange(ticks.size)).all()
    # Before the first tick the driver was rehearsed at rest; after the last the array faded.
    before = next(n for n in range(1000) if (sent[n : n + ticks.size] == again).all())
    assert not sent[:before].any()
    assert not sent[-1].any()
    assert again.max() > 0.85
    assert ((ticks["share"] > 0) & (ticks["share"] < 1)).sum() > 20


@heavy  # of a reading it is tested in test_rest.py
def test_a_driver_that_cannot_let_go_is_named_and_the_session_is_whole(tmp_path):
    protocol, answers, log = (tmp_path / name for name in ("p.toml", "answers", "log"))
    protocol.write_text(STRINGS)
    answers.write_text("cab\nxyz\n")
    done = program.run(
        *session(
            protocol, tmp_path / "s", "--answers", answers, "--device", f"logged:{log},jammed"
        ),
        env=drivers.install(tmp_path),
    )
    assert done.returncode == 1
    assert "the driver logged" in done.stderr
    assert "the lock is jammed" in done.stderr
    assert whole(tmp_path / "s")
    assert len(events(tmp_path / "s", "closed")) == 1
    assert [row["answered"] for row in rows(tmp_path / "s")] == ["⠉⠁⠃", "⠭⠽⠵"]


def test_a_carriage_too_short_for_the_strings_is_said_before_anything_is_begun(tmp_path, mini):
    with simulated(tmp_path, "--model", "vbd", "--travel", "20") as (spec, _):
        done = program.run(
            *session(mini, tmp_path / "s", "--device", spec, "--answers", "simulated")
        )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        "vbraille: the carriage of simulated VBD goes 20 mm and the longest string of mini needs "
        "45.1 mm; choose another --device or shorter strings\n"
    )
    assert not (tmp_path / "s").exists()


@heavy  # silence in a trial is tested on a clock of its own, an unplugged device in a reading
def test_a_trial_in_which_the_device_was_unplugged_is_marked_and_repeated(tmp_path, mini):
    options = ("--model", "vbd", "--hand", "sweep:100", "--travel", "60")
    with simulated(tmp_path, *options) as (spec, device):
        arguments = session(mini, tmp_path / "s", "--device", spec, "--answers", "simulated")
        process = program.start(*arguments, text=True)
        until(process, "cue: trial 1")
        device.terminate()
        until(process, "fault: the device is silent; trial 1 of 2 is repeated")
    with simulated(tmp_path, *options):
        said, complaints = process.communicate(timeout=program.PATIENCE_S)
    assert process.returncode == 0, complaints
    assert "device: back" in said
    table = rows(tmp_path / "s")
    assert [row["correct"] for row in table] == [1, 1]
    # A busy machine may be silent once more, in any trial.
    assert table[0]["attempt"] >= 2
    assert table[0]["faults"].startswith("the device is silent")
    run = events(tmp_path / "s", "run")[0]
    assert (run["device"]["levels"], run["spec"]) == (1024, spec)
    assert whole(tmp_path / "s")


@heavy  # each kind of rest is tested on a clock of its own, with and without repeats
@pytest.mark.parametrize("repeats", [True, False])
def test_a_trial_in_which_the_array_rested_is_marked(tmp_path, mini, repeats):
    mini.write_text(mini.read_text() + f"[faults]\nrepeat = {str(repeats).lower()}\n")
    # It takes no frames and says nothing for 80 ms of each second: too short to be silence.
    options = ("--model", "vbd", "--hand", "sweep:30", "--travel", "60", "--stall", "80ms")
    with simulated(tmp_path, *options) as (spec, _):
        arguments = session(mini, tmp_path / "s", "--device", spec, "--answers", "simulated")
        process = program.start(*arguments, text=True)
        until(process, "cue: trial 1")
        how = "is repeated" if repeats else "goes on"
        until(process, f"fault: the array went to rest by itself; trial 1 of 2 {how}")
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=program.PATIENCE_S)
    faults = events(tmp_path / "s", "fault")
    assert {fault["what"] for fault in faults} == {"the array went to rest by itself"}
    assert whole(tmp_path / "s")


def test_a_host_that_dies_is_started_again_and_its_trial_repeated(tmp_path, mini):
    arguments = session(mini, tmp_path / "s", "--answers", "simulated", "--hand", "sweep:100")
    process = program.start(*arguments, text=True)
    until(process, "cue: trial 2")
    os.kill(forking.children(process.pid)[0], signal.SIGKILL)
    said, complaints = process.communicate(timeout=program.PATIENCE_S)
    assert process.returncode == 0, complaints
    assert "killed by signal 9); it is started again" in said
    table = rows(tmp_path / "s")
    assert [row["correct"] for row in table] == [1, 1]
    assert [row["attempt"] for row in table] == [1, 2]
    assert [row["trace"] for row in table] == ["trace-001.gz", "trace-002.gz"]
    assert whole(tmp_path / "s")


@pytest.mark.real_time
def test_fast_and_in_real_time_the_answers_are_the_same(tmp_path, mini):
    if by_tier(False, True, True):
        mini.write_text(mini.read_text().replace('["a", "0"]', '["a", "c", "4", "0"]'))
    options = ("--answers", "simulated:0.3", "--hand", "sweep:160")

    def sit(name, *more):
        done = program.run(*session(mini, tmp_path / name, *options, *more))
        assert done.returncode == 0, done.stderr

    sit("fast", "--fast")
    for _ in range(5):
        sit("real")
        if longest_gap_ms(tmp_path / "real") < 10:
            break
        shutil.rmtree(tmp_path / "real")  # where no tick was, nothing was felt
    else:
        pytest.skip("the machine was too busy for a run in real time")
    same = ("trial", "condition", "presented", "answered", "correct", "attempt")
    tables = [
        [[row[name] for name in same] for row in rows(tmp_path / n)] for n in ("real", "fast")
    ]
    assert tables[0] == tables[1]
    assert len({str(row) for row in tables[0]}) == by_tier(2, 4, 4)
    plans = [(tmp_path / name / "plan.json").read_bytes() for name in ("real", "fast")]
    assert plans[0] == plans[1]
    assert [run["clock"] for n in ("real", "fast") for run in events(tmp_path / n, "run")] == [
        "machine", "manual",
    ]  # fmt: skip


def test_an_experimenter_at_a_terminal(tmp_path, mini):
    mini.write_text(mini.read_text() + '[[fields]]\nname = "hand"\nask = "Reading hand"\n')
    arguments = session(mini, tmp_path / "s", "--hand", "sweep:200", "--cues", "bell")
    with Terminal(*arguments) as terminal:
        terminal.until("Reading hand:")
        terminal.type("left\n")
        terminal.until("cue: trial 1 of 2")
        terminal.until("read: type the answer")
        terminal.type("c\n")
        terminal.until("answer: trial 1 of 2, c")
        terminal.until("cue: trial 2")
        second = program.run("session", "resume", tmp_path / "s")
        terminal.type("pause\n")
        terminal.until("pause: the array is at rest")
        terminal.type("stop\n")
        assert terminal.end() == 0
    assert second.returncode == 2
    assert "open in another console" in second.stderr
    assert terminal.bells
    assert json.loads((tmp_path / "s" / "session.json").read_text())["fields"] == {"hand": "left"}
    assert re.search(r"stopped: 1 of 2 trials have answers", terminal.printed)
    # What an escape of a terminal would do to a screen reader is not sent.
    assert "\x1b" not in terminal.printed


def test_a_signal_rests_the_array_and_the_session_goes_on_later(tmp_path, mini):
    log = tmp_path / "log"
    arguments = session(
        mini, tmp_path / "s", "--answers", "simulated", "--device", f"logged:{log},"
    )
    process = program.start(*arguments, text=True, env=drivers.install(tmp_path))
    until(process, "cue: trial 2")
    process.send_signal(signal.SIGTERM)
    complaints = process.communicate(timeout=program.PATIENCE_S)[1]
    assert (process.returncode, complaints) == (1, "vbraille: stopped\n")
    assert not np.fromfile(log).reshape(-1, 1, 12)[-1].any()
    if TIER is Tier.TEST:  # that a stopped session goes on is tested without a process, too
        return
    done = program.run(
        "session", "resume", tmp_path / "s", "--device", "sim", "--hand", "sweep:100"
    )
    assert done.returncode == 0, done.stderr
    table = rows(tmp_path / "s")
    assert [row["correct"] for row in table] == [1, 1]
    assert table[1]["attempt"] == 2
