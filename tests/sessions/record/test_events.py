"""The kinds of events: what one has, and what none may have."""

import re
from pathlib import Path
from typing import get_args

import pytest

from tests.documents import described, members
from tests.sessions.sittings import Session as Sitting
from vbraille.errors import VbrailleError
from vbraille.sessions.record import events, journal
from vbraille.sessions.record.events import (
    AnyEvent,
    AnyTime,
    JournalEvent,
    Lost,
    WithStimulus,
    read_event,
    to_json,
)
from vbraille.sessions.record.progress import Progress

DOCUMENT = Path(__file__).parents[3] / "docs" / "session-format.md"
KINDS = get_args(AnyEvent)
COMMON = (JournalEvent, AnyTime, WithStimulus)


def leaves(kind):
    """All classes that follow from one, and that none follows from."""
    below = kind.__subclasses__()
    return {leaf for each in below for leaf in leaves(each)} if below else {kind}


def test_every_class_is_a_kind_that_a_journal_may_have():
    assert set(KINDS) == leaves(JournalEvent) - {Lost}


def test_the_document_has_the_members_of_all_kinds():
    text = DOCUMENT.read_text()
    for kind in COMMON:
        assert members(described(kind)[1]) in text


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_every_field_of_a_kind_is_described(kind):
    own = {
        name
        for base in kind.__mro__
        if issubclass(base, JournalEvent)
        for name in described(base)[1]
    }
    assert {name for names in own for name in names.split(", ")} == set(kind.__struct_fields__)


def test_what_is_written_is_read(tmp_path):
    for event in Sitting(tmp_path / "s").sit().events:
        line = journal.encode(event, 0)[0]
        assert journal.decode(line).events == [event]


@pytest.mark.parametrize(
    ("line", "why"),
    [
        (b'{"event":"fly","t_s":1.0}', "of the kind 'fly', which this vbraille does not know"),
        (b'{"event":"lost","t_s":1.0}', "of the kind 'lost', which this vbraille does not know"),
        (b'{"t_s":1.0}', "of the kind None, which this vbraille does not know"),
        (b"[1]", "of the kind None, which this vbraille does not know"),
        (b'{"event":"note","t_s":1.0}', "'note' without 'text'"),
        (b'{"event":"stop","t_s":1.0,"x":1}', "'stop' with an unknown field, 'x'"),
        (b'{"event":"cue","t_s":1.0}', "'cue' that cannot be read: it is of no trial"),
        (b'{"event":"cue","t_s":"1","trial":1}', "'cue' that cannot be read: Expected `float`"),
        (b'{"event":"end","t_s":1.0,"wh":"\\udcff"}', "'end' with"),
        (b"{4}", "is not JSON"),
    ],
)
def test_what_is_no_event_is_said(line, why):
    with pytest.raises(ValueError, match=re.escape(why)):
        read_event(line)


def test_a_text_that_is_no_unicode_is_kept():
    note = events.Note(t_s=1.0, text="\udcff")
    (again,) = journal.decode(journal.encode(note, 0)[0]).events
    assert again == note


def test_an_event_of_a_trial_that_there_is_not_is_said(tmp_path):
    session = Sitting(tmp_path / "s")
    with pytest.raises(VbrailleError, match="event 0 is of trial 99, which there is not"):
        Progress(session.plan, [events.Cue(t_s=0.0, trial=99)])


def test_the_journals_own_members_stand_around_the_event():
    cue = events.Cue(n=3, t_s=1.0, trial=2, wall="now", up_s=4.0)
    assert list(to_json(cue)) == ["n", "event", "trial", "t_s", "wall", "up_s"]
