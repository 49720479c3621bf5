"""Make the sessions of this folder with the program as it is; see README.md.

Run from the root of the project, in its virtual environment: python THIS_FILE FOLDER
"""

import os
import re
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from hashlib import sha256
from pathlib import Path

PROGRAM = [sys.executable, "-m", "vbraille"]
RATE = ("--rate", "100")
# Each protocol, shortened: what is replaced in its file.
SHORTER = {
    "legibility": [("length = 2", "length = 1"), ("repeats = 5", "repeats = 1"),
                   ("trials = 8", "trials = 2"),
                   (r'strings = \["l".*?\]', 'strings = ["lc", "rn"]'),
                   ("gap_s = 0.5", "gap_s = 0.0")],
    "control": [("length = 2", "length = 1"), ("repeats = 5", "repeats = 2"),
                ("gap_s = 0.5", "gap_s = 0.0")],
    "letters": [(r'strings = \[.*?\n\]', 'strings = ["ab", "cd"]'), ("each_letter = 5\n", ""),
                (r'\n# Each letter of the alphabet exactly.*?\n', "\n"),
                ("trials = 6", "trials = 1"), (r'strings = \["bfqxe".*?\]', 'strings = ["ef"]'),
                ("warning_s = 30", "warning_s = 1"),
                ("gap_s = 0.5", "gap_s = 0.0")],
    "words": [(r'strings = \[.*?\n\]', 'strings = ["le", "en", "tu", "va"]'),
              ("each_letter_at_least = 4\n", ""), ("gap_s = 0.5", "gap_s = 0.0")],
    "tuning-width": [(r"values = \[.*?\]", "values = [0.5, 2.0]"),
                     ("repeats = 3", "repeats = 2"), ("gap_s = 0.5", "gap_s = 0.0")],
    "tuning-spacing": [(r"values = \[.*?\]", "values = [1.0, 2.5]"),
                       ("repeats = 3", "repeats = 2"), ("gap_s = 0.5", "gap_s = 0.0")],
}  # fmt: skip


def vbraille(*words, code=0):
    """Run the program to its end."""
    done = subprocess.run(
        [*PROGRAM, *words], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False
    )
    print("vbraille", *words)
    assert done.returncode == code, (words, done)
    return done.stdout


@contextmanager
def started(*words, **options):
    """Start the program, to be spoken with a line at a time."""
    print("vbraille", *words, "  (a line at a time)")
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True, **options}
    with subprocess.Popen([*PROGRAM, *words], **pipes) as process:
        try:
            yield process
        finally:
            process.kill()


def until(process, pattern):
    """Read lines to the first that matches."""
    while not re.search(pattern, line := process.stdout.readline()):
        assert line, f"{pattern} was never said"


def type_line(process, line):
    """Type a line."""
    process.stdin.write(f"{line}\n")
    process.stdin.flush()


def run(name, protocol, *words):
    """Words of a session's run."""
    return ("session", "run", f"{protocol}.toml", "--participant", "P07", "--seed", "42",
            "--out", f"sessions/{name}", *RATE, *words)  # fmt: skip


def protocols():
    """Copy each protocol, and shorten it."""
    for name, changes in SHORTER.items():
        text = vbraille("session", "protocols", name)
        for what, by in changes:
            text, count = re.subn(what, by, text, flags=re.DOTALL)
            assert count, (name, what)
        Path(f"{name}.toml").write_text(text)
        who = ("--participant", "P07", "--seed", "42")
        Path(f"plans/{name}.txt").write_text(vbraille("session", "plan", f"{name}.toml", *who))
    brf = vbraille("session", "plan", "control.toml", *who, "--brf")
    Path("plans/control.brf").write_text(brf)


def killed(name, protocol, said, *words):
    """Kill a session with SIGKILL as soon as it has said something."""
    with started(*run(name, protocol, *words)) as process:
        until(process, said)
        process.send_signal(signal.SIGKILL)
        process.wait()
    time.sleep(0.5)  # its host ends by itself


