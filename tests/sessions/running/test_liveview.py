"""What pages are told of a session: all that it waits for, and nothing of the stimuli if blind."""

from dataclasses import dataclass, field

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.sessions.sittings import COMPARED, MINI, Session, of
from tests.tiers import by_tier
from vbraille.config.settings import say_mapping
from vbraille.engine.batch import BatchEngine
from vbraille.live.messages import PagePress, Turn
from vbraille.render.braille.mappings import MAPPINGS
from vbraille.sessions.record.folder import check
from vbraille.sessions.running.liveview import ENDED, SafeSentences, SessionView

SEEING = "[session]\nblind = false\n"
PRACTICE = '[practice]\ntrials = 2\nstrings = ["ac", "ca"]\n'
STUDIED = MINI.replace('"a", "c", "4", "0"', '"a", "c"') + "".join(
    f'[[conditions]]\nname = "c{n}"\ntexture = {n}\n' for n in (0, 1)
)
ALL = [("read:", "c")] * 4


@dataclass
class FakeMonitor:
    """Keeps what it is told; it may ask for something, or fail in one of its methods."""

    states: list = field(default_factory=list)
    asked: list = field(default_factory=list)
    said: list = field(default_factory=list)
    fails: str = ""
    closed: int = 0

    def _may_fail(self, name):
        if self.fails == name:
            raise OSError(f"{name} fails")

    def launch(self):
        self._may_fail("launch")

    def share(self, _descriptor, _extent):
        self._may_fail("share")

    def tell(self, state):
        self._may_fail("tell")
        self.states.append(state)

    def take(self):
        self._may_fail("take")
        asked, self.asked = self.asked, []
        return asked

    def notes(self):
        self._may_fail("notes")
        said, self.said = self.said, []
        return said

    def close(self):
        self.closed += 1
        self._may_fail("close")


def watch(session, *script, monitor=None, engine=BatchEngine):
    """Sit a session before a live view; the states that its pages were told, and what came."""
    monitor = FakeMonitor() if monitor is None else monitor
    blind = session.protocol.session.blind
    view = SessionView(monitor, blind=blind, host="127.0.0.1", simulated=True)
    return monitor.states, session.sit(*script, engine=engine, view=view)


def placed(states):
    """What pages were told that the session waits for, one after the other."""
    places = [state.place for state in states]
    return [place for n, place in enumerate(places) if place not in places[n - 1 : n]]


def facts(state):
    return dict(state.facts)


def without_times(states):
    """JSON of the states but for times and numbers, each as often as it changes."""
    told = []
    for state in states:
        kept = [fact for fact in state.facts if fact[0] != "time"]
        json = msgspec.json.encode(msgspec.structs.replace(state, facts=kept, number=0))
        if json not in told[-1:]:
            told.append(json)
    return told


def test_every_phase_is_said(tmp_path):
    session = Session(tmp_path / "s", MINI + PRACTICE)
    states, sat = watch(
        session,
        ("read:", "ac"), ("answer: practice 1", "begin"),
        ("cue: trial 1", "pause"), ("pause", ""), ("read:", "c"),
        ("answer: trial 1", "undo"), ("undo: trial 1", "a"), ("cue: trial 2", "break"),
        ("read:", "c"), ("break: 2", ""), *ALL[2:], ("last", ""),
    )  # fmt: skip
    assert sat.progress.ended
    assert placed(states) == [
        "practice 1 of 2: waits until the array is at the left stop",
        "practice 1 of 2: is read",
        "practice 1 of 2: was read; waits for the answer",
        "practice 2 of 2: waits until the array is at the left stop",
        "trial 1 of 4: waits until the array is at the left stop",
        "trial 1 of 4: is read",
        "trial 1 of 4: a pause; Enter at the console ends it",
        "trial 1 of 4: is read",
        "trial 1 of 4: was read; waits for the answer",
        "trial 2 of 4: waits until the array is at the left stop",
        "trial 1 of 4: its answer was taken back, and is typed anew",
        "trial 2 of 4: is read",
        "trial 2 of 4: was read; waits for the answer",
        "a break; Enter at the console ends it",
        "trial 3 of 4: is read",
        "trial 3 of 4: was read; waits for the answer",
        "trial 4 of 4: waits until the array is at the left stop",
        "trial 4 of 4: is read",
        "trial 4 of 4: was read; waits for the answer",
        "all trials are done; Enter at the console ends the session",
        "the session is over",
    ]
    assert [state.number for state in states] == list(range(1, len(states) + 1))
    assert [state.done for state in states] == [False] * (len(states) - 1) + [True]
    paused = [state for state in states if "a pause" in state.place]
    assert paused
    assert all(state.paused for state in paused)
    assert states[-1].said[-1].startswith("end: all trials are done")


