"""The log for developers: kept when asked for, by lines, and by programs alone."""

import logging
import re

import pytest

from tests.devices.bench import Bench
from vbraille import logs
from vbraille.errors import InputError

LINE = re.compile(r"[-\d]+ [:\d]+\.\d{3} \d+ (DEBUG|INFO) (vbraille[.\w]*): (.*)")


@pytest.fixture
def keep():
    """Keep a log somewhere, until the test is over."""
    handlers = []

    def begin(where):
        handlers.append(logs.keep(str(where)))

    yield begin
    for handler in handlers:
        logs.stop(handler)


def test_a_conversation_s_transitions_are_lines_of_a_file(keep, tmp_path):
    keep(tmp_path / "log")
    made = Bench()
    device = made.open()
    made.settle(device)
    device.close()
    lines = (tmp_path / "log").read_text().splitlines()
    found = [LINE.fullmatch(line) for line in lines]
    assert all(found)
    assert {line[2] for line in found} == {"vbraille.devices.serial.conversation"}
    assert [line[3].partition(":")[0] for line in found] == [
        "GREETING to ASKED",
        "ASKED to RAMPING",
        "RAMPING to AT_REST",
        "AT_REST to LIVE",
        "LIVE to RAMPING",
        "RAMPING to CLOSED",
    ]


def test_a_record_is_one_line_and_is_appended(tmp_path):
    (tmp_path / "log").write_text("before\n")
    handler = logs.keep(str(tmp_path / "log"))
    # By the handler alone: what pytest keeps of a record must be text that it can send.
    handler.emit(
        logging.LogRecord("vbraille.some", logging.INFO, "", 0, "one\ntwo \udc80", None, None)
    )
    logs.stop(handler)
    before, line = (tmp_path / "log").read_text().splitlines()
    assert before == "before"
    assert line.endswith("INFO vbraille.some: one two \\udc80")


def test_a_log_goes_to_standard_error(keep, capfd):
    keep("-")
    logging.getLogger("vbraille.some").info("something")
    assert capfd.readouterr().err.endswith("vbraille.some: something\n")


def test_it_is_known_where_the_log_is(keep, tmp_path, monkeypatch):
    assert logs.kept() is None
    monkeypatch.chdir(tmp_path)
    keep("log")
    assert logs.kept() == str(tmp_path / "log")


def test_a_log_that_cannot_be_kept(tmp_path):
    with pytest.raises(InputError, match="cannot be written: Is a directory"):
        logs.keep(str(tmp_path))


def test_a_log_that_cannot_be_written_any_more_stops_nobody(keep):
    keep("/dev/full")
    logging.getLogger("vbraille.some").info("lost")


def test_without_being_asked_nothing_is_kept_and_nothing_said(capfd):
    made = Bench()
    device = made.open()
    made.settle(device)
    device.close()
    assert logs.kept() is None
    assert capfd.readouterr() == ("", "")
