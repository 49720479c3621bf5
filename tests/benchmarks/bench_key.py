"""The way of a key: calls, modules and classes from "n" to the FRAME, and what a reading loads.

A reading is profiled in its process, at a terminal of its own: from the key's name, as the
keyboard has it, to the program in the engine's mailbox; and a loop in this process, from the
mailbox to the device's write. What is on the way is what hands the line on: every function
that is not left before the program, or the FRAME, is sent, and those that make its parts. Only
our own functions count, each once; of one that is asked again and again, such as a property of a
value, only the first.
"""

from __future__ import annotations

import json
import os
import pty
import select
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tests.benchmarks.timing import Result

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parents[2]
TEXT = ROOT / "texts" / "english.txt"
CALLS, MODULES, CLASSES, LOADED = 22, 14, 12, 90
_WAIT_S = 30.0


def profile(report: int) -> None:
    """Read a text as `vbraille read` does; after the key "n" write what was called, and quit."""
    from vbraille.cli.main import main
    from vbraille.engine.mailbox import Mailbox
    from vbraille.reading.keyboard import Keyboard

    pressed, post = Keyboard.pressed, Mailbox.post
    calls: list[tuple[str, str, int]] = []
    loaded: list[int] = []
    depth = 0

    def note(frame: Any, event: str, _: object) -> None:
        nonlocal depth
        module = frame.f_globals.get("__name__", "")
        if module.startswith("vbraille.") and event in ("call", "return"):
            depth += 1 if event == "call" else -1
            if event == "call":
                calls.append((module, frame.f_code.co_qualname, depth))

    def press(self: Keyboard, wait_s: float = 0.0) -> list[str]:
        keys = pressed(self, wait_s)
        if keys and not loaded:
            loaded.append(sum(name.startswith("vbraille") for name in sys.modules))
            sys.setprofile(note)
        return keys

    def send(self: Mailbox, *given: Any) -> None:
        post(self, *given)
        if sys.getprofile() is not None:
            sys.setprofile(None)
            told = {"loaded": loaded[0], "calls": calls}
            os.write(report, json.dumps(told).encode() + b"\n")

    Keyboard.pressed, Mailbox.post = press, send
    main(["read", str(TEXT), "--device", "sim", "--hand", "sweep:60", "--no-places"])


def measured() -> dict[str, Any]:
    """What the profiled reading tells."""
    reads, writes = os.pipe()
    keys, terminal = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "tests.benchmarks.bench_key", str(writes)],
        stdin=terminal, stdout=terminal, stderr=terminal, pass_fds=[writes], cwd=ROOT,
        start_new_session=True,
    )  # fmt: skip
    try:
        os.close(writes)
        os.close(terminal)
        said, until_s = b"", time.monotonic() + _WAIT_S
        while b"says the keys" not in said and time.monotonic() < until_s:
            said += os.read(keys, 4096) if select.select([keys], [], [], 1.0)[0] else b""
        time.sleep(0.5)
        os.write(keys, b"n")
        told = b""
        while not told.endswith(b"\n"):
            more = os.read(reads, 65_536)
            if not more:
                raise RuntimeError(f"the reading has ended: {said!r}")
            told += more
        return json.loads(told)
    finally:
        process.kill()
        process.wait()
        os.close(keys)
        os.close(reads)


def run() -> Iterator[Result]:
    told = measured()
    print(json.dumps(told)[:200])
    yield Result("x", "", "", met=True)


if __name__ == "__main__":
    profile(int(sys.argv[1]))
