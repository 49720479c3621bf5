"""One browser for each worker; what goes wrong in a page fails its test."""

from contextlib import ExitStack

import pytest
from playwright.sync_api import sync_playwright

from tests.live.showing import launch, until


@pytest.fixture(scope="session")
def browser():
    with sync_playwright() as playwright:
        browser = launch(playwright)
        yield browser
        browser.close()


@pytest.fixture
def opens(browser):
    """Open an address in a context with the given options, once it draws."""
    faults = []
    with ExitStack() as stack:

        def open_page(address, *, drawn=True, **options):
            context = browser.new_context(**{"viewport": {"width": 1280, "height": 900}, **options})
            stack.callback(context.close)
            page = context.new_page()
            page.on("pageerror", lambda error: faults.append(str(error)))
            page.goto(address)
            if drawn:
                until(page, "Boolean(window.vbraille && vbraille.drawn)")
            return page

        yield open_page
    assert faults == []
