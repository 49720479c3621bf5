"""Gaps between runs: by a clock that nobody sets, and said where the other one was set."""

import json
from datetime import UTC, datetime, timedelta

from tests.sessions.sittings import Session
from vbraille.sessions.record.check import check_folder
from vbraille.sessions.record.clocks import Moment, boot, gap, say_moved
from vbraille.sessions.record.events import Run, Stop
from vbraille.sessions.record.journal import encode, up_s

NOON = datetime(2026, 11, 21, 12, tzinfo=UTC)


def moment(wall_s, up, started="a"):
    return Moment(NOON + timedelta(seconds=wall_s), up, started)


def test_a_gap_is_that_of_the_machines_clock_whatever_the_wall_clock_says():
    for moved_s in (-3600.0, 0.5, 7200.0):
        told = gap(moment(0, 100.0), moment(60 + moved_s, 160.0))
        assert (told["gap_s"], told["gap_by"]) == (60.0, "machine")
        assert told.get("clock_moved_s", 0.5) == moved_s
    assert say_moved({"gap_s": 60.0, "clock_moved_s": -3600.0}).endswith("was set back by 3600 s")
    assert say_moved({"gap_s": 60.0}) is None


def test_of_a_machine_that_was_started_anew_the_wall_clock_tells_if_it_can():
    for before, now in (
        (moment(0, 100.0), moment(60, 10.0, "b")),
        (moment(0, None, ""), moment(60, 10.0)),
        (moment(0, 100.0, ""), moment(60, 10.0, "")),
    ):
        assert gap(before, now) == {"gap_s": 60.0, "gap_by": "wall"}
    told = gap(moment(0, 100.0), moment(-60, 10.0, "b"))
    assert told == {"gap_by": "wall", "clock_moved_s": -60.0}
    assert say_moved(told).endswith(
        "set back by 60 s or more, so that nobody knows how long the session was not run"
    )


def test_an_event_has_both_clocks():
    event = Stop(t_s=0.0, wall="2026-11-21T12:00:00.000000Z", up_s=5.0)
    assert Moment.of(event, Run(t_s=0.0, why="start", boot="a")) == moment(0, 5.0)
    now = Moment.now()
    assert now.boot == boot()
    assert 0 < up_s() - now.up_s < 60
    assert abs((datetime.now(UTC) - now.wall).total_seconds()) < 60


def test_a_clock_that_was_set_back_in_a_session_is_noticed_by_check(tmp_path):
    session = Session(tmp_path / "s")
    session.sit()
    path = tmp_path / "s" / "journal.jsonl"
    said = [found.text for found in check_folder(tmp_path / "s")]
    assert not [text for text in said if text.startswith("clock: ")]
    lines, crc, content = path.read_bytes().splitlines(), 0, b""
    for n, line in enumerate(lines, 1):
        event = json.loads(line)
        del event["crc"]
        if n > 10:
            back = datetime.fromisoformat(event["wall"]) - timedelta(hours=1)
            event["wall"] = back.isoformat().replace("+00:00", "Z")
        line, crc = encode(event, crc)
        content += line
    path.write_bytes(content)
    (said,) = [f.text for f in check_folder(tmp_path / "s") if f.text.startswith("clock: ")]
    assert "set back by 3" in said
    assert said.endswith("before event 11")
