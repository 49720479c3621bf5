"""Tests of what happens in real time, which need a processor when their time comes.

A machine that has other things to do keeps a program from a processor for tens of milliseconds, and
what is timed is late then by no fault of the program. So a test marked ``real_time`` may be tried
three times, and is right if one of them is. The summary names each that was tried more than once:
a fault that comes and goes is to be looked for there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from _pytest.runner import runtestprotocol

if TYPE_CHECKING:
    from collections.abc import Iterator

_MOST_TRIALS = 3
_TRIALS = "trials"


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item, nextitem: pytest.Item | None) -> bool | None:
    """Run a test of real time up to three times, until it is right."""
    if item.get_closest_marker("real_time") is None:
        return None
    item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
    for trial in range(1, _MOST_TRIALS + 1):
        if trial > 1:
            item.user_properties = [(_TRIALS, trial)]
        reports = runtestprotocol(item, log=False, nextitem=nextitem)
        if not any(report.failed for report in reports):
            break
    for report in reports:
        item.ihook.pytest_runtest_logreport(report=report)
    item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
    return True


def pytest_configure(config: pytest.Config) -> None:
    """Make the mark known."""
    config.addinivalue_line("markers", "real_time: may be tried three times (tests/realtime.py)")


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Name the tests that were tried more than once."""
    for name, trials in sorted(_tried_again(terminalreporter)):
        terminalreporter.write_line(f"tried {trials} times: {name}")


def _tried_again(reporter: pytest.TerminalReporter) -> Iterator[tuple[str, int]]:
    for report in [*reporter.getreports("passed"), *reporter.getreports("failed")]:
        if report.when == "call":
            yield from (
                (report.nodeid, value) for key, value in report.user_properties if key == _TRIALS
            )
