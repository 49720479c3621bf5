"""The live view: what it costs the loop and the processor, and what three browsers draw of it."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import threading
import time
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tests.benchmarks.bench_engine import INFO, ROOM, line
from tests.benchmarks.timing import Result
from tests.live.canned import canned_state
from tests.live.pages import page as client
from vbraille.engine.host import Host
from vbraille.live.monitor import Monitor
from vbraille.simulation.steering import Pointer

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray
    from playwright.sync_api import Browser, Page

BROWSERS = 3
PAIRS = 7
BLOCK_S = 8.0
RATE_HZ = 60
MOVES = 40
LONG_FRAMES = int(os.environ.get("LIVE_FRAMES", "200000"))
_SETTLE_S = 2.0
_POLL_S = 1.0  # the ring holds eight
_READY_FRAMES = 30
_CHROMIUM = "/usr/bin/chromium"
_LINE = 2  # the line under the hand of the canned state
# From the pointer's event to the end of the first frame that draws the hand elsewhere.
_OBSERVE = """() => {
    window.taken = [];
    window.armed = false;
    let began = null, from = 0;
    document.addEventListener("pointermove", (event) => {
        if (!window.armed) return;
        window.armed = false;
        began = event.timeStamp;
        from = vbraille.last.x_mm;
    }, true);
    const look = () => {
        if (began !== null && Math.abs(vbraille.last.x_mm - from) > 0.3) {
            window.taken.push(performance.now() - began);
            began = null;
        }
    };
    const each = () => { setTimeout(look, 0); requestAnimationFrame(each); };
    each();
}"""


def run() -> Iterator[Result]:
    from playwright.sync_api import sync_playwright

    yield _clients()
    with sync_playwright() as play, ExitStack() as stack:
        browsers = [
            play.chromium.launch(executable_path=_CHROMIUM, args=["--no-sandbox"])
            for _ in range(BROWSERS)
        ]
        for browser in browsers:
            stack.callback(browser.close)
        pages = [_opened(browser) for browser in browsers]
        yield from _drawing(pages)
        yield _loaded(pages[0])
        yield _pointing(pages)
        yield from _long(pages)


def _opened(browser: Browser) -> Page:
    return browser.new_page(viewport={"width": 1280, "height": 800})


class LiveBlock:
    """A host, its live view, and what both have used."""

    def __init__(self, host: Host, address: str, server: int) -> None:
        self.host = host
        self.address = address
        self.server = server


@contextmanager
def live() -> Iterator[LiveBlock]:
    """A host whose loop is watched."""
    pointer = Pointer()
    spec = f"sim:?hand=sweep:60&pointer={pointer.descriptor}"
    host = Host(spec, INFO, ROOM, pass_fds=(pointer.descriptor,))
    with Monitor(pointer=pointer) as monitor:
        host.on_share = monitor.share
        with host:
            host.show(line(), _LINE)
            monitor.tell(canned_state())
            while not (said := monitor.notes()):
                time.sleep(0.01)
            assert monitor._process is not None
            yield LiveBlock(host, said[0].rpartition(" ")[2], monitor._process.pid)


@contextmanager
def canned() -> Iterator[LiveBlock]:
    """A host whose loop no page watches, beside a server of canned frames."""
    command = [sys.executable, "-m", "tests.live.canned"]
    with (
        subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process,
        Host("sim:?hand=sweep:60", INFO, ROOM) as host,
    ):
        try:
            assert process.stdout is not None
            host.show(line(), _LINE)
            yield LiveBlock(host, process.stdout.readline().strip(), process.pid)
        finally:
            process.kill()


def _wait(block: LiveBlock, seconds: float) -> NDArray[np.float64]:
    """Let time pass; lateness of the ticks meanwhile in µs, float64[n]."""
    late_us = []
    end_s = time.monotonic() + seconds
    while (left_s := end_s - time.monotonic()) > 0:
        time.sleep(min(left_s, _POLL_S))
        late_us.append(block.host.poll()["lateness_ns"] / 1e3)
    return np.concatenate(late_us)


def _processor_s(process: int) -> float:
    """Processor time that a process has used."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _resident_mb(process: int) -> float:
    pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def _clients() -> Result:
    """Three clients without a browser, each at the rate of a screen."""
    with live() as block:
        ends_s = time.monotonic() + _SETTLE_S + BLOCK_S
        pulled = [0] * BROWSERS

        def pull(number: int) -> None:
            with client(block.address) as opened:
                due_s = time.monotonic()
                while due_s < ends_s:
                    opened.bytes_of_frame()
                    pulled[number] += 1
                    due_s += 1 / RATE_HZ
                    time.sleep(max(0.0, due_s - time.monotonic()))

        threads = [threading.Thread(target=pull, args=(number,)) for number in range(BROWSERS)]
        for thread in threads:
            thread.start()
        _wait(block, _SETTLE_S)
        before_s, before = _processor_s(block.server), sum(pulled)
        _wait(block, BLOCK_S - 1.0)
        share = (_processor_s(block.server) - before_s) / (BLOCK_S - 1.0)
        rate = (sum(pulled) - before) / (BLOCK_S - 1.0)
        for thread in threads:
            thread.join()
    return Result(
        "processor time of the server, three clients that pull 60 frames a second each",
        "≤ 5 %",
        f"{share:.1%} ({rate:.0f} frames a second together)",
        share <= 0.05,
    )