def test_facts_say_how_far_it_has_come(tmp_path):
    toml = STUDIED + "[session]\nbreak_every = 2\nlimit_s = 3600\n"
    states, _ = watch(Session(tmp_path / "s", toml))
    first, last = facts(states[0]), facts(states[-1])
    assert first == {
        "trial": "1 of 4", "block": "1 of 2", "answered": "0 of 4",
        "since the last break": "0 trials", "time": "0 min 00 s", "limit": "60 min 00 s",
    }  # fmt: skip
    assert (last["answered"], last["time"] > "0 min 00 s") == ("4 of 4", True)
    assert "trial" not in last
    assert [facts(state).get("since the last break") for state in states].count("1 trials") > 1
    states, _ = watch(Session(tmp_path / "t"), ("cue", "repeat"), ("cue", "stop"))
    assert facts(states[-2])["attempt"] == "2"


def test_what_is_drawn_is_there(tmp_path):
    (first, *_), _ = watch(Session(tmp_path / "s"), ("ready", "stop"))
    assert (first.title, first.mapping) == (
        "Four characters between delimiters",
        "dot row: 1",
    )
    assert (first.array.rows, first.array.columns, first.array.rest_right) == (1, 12, False)
    assert first.geometry["dot_width_mm"] > 0
    assert first.rows_shown == [(0, 0)]
    assert (first.simulated, first.held, first.blind) == (True, False, True)
    assert first.device == "device: in use"


def test_knobs_are_off_and_who_turns_one_is_told(tmp_path):
    monitor = FakeMonitor(asked=[PagePress("contrast-up"), Turn("contrast", 0.5)])
    states, sat = watch(Session(tmp_path / "s"), monitor=monitor)
    assert not any(state.knobs for state in states)
    refused = [one for one in states[-1].said if one.startswith("refused: in a session nothing")]
    assert len(refused) == 1
    assert of(sat.events, "tuning") == []


def test_what_the_view_says_of_itself_goes_to_the_experimenter_alone(tmp_path):
    monitor = FakeMonitor(said=["live view: http://127.0.0.1:1/#SECRET"])
    for toml in (MINI, MINI + SEEING):
        folder = tmp_path / f"s{len(toml)}"
        states, sat = watch(Session(folder, toml), monitor=monitor)
        monitor.said = ["live view: http://127.0.0.1:1/#SECRET"]
        assert "live view: http://127.0.0.1:1/#SECRET" in sat.said
        assert b"SECRET" not in msgspec.json.encode(states)


@pytest.mark.parametrize("where", ["launch", "tell", "take", "notes", "close"])
def test_a_fault_of_the_view_ends_the_view_alone(tmp_path, where):
    monitor = FakeMonitor(fails=where)
    _, sat = watch(Session(tmp_path / "s"), monitor=monitor)
    assert sat.progress.ended
    assert sat.said.count(ENDED) == (where != "close")
    assert monitor.closed == 1
    assert all(finding.good for finding in check(sat.record))


@pytest.mark.parametrize("blind", [True, False])
def test_of_many_sentences_the_last_are_kept(blind):
    heard = SafeSentences(blind=blind)
    for number in range(50):
        heard.hear(f"cue: trial {number}")
        heard.hear("session: P07-legibility")
    assert (heard.before, len(heard.last)) == (30, 20)
    assert heard.last[-1] == "cue: trial 49"


class TestBlind:
    """A blind state tells nothing from which a stimulus or an answer could be read."""

    @pytest.mark.parametrize("toml", [MINI + PRACTICE, STUDIED, COMPARED], ids=["a", "b", "c"])
    @settings(max_examples=by_tier(2, 10, 200))
    @given(seeds=st.lists(st.integers(0, 10**6), min_size=2, max_size=2, unique=True))
    def test_two_sessions_look_the_same(self, tmp_path_factory, toml, seeds):
        told = []
        for participant, seed in zip(("P1", "P2"), seeds, strict=True):
            folder = tmp_path_factory.mktemp("blind") / "s"
            told.append(without_times(watch(Session(folder, toml, participant, seed))[0]))
        assert told[0] == told[1]
        assert len(told[0]) > 4

    @pytest.mark.parametrize("toml", [MINI + PRACTICE, STUDIED, COMPARED], ids=["a", "b", "c"])
    def test_unless_the_protocol_says_otherwise(self, tmp_path, toml):
        seeing = toml.replace("[design]", f"{SEEING}[design]")
        told = [
            without_times(watch(Session(tmp_path / f"{seed}", seeing, f"P{seed}", seed))[0])
            for seed in (1, 2)
        ]
        assert told[0] != told[1]

    def test_what_is_typed_is_not_told(self, tmp_path):
        session = Session(tmp_path / "s", MINI + PRACTICE)
        script = [
            ("cue", "xyzzy"), ("no answer", "note SECRET"), ("read:", "ac"), ("answer", "begin"),
            ("read:", "4"), ("answer: trial 1", "contrast 0.5"),
            ("contrast", "undo"), ("undo: trial", "a"), ("answer: trial", "stop"),
        ]  # fmt: skip
        states, sat = watch(session, *script)
        for state in states:
            assert not state.lines
            assert not {"condition", "asked for", "last answer", "contrast"} & set(facts(state))
            kinds = {sentence.partition(":")[0] for sentence in state.said}
            assert kinds <= {"ready", "cue", "read", "begin", "undo", "stopped", "place", "device"}
        text = msgspec.json.encode(states).decode()
        for secret in ("SECRET", "xyzzy", "P1", "it was", "0.5 ", str(tmp_path)):
            assert secret not in text
        assert any(one.startswith("practice: ") for one in sat.said)


