"""Ctrl-C and its kin: at any moment of the program's, and what a parent has it ignore."""

import signal
import subprocess
import sys

import pytest

from tests.cli import program
from tests.tiers import TIER, Tier, by_tier

# Sends the process SIGINT at the nth event of the interpreter (a call or a return) after `main`
# was called: a Ctrl-C at a moment that is the same in every run.
AT_AN_EVENT = """
import signal, sys
from vbraille.cli.app import main

moment, events = int(sys.argv[1]), 0

def count(frame, event, argument):
    global events
    events += 1
    if events == moment:
        signal.raise_signal(signal.SIGINT)

sys.setprofile(count)
code = main(sys.argv[2:])
sys.setprofile(None)
raise SystemExit(code)
"""


def stopped_at(moment, *arguments):
    done = subprocess.run(
        [sys.executable, "-c", AT_AN_EVENT, str(moment), *map(str, arguments)],
        stdin=subprocess.DEVNULL, capture_output=True, encoding="utf-8", check=False,
        timeout=program.PATIENCE_S,
    )  # fmt: skip
    said = done.stderr.splitlines()
    assert done.returncode in (0, 1), f"moment {moment}: {done.returncode}, {done.stderr}"
    if said[:1] == [program.line_width(26)[:-1]]:
        del said[0]
    wanted = ["vbraille: stopped"] if done.returncode else []
    assert said == wanted, f"moment {moment}: {done.stderr}"
    return done


# Some of them are in imports, in liblouis, in what is printed; 400,000 is about the run's end.
PAGE = [2, 5, 11, 30, 3_000, 30_000, *range(60_000, 420_000, 30_000)][:: by_tier(3, 1, 1)]


def test_ctrl_c_while_a_page_is_printed(text, rng):
    codes = []
    for moment in PAGE:
        moment += int(rng.integers(max(moment // 10, 1)))
        done = stopped_at(moment, "page", text)
        codes.append(done.returncode)
        assert done.stdout in ("", "⠀⠀⠐⠕⠀⠞⠺⠕⠀⠹⠗⠑⠑\n") or done.stdout.count("\n") in (2, 3)
        assert done.stdout[-1:] in ("", "\n")
    assert codes.count(1) > len(codes) / 2


# numba is imported up to event 800,000, loads its kernels up to 1,500,000, then HDF5 writes.
RENDER = [700_000, 1_400_000, 1_550_000]
if TIER > Tier.TEST:
    RENDER += [200_000, 800_000, 1_000_000, 1_200_000, 1_500_000]


def test_ctrl_c_while_a_file_is_written(tmp_path, text, rng):
    out = tmp_path / "out.h5"
    codes = []
    for moment in RENDER:
        moment += int(rng.integers(100_000))
        done = stopped_at(moment, "render", text, "--out", out, "--hand=sweep:70", "--rate=200")
        codes.append(done.returncode)
        assert (done.stdout != "") == (done.returncode == 0)
        assert out.exists() == (done.returncode == 0)
        assert not list(tmp_path.glob(".*"))
        out.unlink(missing_ok=True)
    assert codes.count(1) > len(codes) / 2


@pytest.mark.new_processes
def test_signals_while_reading(text):
    # One handler takes all signals.
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)[: by_tier(2, 3, 3)]:
        with program.start("read", text, "--hand", "sweep:20") as process:
            assert process.stdout.readline() == b"line: 1\n"
            assert process.stderr.readline() == program.line_width(26).encode()
            process.send_signal(number)
            assert process.stderr.read() == b"vbraille: stopped\n"
            assert process.wait(program.PATIENCE_S) == 1
            assert b"summary" not in process.stdout.read()


@pytest.mark.parametrize("ignored", ["HUP", "INT"])
def test_what_the_parent_ignores_is_ignored(text, ignored):
    """As nohup does with SIGHUP, and a shell with SIGINT in its background."""
    arguments = ["read", text, "--hand", "sweep:500", "--lines", "1"]
    shell = ["sh", "-c", f'trap "" {ignored}; exec "$@"', "sh", *program.PROGRAM, *arguments]
    with subprocess.Popen(shell, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE) as process:
        assert process.stdout.readline() == b"line: 1\n"
        process.send_signal(signal.Signals[f"SIG{ignored}"])
        assert b"\nsummary: lines 1," in process.stdout.read()
        assert process.wait(program.PATIENCE_S) == 0
