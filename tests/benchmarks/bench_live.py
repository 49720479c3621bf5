"""The live view: frames a second in one and in three browsers, and from pointer to picture."""

from __future__ import annotations

import os
import re
import statistics
import subprocess
import sys
import time
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from tests.benchmarks.timing import Result
from tests.live.showing import launch

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Page

BLOCK_S = 8.0
MOVES = 40
_TEXT = Path(__file__).parents[2] / "texts/english.txt"
# From the pointer's event to the end of the first frame that draws the hand elsewhere.
_OBSERVE = """() => {
    window.taken = [];
    let began = null, from = 0;
    document.addEventListener("pointermove", (event) => {
        if (!window.armed) return;
        window.armed = false;
        [began, from] = [event.timeStamp, vbraille.last.x_mm];
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


@contextmanager
def _reading(hand: str) -> Iterator[tuple[str, int]]:
    """Address of the live view of a reading, and the number of its process."""
    command = [sys.executable, "-m", "vbraille", "read", str(_TEXT), "--monitor", "--no-places"]
    with subprocess.Popen([*command, "--hand", hand], stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            said = ""
            while not (found := re.search(r"live view: (http\S+)", said)):
                said = process.stdout.readline()
            yield found[1], process.pid
        finally:
            process.kill()


def _show(pages: list[Page], address: str) -> None:
    for page in pages:
        page.goto("about:blank")
        page.goto(address)
    for page in pages:
        while page.evaluate("window.vbraille?.drawn ?? 0") < 100:
            time.sleep(0.05)


def _processor_s(process: int) -> float:
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _drawing(pages: list[Page]) -> Result:
    """Rates of pages that draw at once, and what the reading process uses."""
    with _reading("sweep:60") as (address, process):
        _show(pages, address)
        drawn = [page.evaluate("vbraille.drawn") for page in pages]
        begun_s, used_s = time.monotonic(), _processor_s(process)
        time.sleep(BLOCK_S)
        passed_s = time.monotonic() - begun_s
        share = (_processor_s(process) - used_s) / passed_s
        counts = [page.evaluate("vbraille.drawn") for page in pages]
    rates = [(now - before) / passed_s for now, before in zip(counts, drawn, strict=True)]
    return Result(
        f"frames a second drawn by {len(pages)} headless browser{'s' * (len(pages) > 1)}",
        "≥ 58",
        f"{', '.join(f'{rate:.1f}' for rate in rates)} (the reading uses {share:.1%} of a core)",
        min(rates) >= 58,
    )


def _pointing(page: Page) -> Result:
    """From the pointer to the first drawn frame in which the hand is elsewhere."""
    with _reading("still") as (address, _):
        _show([page], address)
        page.evaluate(_OBSERVE)
        box = page.locator("#sheet .moving").bounding_box()
        assert box is not None
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        page.mouse.move(x, y)
        page.mouse.down()
        for number in range(MOVES):
            page.wait_for_timeout(400)
            page.evaluate("() => { window.armed = true; }")
            page.mouse.move(x + (60 if number % 2 else -60), y)
        page.wait_for_timeout(400)
        taken_ms = page.evaluate("window.taken")
        page.mouse.up()
    p50, p90 = statistics.median(taken_ms), statistics.quantiles(taken_ms, n=10)[-1]
    return Result(
        f"pointer to drawn frame, {len(taken_ms)} moves, p50 (p90)",
        "≤ 50 ms",
        f"{p50:.0f} ms ({p90:.0f} ms)",
        p50 <= 50 and len(taken_ms) >= MOVES // 2,
    )


def run() -> Iterator[Result]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as play, ExitStack() as stack:
        pages = []
        for _ in range(3):
            browser = launch(play)
            stack.callback(browser.close)
            pages.append(browser.new_page(viewport={"width": 1280, "height": 800}))
        yield _drawing(pages[:1])
        yield _drawing(pages)
        yield _pointing(pages[0])