def _show(pages: list[Page], address: str) -> None:
    """Open an address in all browsers, and wait until they draw."""
    for page in pages:
        page.goto("about:blank")
        page.goto(address)
    for page in pages:
        while page.evaluate("window.vbraille?.drawn ?? 0") < _READY_FRAMES:
            time.sleep(0.05)


def _drawn(pages: list[Page]) -> NDArray[np.int64]:
    return np.array([page.evaluate("vbraille.drawn") for page in pages])


def _measured(
    pages: list[Page], kind: Callable[[], object]
) -> tuple[NDArray[np.float64], list[float], float]:
    """Lateness of the ticks in µs, frames a second of each browser, share of a processor."""
    with kind() as block:  # type: ignore[attr-defined]
        _show(pages, block.address)
        _wait(block, _SETTLE_S)
        before, before_s, begun_s = _drawn(pages), _processor_s(block.server), time.monotonic()
        late_us = _wait(block, BLOCK_S)
        taken_s = time.monotonic() - begun_s
        used_s = _processor_s(block.server) - before_s
        rates = (_drawn(pages) - before) / (time.monotonic() - begun_s)
        for page in pages:
            page.goto("about:blank")
    return late_us, rates.tolist(), used_s / taken_s


def _drawing(pages: list[Page]) -> Iterator[Result]:
    """The loop's lateness with the live view and without it, in turns; rates and cost."""
    ratios, lates, rates, shares = [], [], [], []
    for _ in range(PAIRS):
        theirs_us, _, _ = _measured(pages, canned)
        ours_us, drawn, share = _measured(pages, live)
        theirs, ours = (float(np.percentile(late_us, 99)) for late_us in (theirs_us, ours_us))
        ratios.append(ours / theirs)
        lates.append(ours)
        rates.append(drawn)
        shares.append(share)
    ratio, slowest = statistics.median(ratios), np.median(rates, axis=0)
    yield Result(
        "lateness of the loop with the monitor and three browsers that draw live, against the "
        "same browsers that draw canned frames without it, p99",
        "≤ 1.1 ×",
        f"{ratio:.2f} × (of {min(ratios):.2f} to {max(ratios):.2f}; "
        f"{statistics.median(lates):.0f} µs)",
        ratio <= 1.1,
    )
    yield Result(
        "frames a second drawn by each of three headless browsers",
        "≥ 55",
        ", ".join(f"{rate:.1f}" for rate in slowest),
        bool(slowest.min() >= 55),
    )
    share = statistics.median(shares)
    yield Result(
        "processor time of the server, three browsers", "≤ 5 %", f"{share:.1%}", share <= 0.05
    )


def _loaded(page: Page) -> Result:
    """All that a browser loads of the server before it draws."""
    sizes: list[int] = []

    def loaded(response) -> None:
        sizes.append(response.request.sizes()["responseBodySize"])

    with live() as block:
        page.on("requestfinished", lambda request: loaded(request.response()))
        _show([page], block.address)
        page.goto("about:blank")
    kilobytes = sum(sizes) / 1e3
    return Result(
        "size of what the browser loads",
        "≤ 150 kB",
        f"{kilobytes:.0f} kB in {len(sizes)} files",
        0 < kilobytes <= 150,
    )


def _pointing(pages: list[Page]) -> Result:
    """From the pointer to the first drawn frame in which the hand is elsewhere."""
    with live() as block:
        _show(pages, block.address)
        page = pages[0]
        page.evaluate(_OBSERVE)
        box = page.locator("#sheet .moving").bounding_box()
        assert box is not None
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        page.mouse.move(x, y)
        page.mouse.down()
        for number in range(MOVES):
            _wait(block, 0.4)
            page.evaluate("() => { window.armed = true; }")
            page.mouse.move(x + (60 if number % 2 else -60), y)
        _wait(block, 0.4)
        taken_ms = page.evaluate("window.taken")
        page.mouse.up()
        for each in pages:
            each.goto("about:blank")
    p50 = statistics.median(taken_ms)
    return Result(
        f"pointer to drawn frame, {len(taken_ms)} moves, three browsers, p50 (p90)",
        "≤ 50 ms",
        f"{p50:.0f} ms ({np.percentile(taken_ms, 90):.0f} ms)",
        p50 <= 50 and len(taken_ms) >= MOVES // 2,
    )


def _heaps_mb(pages: list[Page]) -> list[float]:
    """What the scripts of each page hold, after all that is no longer referred to is gone."""
    heaps = []
    for page in pages:
        session = page.context.new_cdp_session(page)
        session.send("HeapProfiler.collectGarbage")
        heaps.append(session.send("Runtime.getHeapUsage")["usedSize"] / 1e6)
        session.detach()
    return heaps


def _long(pages: list[Page]) -> Iterator[Result]:
    """Memory of both sides over very many frames."""
    with live() as block:
        _show(pages, block.address)
        _wait(block, 10.0)
        begun = _drawn(pages).sum()
        server, heaps = _resident_mb(block.server), _heaps_mb(pages)
        while (shown := _drawn(pages).sum() - begun) < LONG_FRAMES:
            _wait(block, 5.0)
        grown = _resident_mb(block.server) - server
        more = max(after - before for before, after in zip(heaps, _heaps_mb(pages), strict=True))
    yield Result(
        f"memory that the server has more after {shown:,} frames",
        "≤ 1 MB",
        f"{grown:.2f} MB (of {server:.0f})",
        grown <= 1,
    )
    yield Result(
        f"memory that a page's scripts hold more after {shown:,} frames in three browsers, at most",
        "≤ 1 MB",
        f"{more:.2f} MB (of {max(heaps):.1f})",
        more <= 1,
    )
