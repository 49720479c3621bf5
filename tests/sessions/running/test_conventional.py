"""Sessions with a conventional display: a real BRLTTY, and a person who waits for what is said."""

import re
import time
from dataclasses import dataclass

import pytest

from tests.conventional.handytech import Brltty, needs_brltty
from tests.sessions.planning.test_conventional import BOTH, HEAD, STRINGS, WIDTHS
from tests.sessions.sittings import Person, Played
from tests.tiers import heavy
from vbraille.analysis.input.study import load_study
from vbraille.analysis.methods import methods
from vbraille.errors import InputError, VbrailleError
from vbraille.sessions.conditions import Conditions
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.record import events
from vbraille.sessions.record.export import rows
from vbraille.sessions.record.folder import check
from vbraille.sessions.running.conventional import OnConventional
from vbraille.sessions.session import Session
from vbraille.wording import spelled

pytestmark = needs_brltty

PAPER = 'medium = "paper"\n'
ALL = '[display]\non = "brlapi"\n[conventional]\ncell = 3\n'
PATIENCE_S = 20.0


@dataclass
class Waiting(Person):
    """A person who does something, or types a line, when what was said matches, or at once.

    An Enter that came too early is typed again.
    """

    early: int = 0

    def lines(self, wait_s):
        time.sleep(wait_s)
        if not self.script:
            return None
        pattern, line = self.script[0]
        early = sum(sentence.startswith("too early: ") for sentence in self.said)
        if pattern != "too early" and early > self.early:
            self.early = early
            return [""]
        new = enumerate(self.said[self.seen :], self.seen)
        found = next((n for n, sentence in new if pattern and re.search(pattern, sentence)), None)
        if found is not None or not pattern:
            self.seen = self.seen if found is None else found + 1
            self.script.pop(0)
            if callable(line):
                line()
                return []
            return [line]
        self.waited += 1
        assert self.waited * wait_s < PATIENCE_S, f"{pattern!r} is never said: {self.said[-20:]}"
        return []


def sit(folder, toml, brltty, *script, **how):
    """A session of a protocol with the display of a BRLTTY, and what was said in it."""
    conditions = Conditions(also=f"brlapi:{brltty.host}", hand="sweep:300", **how)
    protocol = parse_protocol(HEAD + toml, "test")
    session = Session.create(protocol, "P1", folder=folder, seed=1, conditions=conditions)
    person = Waiting(list(script))
    session.run(person, say=person.said.append, sound=Played())
    return session, person.said


def told(session, kind):
    return [event for event in session.record.journal.events if isinstance(event, kind)]


def test_strings_stand_there_and_the_journal_says_what_when_and_on_which_display(tmp_path):
    standing = []
    toml = PAPER + STRINGS.replace("cac", "ac") + ALL
    with Brltty(tmp_path) as brltty:

        def look():
            standing.append(brltty.display.wait(bytes((0, 0, *shown.pop(0)))))

        protocol = parse_protocol(HEAD + toml, "test")
        shown = [trial.stimuli[0].masks for trial in make_plan(protocol, "P1", 1).trials]
        session, said = sit(
            tmp_path / "s",
            toml,
            brltty,
            ("ready: trial 1 of 2, on the conventional display; Enter when reading begins", ""),
            ("cue", look),
            (None, "pause"),
            ("pause: ", ""),
            ("go: on", ""),
            ("read: .* s; type the answer", lambda: brltty.display.wait(b"")),
            (None, "ca"),
            ("ready: trial 2 of 2", ""),
            ("cue", look),
            (None, "ac"),
            ("no answer: Enter has not said yet that it was read", "ac"),
            ("last: ", ""),
        )
    (beside,) = told(session, events.DisplayBeside)
    assert (beside.driver, beside.model, beside.columns) == ("HandyTech", "mdlr", 40)
    stood = told(session, events.Stood)
    first = session.plan.trials[0].presented
    assert [event.cells for event in stood if event.trial == 1] == [
        f"⠀⠀{first}",
        "",  # the pause
        f"⠀⠀{first}",
        "",  # it was read
    ]
    # The journal's time is that at which BRLTTY had it, and then the display had it soon.
    assert abs(standing[0] - stood[0].time_ns) < 1e9
    assert [event.line for event in told(session, events.Presented)] == [0, 0]
    table = rows(session.record)
    assert [row["shown_on"] for row in table] == ["conventional"] * 2
    read, cue = (told(session, kind)[0].t_s for kind in (events.Read, events.Cue))
    paused = told(session, events.Go)[0].t_s - told(session, events.Pause)[0].t_s
    assert table[0]["duration_s"] == pytest.approx(read - cue - paused, abs=1e-5)
    assert (table[1]["duration_s"], table[1]["early"], table[0]["moved_by"]) == ("", 1, "")
    assert all(finding.good for finding in check(session.record))
    assert any(sentence == "display: HandyTech mdlr, 40 cells" for sentence in said)


def test_a_display_that_goes_away_in_a_trial_has_it_shown_again(tmp_path):
    one = STRINGS.replace(', "cac"', "") + ALL.replace("3", "30")
    with Brltty(tmp_path) as brltty:
        session, _ = sit(
            tmp_path / "s",
            PAPER + one,
            brltty,
            ("ready", ""),
            ("cue", lambda: brltty.display.wait(bytes(29) + b"\x09\1")),
            (None, brltty.display.unplug),
            (None, ""),
            ("fault: BRLTTY .* drives no display; plug one in; trial 1 of 1 is repeated", ""),
            ("drives no display; plug one in; the trial waits", lambda: brltty.display.plug(20)),
            ("HandyTech mdlr, 20 cells; the conventional display has 20 cells, and", ""),
            ("has 20 cells, and the protocol needs 31; the trial waits", brltty.display.unplug),
            (None, brltty.stop),
            ("display: no BRLTTY answers", lambda: (brltty.display.plug(40), brltty.start())),
            ("display: HandyTech mdlr, 40 cells", ""),
            ("cue", lambda: brltty.display.wait(bytes(29) + b"\x09\1")),
            (None, ""),
            ("read: ", "ca"),
            ("last: ", ""),
        )
    (row,) = rows(session.record)
    assert (row["attempt"], row["answered"]) == (2, "⠉⠁")
    assert row["faults"].endswith("drives no display; plug one in")
    assert len(told(session, events.Fault)) == 1
    assert [event.columns for event in told(session, events.DisplayBeside)] == [40, 20, 40]


