"""A server of the live view in a thread, and pages of a real browser that look at it."""

from __future__ import annotations

import asyncio
import shutil
import threading
from typing import TYPE_CHECKING

import pytest

from vbraille.live.server import LiveServer

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Self

    from playwright.sync_api import Browser, Page, Playwright

    from vbraille.live.sources import LiveSource

_PATIENCE_MS = 20_000


def launch(playwright: Playwright) -> Browser:
    """Start Debian's Chromium; a test that needs it is skipped where it is not installed."""
    path = shutil.which("chromium")
    if path is None:
        pytest.skip("chromium is not installed; `make test` does that")
    return playwright.chromium.launch(
        executable_path=path, args=["--no-sandbox", "--disable-gpu", "--disable-extensions"]
    )


class Served:
    """A server of a source, in a thread of its own."""

    def __init__(self, source: LiveSource, *, steers: bool = True, port: int | None = None) -> None:
        self.source, self._steers, self._port = source, steers, port
        self._ready, self._thread = threading.Event(), threading.Thread(target=self._run)

    def _run(self) -> None:
        asyncio.run(self._serve())

    async def _serve(self) -> None:
        self._loop, self._end = asyncio.get_running_loop(), asyncio.Event()
        async with LiveServer(self.source, steers=self._steers, port=self._port) as server:
            self.server = server
            self.steering = server.admission.steering_address
            self.watching = server.admission.watching_address
            self.port = server.admission.port
            self._ready.set()
            await self._end.wait()

    def __enter__(self) -> Self:
        self._thread.start()
        assert self._ready.wait(20)
        return self

    def __exit__(self, *_: object) -> None:
        if not self._thread.is_alive():
            return
        self._loop.call_soon_threadsafe(self._end.set)
        self._thread.join(20)


def until(page: Page, expression: str) -> object:
    """Wait for something to be so; the page's own rules forbid Playwright's way of waiting."""
    for _ in range(_PATIENCE_MS // 20):
        value = page.evaluate(expression)
        if value:
            return value
        page.wait_for_timeout(20)
    raise AssertionError(f"never: {expression}")


def comes(page: Page, so: Callable[[], bool]) -> None:
    """Wait for something on the server's side, while the page goes on."""
    for _ in range(_PATIENCE_MS // 20):
        if so():
            return
        page.wait_for_timeout(20)
    raise AssertionError("it never came")


def settled(page: Page) -> None:
    """Wait until whatever is on its way is drawn, and told in words and numbers."""
    drawn = page.evaluate("vbraille.drawn")
    until(page, f"vbraille.told > {drawn} + 3")
