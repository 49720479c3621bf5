"""What is kept of trials that a person at a live view has read with the pointer."""

import csv
import io

import pytest

from tests.sessions.sittings import MINI, Session, of
from vbraille.devices.events import HandHeld
from vbraille.engine.batch import BatchEngine
from vbraille.sessions.record import events
from vbraille.sessions.record.bids import files
from vbraille.sessions.record.export import rows
from vbraille.sessions.record.folder import check
from vbraille.sessions.record.progress import Progress


def held(begins_s, ends_s):
    """An engine whose simulated hand is held from one time of its clock to another."""

    class Held(BatchEngine):
        told = ()

        def take_events(self):
            given = [*super().take_events()]
            ticks = self.tally.ticks
            for at_s, taken in ((begins_s, True), (ends_s, False)):
                if taken not in self.told and ticks >= at_s * 1000:
                    self.told = (*self.told, taken)
                    given.append(HandHeld(taken))
            return given

    return Held


@pytest.fixture(scope="module")
def sat(tmp_path_factory):
    """A session in which the hand was held from the first trial into the second."""
    session = Session(tmp_path_factory.mktemp("pointed") / "s", MINI, hand="sweep:60")
    first = session.sit().events
    ends = [event["t_s"] for event in of(first, "answer")]
    folder = tmp_path_factory.mktemp("pointed") / "s"
    # By the clock of the device, which began some ms before that of the session.
    return Session(folder, MINI, hand="sweep:60").sit(
        engine=held(ends[0] - 0.5, (ends[0] + ends[1]) / 2)
    )


def test_the_journal_has_when_the_hand_was_taken_and_given_back(sat):
    taken, given = of(sat.events, "hand_taken"), of(sat.events, "hand_given_back")
    assert [(event["trial"], event.get("practice")) for event in taken] == [(1, None)]
    assert [event["trial"] for event in given] == [2]
    assert "hand: moved in the live view" in sat.said
    assert "hand: simulated again" in sat.said
    assert not any("hand:" in event.get("what", "") for event in of(sat.events, "device"))
    assert all(finding.good for finding in check(sat.record))


def test_every_row_of_such_a_trial_is_marked(sat):
    assert [row["moved_by"] for row in rows(sat.record)] == [
        "simulated:pointer", "simulated:pointer", "simulated", "simulated",
    ]  # fmt: skip


def test_a_dataset_has_the_mark_and_the_events(sat):
    made = files(sat.record)
    (beh,) = [made[name].decode() for name in made if name.endswith("_beh.tsv")]
    moved = [row["moved_by"] for row in csv.DictReader(io.StringIO(beh), delimiter="\t")]
    assert moved.count("simulated:pointer") == 2
    (told,) = [made[name].decode() for name in made if name.endswith("_events.tsv")]
    kinds = [row["trial_type"] for row in csv.DictReader(io.StringIO(told), delimiter="\t")]
    assert (kinds.count("hand_taken"), kinds.count("hand_given_back")) == (1, 1)


def test_a_run_begins_with_the_hand_given_back(tmp_path):
    session = Session(tmp_path / "s", MINI, hand="sweep:60")
    session.sit(("read:", "a"), ("cue: trial 2", "stop"), engine=held(0.5, 1e9))
    sat = session.sit()
    assert [row["moved_by"] for row in rows(sat.record)][2:] == ["simulated"] * 2


@pytest.mark.parametrize(
    ("run", "moved_by"),
    [
        ({"trace": "trace-001.gz", "spec": "serial:/dev/ttyACM0"}, "person"),
        ({"trace": "trace-001.gz", "spec": "sim"}, "simulated"),
        ({"trace": "trace-001.gz", "spec": "sim:?hand=slow"}, "simulated"),
        ({"spec": "sim"}, ""),
    ],
    ids=["person", "simulated", "spec", "paper"],
)
def test_what_moves_the_carriage_follows_from_the_device(tmp_path, run, moved_by):
    plan = Session(tmp_path / "s", MINI).plan
    told = [
        events.Run(t_s=0.0, why="start", **run),
        events.Presented(t_s=1.0, trial=1, attempt=1, stimulus=0, line=1, shown={}),
        events.Closed(t_s=2.0),
        events.Run(t_s=2.0, why="fault", trace=run.get("trace", "")),
        events.Presented(t_s=3.0, trial=2, attempt=1, stimulus=0, line=2, shown={}),
    ]
    trials = Progress(plan, told).trials
    assert [trials[number].moved_by for number in (1, 2, 3)] == [moved_by, moved_by, ""]
