"""Runs of the program that are killed when they have said so much, and what they said."""

from __future__ import annotations

import re
import select
import subprocess
import time
from dataclasses import dataclass
from typing import IO

from tests.benchmarks.timing import vbraille

_PATIENCE_S = 60.0
_CELLS = {"l": "⠁", "c": "⠉", "r": "⠈", "n": "⠀"}


@dataclass(frozen=True, slots=True)
class Ended:
    """What a run of the program said until it ended; exit code None: it was killed."""

    lines: list[str]
    code: int | None
    stderr: str
    first_line_s: float = 0.0


def run_program(command: list[str], lines: int | None = None, pause_s: float = 0.0) -> Ended:
    """Run the program; kill it a while after it has said so many lines, if a number is given."""
    said: list[bytes] = []
    begun_s = time.monotonic()
    with subprocess.Popen(
        vbraille(*command),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        bufsize=0,  # a line at a time, and nothing of the rest is kept from communicate
    ) as process:
        assert process.stdout is not None
        if lines != 0:
            said.append(_read(process.stdout))
        first_line_s = time.monotonic() - begun_s
        if lines is None:
            rest, stderr = process.communicate(timeout=_PATIENCE_S)
        else:
            while len(said) < lines and said[-1]:
                said.append(_read(process.stdout))
            time.sleep(pause_s)
            process.kill()
            rest, stderr = process.communicate(timeout=_PATIENCE_S)
    text = (b"".join(said) + rest).decode()
    # A line without an end was not read by anybody.
    whole = text.split("\n")[:-1]
    return Ended(
        whole,
        process.returncode if process.returncode >= 0 else None,
        stderr.decode(),
        first_line_s,
    )


def _read(stdout: IO[bytes]) -> bytes:
    """Read a line, or what there is of it at the end."""
    assert select.select([stdout], [], [], _PATIENCE_S)[0]
    return stdout.readline()


def parse(line: str) -> tuple[str, int]:
    """Kind of a line and its trial, 0 if it has none."""
    found = re.match(r"(\w+): trial (\d+)", line)
    return ("", 0) if found is None else (found[1], int(found[2]))


def acknowledged(lines: list[str]) -> list[tuple[int, str]]:
    """Trials and answers that the program said are in."""
    found = (re.fullmatch(r"answer: trial (\d+)(?: of \d+)?, (.+)", line) for line in lines)
    return [(int(f[1]), "".join(_CELLS[name] for name in f[2].split())) for f in found if f]