def test_an_enter_before_the_display_shows_it_is_too_early(tmp_path, monkeypatch):
    one = STRINGS.replace(', "cac"', "") + ALL
    poll, slow = OnConventional.poll, []
    monkeypatch.setattr(OnConventional, "poll", lambda self: [] if slow else poll(self))
    with Brltty(tmp_path) as brltty:
        session, said = sit(
            tmp_path / "s",
            PAPER + one,
            brltty,
            ("ready", lambda: slow.append(True)),
            (None, ""),
            ("cue", ""),
            ("too early", slow.clear),
            ("read: ", "ca"),
            ("last: ", ""),
        )
    assert "read it, then Enter again" in next(each for each in said if "too early" in each)
    assert [row["attempt"] for row in rows(session.record)] == [1]


@heavy  # it starts an engine
def test_both_displays_alternate_in_one_session(tmp_path):
    one = STRINGS.replace(', "cac"', "") + "[rules]\nat_most_running = { condition = 1 }\n" + BOTH
    with Brltty(tmp_path) as brltty:
        session, _ = sit(
            tmp_path / "s",
            one,
            brltty,
            *_answers(parse_protocol(HEAD + one, "test")),
            ("last: ", ""),
        )
    table = {row["condition"]: row for row in rows(session.record)}
    there = next(name for name, row in table.items() if row["shown_on"] == "conventional")
    said = f"Strings of the condition {there} stood on a conventional display instead, and were"
    text = methods(load_study([session.folder]))
    assert said in text
    assert text.count("conventional display") == text.count("timed by key") == 1
    assert (table["virtual"]["shown_on"], table["virtual"]["trace"]) == ("device", "trace-001.gz")
    assert (table["conventional"]["shown_on"], table["conventional"]["trace"]) == (
        "conventional",
        "",
    )
    assert all(float(row["duration_s"]) > 0 for row in table.values())
    assert all(finding.good for finding in check(session.record))


def _answers(protocol):
    """What is typed in each trial, in the order of the plan."""
    for trial in make_plan(protocol, "P1", 1).trials:
        if trial.condition == "conventional":
            yield from (("ready: .*Enter when reading begins", ""), ("cue", ""))
        yield ("read: ", "ca")


@heavy  # it starts an engine
def test_the_reference_stands_there_throughout_and_its_loss_is_a_fault(tmp_path):
    toml = WIDTHS + '[conventional]\nreference = "a"\n'
    with Brltty(tmp_path) as brltty:
        session, _ = sit(
            tmp_path / "s",
            toml,
            brltty,
            ("cue: trial 1 of 2$", lambda: brltty.display.wait(b"\1")),
            (None, brltty.stop),
            ("fault: no BRLTTY answers .*; trial 1 of 2 is repeated", brltty.start),
            ("cue: trial 1 of 2, second", lambda: brltty.display.wait(b"\1")),
            ("read: ", "1"),
            ("answer: ", lambda: brltty.display.wait(b"\1")),
            ("cue: trial 2 of 2, second", ""),
            ("read: ", "2"),
            ("last: ", ""),
        )
    stood = [event for event in told(session, events.Stood) if event.reference]
    assert {(event.trial, event.cells) for event in stood} == {(1, "⠁"), (2, "⠁")}
    assert [row["shown_on"] for row in rows(session.record)] == ["device"] * 2
    text = methods(load_study([session.folder]))
    assert "; ⠁ stood on a conventional display, for comparison" in text


def test_a_session_does_not_begin_without_its_display(tmp_path):
    with Brltty(tmp_path, cells=20) as brltty:
        wide = PAPER + STRINGS + ALL.replace("3", "30")
        with pytest.raises(InputError) as short:
            sit(tmp_path / "s", wide, brltty)
        brltty.stop()
        with pytest.raises(VbrailleError) as gone:
            sit(tmp_path / "s", PAPER + STRINGS + ALL, brltty)
    assert spelled(str(short.value)) == (
        "the conventional display has 20 cells, and the protocol needs 32; give another display "
        "with --also"
    )
    assert "the protocol needs a conventional display: no BRLTTY answers" in str(gone.value)
    assert not (tmp_path / "s").exists()


def test_what_does_not_go_with_it_is_refused_at_once(tmp_path):
    strings = parse_protocol(HEAD + STRINGS + ALL, "test")
    for conditions, why in (
        (Conditions(fast=True), "which takes its time; leave out --fast"),
        (Conditions(answers="simulated:0"), "which the simulated reader cannot feel"),
    ):
        with pytest.raises(InputError) as raised:
            Session.create(
                strings, "P1", folder=tmp_path / "s", seed=1, conditions=conditions
            ).run()
        assert why in spelled(str(raised.value))
    plain = parse_protocol(HEAD + STRINGS, "test")
    with pytest.raises(InputError) as raised:
        Session.create(
            plain, "P1", folder=tmp_path / "s", seed=1, conditions=Conditions(also="brlapi")
        )
    assert "shows nothing on a conventional display; leave out --also" in spelled(str(raised.value))
