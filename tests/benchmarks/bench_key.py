"""The way of a key: calls, modules and classes from "n" to the FRAME, and what a reading loads.

A reading is profiled in its process, at a terminal of its own. On the way of the key "n" are the
functions of ours that are on the stack when the key is read, when the line is laid out, when it is
compiled, and when the program is in the engine's mailbox; and, with a loop in this process, those
on the stack when the FRAME is written. Each counts once, with its module and its class.
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
_MILESTONES = {"Keys.feed", "Layout.line", "BrailleStyle.render", "Mailbox.post"}
_WRITTEN = "Device.write"


def way(frame: Any) -> Iterator[tuple[str, str]]:
    """Our functions on the stack, by module and name, without those that run all the time."""
    while frame is not None and frame.f_code.co_name not in ("main", "write_frame"):
        module = frame.f_globals.get("__name__", "")
        loops = frame.f_code.co_name == "run" or module == "vbraille.cli.app"
        if module.startswith("vbraille.") and not loops:
            yield module, frame.f_code.co_qualname.replace(".<locals>", "")
        frame = frame.f_back


def profile(report: int) -> None:
    """Read a text as `vbraille read` does; after the key "n" write what was on its way."""
    from vbraille.cli.app import main
    from vbraille.engine.mailbox import Mailbox
    from vbraille.reading.keyboard import Keyboard

    pressed, post = Keyboard.pressed, Mailbox.post
    passed: dict[tuple[str, str], None] = {}
    loaded: list[int] = []

    def note(frame: Any, event: str, _: object) -> None:
        if event == "call" and frame.f_code.co_qualname in _MILESTONES:
            passed.update(dict.fromkeys(way(frame)))

    def press(self: Keyboard, wait_s: float = 0.0) -> list[str]:
        sys.setprofile(note)
        keys = pressed(self, wait_s)
        if keys:
            loaded.append(sum(name.startswith("vbraille") for name in sys.modules))
            passed.setdefault(("vbraille.reading.keyboard", "Keyboard.pressed"))
        else:
            sys.setprofile(None)
            passed.clear()
        return keys

    def send(self: Mailbox, *given: Any) -> None:
        post(self, *given)
        if loaded and sys.getprofile() is not None:
            sys.setprofile(None)
            told = {"loaded": loaded[0], "way": list(passed)}
            os.write(report, json.dumps(told).encode() + b"\n")

    Keyboard.pressed, Mailbox.post = press, send
    main(["read", str(TEXT), "--device", "sim", "--hand", "sweep:60", "--no-places"])


def read_once() -> dict[str, Any]:
    """Counts that the profiled reading gives."""
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


def write_frame() -> list[tuple[str, str]]:
    """Our functions on the stack when a loop writes a FRAME."""
    import vbraille
    from vbraille.testing import ManualClock, simulated_device

    clock, passed = ManualClock(), {}

    def note(frame: Any, event: str, _: object) -> None:
        if event == "call" and frame.f_code.co_qualname == _WRITTEN:
            passed.update(dict.fromkeys(way(frame)))

    device = simulated_device(vbraille.STRESS2, hand="sweep:150", clock=clock)
    with vbraille.open(device, clock=clock) as opened:
        opened.show("A line of braille")
        sys.setprofile(note)
        opened.engine.poll()
        sys.setprofile(None)
    return list(passed)


def measured() -> tuple[list[tuple[str, str]], int]:
    """Module and name of each function on the way, and the number of modules of ours loaded."""
    told = read_once()
    found = dict.fromkeys((*map(tuple, told["way"]), *write_frame()))
    return list(found), told["loaded"]


def run() -> Iterator[Result]:
    passed, loaded = measured()
    modules = {module for module, _ in passed}
    classes = {(module, name.split(".")[0]) for module, name in passed if "." in name}
    counts = len(passed), len(modules), len(classes)
    yield Result(
        'calls, modules and classes from the key "n" to the FRAME',
        f"≤ {CALLS}, ≤ {MODULES}, ≤ {CLASSES}",
        ", ".join(map(str, counts)),
        met=counts[0] <= CALLS and counts[1] <= MODULES and counts[2] <= CLASSES,
    )
    yield Result(
        "modules of ours loaded by `vbraille read` before the first key",
        f"≤ {LOADED}",
        str(loaded),
        met=loaded <= LOADED,
    )


if __name__ == "__main__":
    profile(int(sys.argv[1]))