class TestNotBlind:
    """A protocol may say that all is shown."""

    def test_the_line_the_condition_and_the_answer_are_shown(self, tmp_path):
        session = Session(tmp_path / "s", STUDIED + SEEING)
        states, _ = watch(session)
        drawn = {line.number: line for state in states for line in state.lines}
        wanted = [list(session.protocol.line(t.stimuli[0].masks)) for t in session.plan.trials]
        assert [drawn[number].cells for number in sorted(drawn)] == wanted
        assert all(line.under and line.start_mm == 0.0 for line in drawn.values())
        assert {facts(state).get("condition") for state in states} == {"c0", "c1", None}
        told = [facts(state)["asked for"] for state in states if "asked for" in facts(state)]
        assert set(told) == {"l", "c"}
        assert facts(states[-1])["last answer"].endswith("right")

    def test_of_two_the_second_is_shown_with_its_own_distances(self, tmp_path):
        session = Session(tmp_path / "s", COMPARED + SEEING)
        states, _ = watch(session)
        widths = [state.geometry["dot_width_mm"] for state in states if state.lines]
        changes = [width for n, width in enumerate(widths) if width not in widths[n - 1 : n]]
        planned = [s.value for trial in session.plan.trials for s in trial.stimuli]
        assert changes == [v for n, v in enumerate(planned) if v not in planned[n - 1 : n]]
        assert " of " in facts(states[-1])["last answer"]

    @pytest.mark.parametrize(("parameter", "unit"), [("texture", ""), ("dot_width_mm", " mm")])
    def test_values_have_the_unit_of_what_is_compared(self, tmp_path, parameter, unit):
        toml = COMPARED.replace("dot_width_mm", parameter).replace("2.0", "0.5") + SEEING
        session = Session(tmp_path / "s", toml)
        states, _ = watch(session, ("read: type", "1"), ("answer", "stop"))
        planned = [f"{s.value:g}{unit}" for s in session.plan.trials[0].stimuli]
        told = {facts(state)["asked for"] for state in states if "asked for" in facts(state)}
        assert told == set(planned)
        last = facts(states[-1])["last answer"]
        assert last == f"{planned[0]} of {planned[0]} and {planned[1]}"

    def test_the_mapping_is_that_of_the_condition(self, tmp_path):
        conditions = "".join(
            f'[[conditions]]\nname = "{name}"\nmapping = "{name}"\n'
            for name in ("alternate", "paired")
        )
        toml = MINI.replace("vbd", "stress2") + conditions
        session = Session(tmp_path / "s", toml + SEEING)
        states, _ = watch(session)
        shown = {(facts(s)["condition"], s.mapping, str(s.rows_shown)) for s in states if s.lines}
        assert {(name, mapping) for name, mapping, _ in shown} == {
            ("alternate", say_mapping(MAPPINGS["alternate"])),
            ("paired", say_mapping(MAPPINGS["paired"])),
        }
        assert len({rows for _, _, rows in shown}) == 2

    def test_a_blind_page_is_not_told_by_the_mapping_which_condition_it_is(self, tmp_path):
        conditions = "".join(
            f'[[conditions]]\nname = "{name}"\nmapping = "{name}"\n'
            for name in ("alternate", "paired")
        )
        session = Session(tmp_path / "s", MINI.replace("vbd", "stress2") + conditions)
        states, _ = watch(session)
        assert len({(state.mapping, str(state.rows_shown)) for state in states}) == 1


class TestTheJournal:
    """The journal says who may have watched, and a check compares that with the protocol."""

    def test_each_run_says_so(self, tmp_path):
        session = Session(tmp_path / "s")
        _, sat = watch(session, ("cue", "stop"))
        (run,) = of(sat.events, "run")
        assert run["monitor"] == {"blind": True, "host": "127.0.0.1", "pointer": True}
        sat = session.sit()
        assert "monitor" not in of(sat.events, "run")[1]
        said = [finding.text for finding in check(sat.record) if "live view" in finding.text]
        assert said == ["live view: run 1 was shown at 127.0.0.1, blind"]

    def test_a_run_shown_against_the_protocol_is_a_fault(self, tmp_path):
        session = Session(tmp_path / "s")
        view = SessionView(FakeMonitor(), blind=False, host="::", simulated=False)
        sat = session.sit(view=view)
        (bad,) = [finding for finding in check(sat.record) if not finding.good]
        assert bad.text == (
            "live view: run 1 was shown at :: with its stimuli, and the protocol says blind"
        )