def sessions():
    """Run all six protocols, to their ends and otherwise."""
    fast = ("--fast", "--hand", "sweep:200", "--answers", "simulated:0.2")
    vbraille(*run("legibility-ended", "legibility", *fast))
    vbraille(*run("tuning-width-ended", "tuning-width", *fast))

    # A file of answers, with an answer taken back, a note in a trial and one after the last.
    Path("control-answers.txt").write_text(
        "l\nnote the tape was loose\nundo\nr\nc\n?\nn\nl\nr\nc\nnote all is done\n?\nundo\nl\n"
    )
    answers = ("--answers", "control-answers.txt")
    vbraille(*run("control-ended", "control", *answers))

    killed("tuning-spacing-killed", "tuning-spacing", "^answer: trial 1", *fast)

    # An experimenter who types: practice, notes before, in and between trials, a pause with Enter,
    # a trial repeated, an answer undone; ended with stop.
    real = ("--hand", "sweep:70", "--sound", "none")
    fields = ("--field", "finger=index", "--field", "hand=left", "--field", "masking_noise=no")
    with started(*run("letters-stopped", "letters", *real, *fields)) as process:
        for said, line in (
            ("^ready: practice 1", "note the room is cold"),
            ("^read:", "ab"),
            ("^cue: trial 1", "note a car passed"),
            ("^note:", "pause"),
            ("^pause:", ""),
            ("^read:", "c d"),
            ("^cue: trial 2", "repeat"),
            ("^read:", "ab"),
            ("^answer: trial 2", "undo"),
            ("^undo:", "note the finger slipped"),
            ("^note:", "1-4 ?"),
            ("^read:", "ab"),
            ("^break:", "note in the break"),
            ("^note:", ""),
            ("^cue: trial 4", "stop"),
        ):
            until(process, said)
            type_line(process, line)
        assert process.wait() == 0

    # Contrast set by the experimenter; the host killed in trial 2.
    with started(*run("words-host-died", "words", *real, *fields)) as process:
        until(process, "^cue: trial 1")
        time.sleep(0.5)  # so that some ticks have the first tuning
        type_line(process, "contrast 0.7")
        until(process, "^read:")
        type_line(process, "le")
        until(process, "^cue: trial 2")
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        os.kill(int(children[0]), signal.SIGKILL)
        until(process, "it is started again")
        for answer in ("en", "?u", "va"):
            until(process, "^read:")
            type_line(process, answer)
        until(process, "^last:")
        type_line(process, "note the last one is done")
        until(process, "^note:")
        type_line(process, "")
        until(process, "^end:")
        assert process.wait() == 0

    # A device on a line, unplugged in trial 1 and plugged in again.
    device = ("simulate", "--model", "vbd", "--hand", "sweep:150", "--travel", "60",
              "--rate", "100", "--link", "vb0")  # fmt: skip
    with started(*device) as simulated:
        until(simulated, "")
        wait_for("vb0")
        words = run("legibility-unplugged", "legibility", "--answers", "simulated",
                    "--device", "serial:./vb0")  # fmt: skip
        with started(*words) as process:
            until(process, "^cue: trial 1")
            simulated.terminate()
            simulated.wait()
            until(process, "is repeated")
            with started(*device) as simulated_again:
                until(process, "^end:")
                assert process.wait() == 0
                simulated_again.terminate()
                simulated_again.wait()

    # A killed one whose last line a crash cut short, and one that was gone on with since.
    for name in ("letters-torn", "letters-resumed"):
        killed(name, "letters", "^answer: trial 2", "--fast", "--hand", "sweep:200",
               "--answers", "simulated")  # fmt: skip
        journal = Path(f"sessions/{name}/journal.jsonl")
        lines = journal.read_bytes().splitlines(keepends=True)
        at = [n for n, line in enumerate(lines) if b'"event":"answer"' in line][1]
        journal.write_bytes(b"".join(lines[:at]) + lines[at][:60])
    vbraille("session", "resume", "sessions/letters-resumed")


def golden():
    """What this program makes of the sessions: for tests to compare a later one's with."""
    from vbraille.sessions.record.folder import load
    from vbraille.sessions.record.replay import frames

    sums = []
    for folder in sorted(Path("sessions").iterdir()):
        Path(f"golden/{folder.name}.check.txt").write_text(
            vbraille("session", "check", str(folder))
        )
        Path(f"golden/{folder.name}.csv").write_text(vbraille("session", "export", str(folder)))
        replayed = sha256()
        for _, _, deflections in frames(load(folder)):
            replayed.update(deflections.tobytes())
        sums.append(f"{replayed.hexdigest()}  {folder.name}\n")
    Path("golden/frames.sha256").write_text("".join(sums))


def wait_for(path):
    """Wait for a link."""
    while not os.path.lexists(path):
        time.sleep(0.05)


def main():
    """Make all of it in an empty folder."""
    os.environ["PYTHONPATH"] = str(Path.cwd())
    folder = Path(sys.argv[1])
    folder.mkdir()
    os.chdir(folder)
    Path("plans").mkdir()
    Path("golden").mkdir()
    protocols()
    sessions()
    golden()


if __name__ == "__main__":
    main()
