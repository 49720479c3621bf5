"""One browser for each worker; what goes wrong in a page fails its test."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

from tests.live.page.showing import Served, launch, until
from vbraille.live.sources import LiveSource


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        browser = launch(playwright)
        yield browser
        browser.close()


Opens = Callable[..., tuple[Page, Served]]


@pytest.fixture
def opens(browser: Browser) -> Iterator[Opens]:
    """Open the page of a source in a context with the given options, after a script."""
    faults: list[str] = []
    with ExitStack() as stack:

        def open_page(
            source: LiveSource,
            *,
            steers: bool = True,
            drawn: bool = True,
            script: str = "",
            **options,
        ) -> tuple[Page, Served]:
            served = stack.enter_context(Served(source))
            context = browser.new_context(**{"viewport": {"width": 1280, "height": 900}, **options})
            stack.callback(context.close)
            context.add_init_script(script)
            page = context.new_page()
            page.on("pageerror", lambda error: faults.append(str(error)))
            page.goto(served.steering if steers else served.watching)
            if drawn:
                until(page, "Boolean(window.vbraille && vbraille.drawn)")
            return page, served

        yield open_page
    assert faults == []
