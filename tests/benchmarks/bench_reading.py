"""Reading: command to first line, key to sentence and to frame, search in 5 MB, kills."""

from __future__ import annotations

import os
import resource
import select
import signal
import sqlite3
import statistics
import subprocess
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

from tests.benchmarks.timing import Result
from tests.reading.terminal import PROGRAM, Terminal

if TYPE_CHECKING:
    from collections.abc import Iterator

TEXT = "texts/english.txt"
KILLS = 200
LAST = "the very last word"


def run() -> Iterator[Result]:
    """Measure one after the other."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ["VBRAILLE_PLACES"] = f"{folder}/places.sqlite"
        os.environ["VBRAILLE_SETTINGS"] = f"{folder}/settings.toml"
        Path(f"{folder}/settings.toml").touch()
        yield _help()
        yield _first_line()
        yield _sentence()
        yield _frame()
        yield from _search()
        yield _kills(Path(folder))


def _help() -> Result:
    spent = []
    for _ in range(5):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([PROGRAM, "read", "--help"], check=True, stdout=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    got = statistics.median(spent)
    return Result("read --help, processor", "≤ 0.2 s", f"{got:.2f} s", got <= 0.2)


def _first_line() -> Result:
    times = []
    for _ in range(5):
        begun = time.monotonic()
        with subprocess.Popen(
            [PROGRAM, "read", TEXT, "--no-places"],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        ) as process:
            assert process.stdout is not None
            process.stdout.readline()
            times.append(time.monotonic() - begun)
            process.terminate()
    got = statistics.median(times)
    return Result("from the command to the first line", "≤ 0.9 s", f"{got:.2f} s", got <= 0.9)


def _sentence() -> Result:
    times = []
    with Terminal("read", TEXT, "--no-places", "--hand", "slow", "--cues", "none") as terminal:
        for key in "npewuibBtTcC" * 5:
            terminal.listen(0.05)
            begun = time.monotonic()
            os.write(terminal.fd, key.encode())
            select.select([terminal.fd], [], [], 5)
            times.append(1e3 * (time.monotonic() - begun))
    got = statistics.quantiles(times, n=20)[-1]
    return Result("from a key to its sentence, 95 of 100", "≤ 30 ms", f"{got:.0f} ms", got <= 30)


def _frame() -> Result:
    from tests.reading.bench import Heard, NoKeyboard
    from vbraille.engine.record import Flag
    from vbraille.reading.device import ReadingDevice
    from vbraille.reading.exploration import Exploration
    from vbraille.reading.places import Places
    from vbraille.reading.reader import Reader
    from vbraille.render import STRESS2
    from vbraille.translate import Book, BrailleTable, open_source

    times = []
    with ReadingDevice("sim", STRESS2.display, hand="slow") as device:
        device.start(STRESS2)
        book = Book(open_source(TEXT), BrailleTable("en-ueb-g1.ctb"))
        kept = Places(None, print).book("", Path(), "")
        reader = Reader(book, device, [Heard()], kept)
        reader.begin()
        loop = Exploration(reader, device, NoKeyboard(), Heard())
        for key in "nnnpnpn" * 5:
            for _ in range(15):
                loop.step()
            begun_ns = time.monotonic_ns()
            loop.press(key)
            changed = 0
            while not changed:
                ticks = device.engine.poll()
                new = ticks[(ticks["line"] == reader.number)
                            & (ticks["flags"] & int(Flag.CHANGED) > 0)]  # fmt: skip
                changed = int(new["time_ns"][0]) if new.size else 0
                time.sleep(0.001)
            times.append((changed - begun_ns) / 1e6)
    got = statistics.quantiles(times, n=20)[-1]
    return Result("from a key to the fade's first frame, 95 of 100", "≤ 60 ms", f"{got:.0f} ms",
                  got <= 60)  # fmt: skip


def _search() -> Iterator[Result]:
    from tests.reading.bench import Reading

    paragraph = Path(TEXT).read_text(encoding="utf-8")
    text = (paragraph * (5_000_000 // len(paragraph) + 1))[:5_000_000] + LAST
    with Reading(text, hand="sweep:1") as reading:
        assert reading.reader.book.source.text  # which is gathered while a book is read
        for what, key, words in (
            ("near", "/", "night"),
            ("absent", "/", "zebra crossing"),
            ("far", "/", LAST),
            ("absent, backward", "\\", "zebra crossing"),
        ):
            reading.press(key, f"paste:{words}")
            begun = time.perf_counter()
            reading.press("enter")
            got = time.perf_counter() - begun
            said = f"search in 5 MB, from Enter to its sentence: {what}"
            yield Result(said, "≤ 0.1 s", f"{got:.3f} s", got <= 0.1)


def _kills(folder: Path) -> Result:
    lost = damaged = 0
    line = 1
    for number in range(KILLS):
        with Terminal("read", TEXT, "--hand", "slow", "--cues", "none") as terminal:
            found = terminal.press("i").split(",")[0]
            lost += found != f"line {line}"
            terminal.press("n" if number % 20 < 15 else "p", wait_s=0.0)
            line = int(terminal.press("i").split(",")[0].removeprefix("line "))
            terminal.listen(0.5 + number % 7 * 0.01)
            terminal.end(signal.SIGKILL)
        db = sqlite3.connect(folder / "places.sqlite")
        damaged += db.execute("PRAGMA integrity_check").fetchone() != ("ok",)
        db.close()
    got = f"{lost}, {damaged}"
    return Result(f"{KILLS} × kill -9: places lost, files damaged", "0, 0", got, not lost + damaged)
