"""Whatever ends a reading, the actuators fade to rest: seen by a device in a real process."""

import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests import drivers
from tests.tiers import heavy


@pytest.fixture
def driver(tmp_path) -> dict[str, str]:
    """Environment of a process that knows the device kind ``logged``."""
    return drivers.install(tmp_path)


def read(driver, texts: Path, log: Path, fault: str, *options: str):
    done = subprocess.run(
        [sys.executable, "-m", "vbraille", "read", str(texts / "english.txt"), "--lines", "1",
         "--device", f"logged:{log},{fault}", "--mapping", "sheared", "--texture", "0",
         "--travel", "80", *options],
        env=driver, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
        timeout=60,
    )  # fmt: skip
    frames = np.fromfile(log).reshape(-1, 6, 10)
    return done, frames


@pytest.mark.parametrize(
    ("fault", "code", "said"),
    [
        ("", 0, []),
        pytest.param(str(int(signal.SIGINT)), 1, ["vbraille: stopped"], marks=heavy),
        (str(int(signal.SIGTERM)), 1, ["vbraille: stopped"]),
        pytest.param(str(int(signal.SIGHUP)), 1, ["vbraille: stopped"], marks=heavy),
    ],
)
def test_an_end_and_a_signal(driver, texts, tmp_path, fault, code, said):
    done, frames = read(driver, texts, tmp_path / "log", fault)
    assert done.returncode == code
    line_width, *others = done.stderr.splitlines()
    assert line_width.startswith("line width: ")
    assert others == said
    assert done.stdout.startswith("line: 1\n")
    assert ("summary" in done.stdout) == (code == 0)
    fades(frames)


def fades(frames: np.ndarray) -> None:
    """Inverted rows come down from 1 within 100 ms, in as many steps as the machine could make."""
    assert frames.max() == 1.0
    assert not frames[-1].any()
    row = frames[:, 0].max(axis=1)  # off the dots it stands at full swing
    down = row[np.flatnonzero(row == 1.0)[-1] :]
    assert (np.diff(down) <= 0).all()
    assert ((down > 0.02) & (down < 0.98)).any()


def test_a_bug_in_the_loop_still_rests(driver, texts, tmp_path):
    done, frames = read(driver, texts, tmp_path / "log", "bug")
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 2  # the line's width, and the fault
    assert "ZeroDivisionError" in done.stderr
    assert "Traceback" not in done.stderr
    fades(frames)


def test_a_driver_that_cannot_let_go_is_named_once_the_actuators_rest(driver, texts, tmp_path):
    done, frames = read(driver, texts, tmp_path / "log", "jammed")
    assert done.returncode == 1
    _, sentence = done.stderr.splitlines()
    assert "the driver logged" in sentence
    assert "the lock is jammed" in sentence
    fades(frames)


def test_a_device_that_is_gone_is_said_in_one_sentence(driver, texts, tmp_path):
    done, frames = read(driver, texts, tmp_path / "log", "gone")
    assert done.returncode == 1
    assert done.stderr.splitlines()[1:] == ["vbraille: the device is gone"]
    assert len(frames) == 300
