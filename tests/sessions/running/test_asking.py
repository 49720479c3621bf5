"""Sessions that ask other questions than which cells these are, and the participant's own key."""

import shutil
from copy import copy

import pytest

from tests.sessions.sittings import COMPARED, MINI, Session, crash, of
from tests.tiers import by_tier
from vbraille.engine.batch import BatchEngine
from vbraille.errors import InputError
from vbraille.sessions import session as door
from vbraille.sessions.conditions import Conditions
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.record.export import rows
from vbraille.sessions.record.folder import check
from vbraille.sessions.record.progress import Progress

SURE = "confidence = { least = 1, most = 4 }\n"
DETECT = MINI + '[question]\nkind = "detect"\n'
FAST = Conditions(fast=True, hand="sweep:150")
KINDS = {
    "identify": (MINI, 'kind = "identify"\n', "c", "⠉"),
    "which": (COMPARED, 'kind = "which"\nright = "more"\n', "2", None),
    "same-different": (COMPARED, 'kind = "same-different"\n', "s", "same"),
    "detect": (MINI, 'kind = "detect"\n', "y", "yes"),
    "rating": (MINI, 'kind = "rating"\nscale = "r"\nleast = 1\nmost = 7\n', "7", "7"),
    "magnitude": (MINI, 'kind = "magnitude"\n', "2.50", "2.5"),
    "free": (MINI, 'kind = "free"\n', "like sand", "like sand"),
}


def run(tmp_path, toml, answers):
    """A session of a protocol, from lines of a file or another source."""
    if isinstance(answers, list):
        (tmp_path / "answers").write_text("\n".join(answers), encoding="utf-8")
        answers = str(tmp_path / "answers")
    session = door.Session.create(
        parse_protocol(toml, "test"), "P1", folder=tmp_path / "s", seed=1, conditions=FAST
    )
    return session.run(answers)


@pytest.mark.parametrize(
    ("kind", "lines"),
    [(kind, lines) for n, kind in enumerate(KINDS) for lines in by_tier((n % 2,), (0, 1), (0, 1))],
)
def test_each_kind_from_a_file_to_the_export(tmp_path, kind, lines):
    toml, question, line, kept = KINDS[kind]
    trials = 2 if toml is COMPARED else 4
    script = [f"{line}; 3"] if lines == 0 else [line, "3"]
    session = run(tmp_path, f"{toml}[question]\n{question}{SURE}", script * trials)
    table = session.trials
    assert len(table) == trials
    assert session.progress.ended
    assert {row["question"] for row in table} == {kind}
    assert {row["confidence"] for row in table} == {3}
    for row in table:
        assert row["answered"] == (kept or row["presented"].split()[1])
        assert (row["correct"] == "") == (row["outcome"] == "")
        good = row["outcome"] in ("right", "hit", "correct rejection")
        assert not row["outcome"] or row["correct"] == int(good)
    assert all(finding.good for finding in check(session.record))


def test_outcomes_of_the_export(tmp_path):
    table = run(tmp_path, DETECT, ["y"] * 4).trials
    # The blank one among the four has no dots between the delimiters.
    told = {row["presented"]: (row["outcome"], row["correct"]) for row in table}
    assert told == {"⠁": ("hit", 1), "⠉": ("hit", 1), "⠈": ("hit", 1), "⠀": ("false alarm", 0)}


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "free"])
def test_the_simulated_reader_answers(tmp_path, kind):
    toml, question, _, _ = KINDS[kind]
    table = run(tmp_path, f"{toml}[question]\n{question}{SURE}", "simulated").trials
    assert {row["confidence"] for row in table} == {3}  # it would give each answer again
    assert all(row["answered"] for row in table)
    assert all(row["correct"] in (1, "") for row in table)  # without noise it is right


def test_the_simulated_reader_has_no_words_of_its_own(tmp_path):
    with pytest.raises(InputError, match="'free', which the simulated reader cannot answer"):
        run(tmp_path, f'{MINI}[question]\nkind = "free"\n', "simulated")
    assert not (tmp_path / "s").exists()


@pytest.mark.parametrize(
    ("script", "said"),
    [
        (["y; 3", "perhaps"], "line 2: 'perhaps' is not an answer; type yes or no"),
        (["y", "9"], "line 2: '9' is not an answer; type a whole number, 1 to 4"),
        (["y", "undo", "3"], "line 3: '3' is not an answer; type yes or no"),
        (["y; 1"] * 5, "line 5: there is no trial left to answer"),
    ],
)
def test_a_wrong_line_of_a_file_is_refused_before_anything_begins(tmp_path, script, said):
    with pytest.raises(InputError, match=said):
        run(tmp_path, DETECT + SURE, script)
    assert not (tmp_path / "s").exists()


def test_a_program_gives_both_on_one_line(tmp_path):
    with pytest.raises(InputError, match="it has no confidence; give one after a semicolon"):
        run(tmp_path, DETECT + SURE, lambda _trial: "yes")


def test_the_experimenter_is_asked_for_one_thing_after_the_other(tmp_path):
    session = Session(tmp_path / "s", DETECT + SURE)
    sat = session.sit(
        ("read: type yes or no", "perhaps"), ("no answer: 'perhaps'", "y"),
        ("confidence: trial 1 of 4, yes; type 1 to 4", "7"), ("no confidence: '7'", "4"),
        ("answer: trial 1 of 4, yes, confidence 4", "undo"), ("undo: trial 1", "n"),
        ("confidence: trial 1 of 4, no", "undo"), ("undo: trial 1", "n; 2"),
        ("read:", "y"), ("confidence", "pause"), ("pause: .* confidence is waited for", "1"),
        ("read:", "y"), ("confidence", "repeat"), ("ready: trial 3 of 4, again", ""),
        ("read:", "y; 1"), ("read:", "n; 1"), ("last", ""),
    )  # fmt: skip
    told = [(e["trial"], e["answer"], e["confidence"], e.get("corrects", False))
            for e in of(sat.events, "answer")]  # fmt: skip
    assert told == [
        (1, "yes", 4, False), (1, "no", 2, True), (2, "yes", 1, False), (3, "yes", 1, False),
        (4, "no", 1, False),
    ]  # fmt: skip
    row = rows(sat.record)[0]
    assert (row["answered"], row["first_answer"], row["confidence"]) == ("no", "yes", 2)
    assert not any("\n" in sentence for sentence in sat.said)


def test_the_time_of_the_answer_is_not_that_of_its_confidence(tmp_path):
    session = Session(tmp_path / "s", DETECT + SURE)
    sat = session.sit(("read:", "y"), ("confidence", "note later"), ("note: is in", "4"),
                      ("answer", "stop"))  # fmt: skip
    (answer,) = of(sat.events, "answer")
    told = sat.progress.trials[1]
    assert answer["confidence_s"] > 0
    assert told.t_s["answer"] == pytest.approx(answer["t_s"] - answer["confidence_s"])


def test_stopped_before_the_confidence_both_are_asked_again(tmp_path):
    session = Session(tmp_path / "s", DETECT + SURE)
    sat = session.sit(("read:", "y"), ("confidence", "stop"))
    assert "no confidence: trial 1 of 4 is asked again" in sat.said
    assert not of(sat.events, "answer")
    again = session.sit(("read:", "n; 3"), ("answer: trial 1 of 4, no", "stop"))
    assert [(e["attempt"], e["confidence"]) for e in of(again.events, "answer")] == [(2, 3)]


def test_killed_between_any_two_events_no_answer_is_lost(tmp_path):
    lines = ["y", "3"] * 4
    toml = DETECT + SURE
    run(tmp_path, toml, lines)
    path = tmp_path / "s" / "journal.jsonl"
    written = path.read_bytes().splitlines(keepends=True)
    end = next(n for n, line in enumerate(written) if b'"end"' in line)
    for count in range(2, end + 1, by_tier(9, 1, 1)):
        folder = shutil.copytree(tmp_path / "s", tmp_path / f"{count}")
        crash(folder, sum(map(len, written[:count])))
        session = door.Session.resume(folder)
        before = [told.confidence for told in session.progress.trials.values() if told.answer]
        session.run()
        answers = of(session.record.journal.events, "answer")
        assert [e["confidence"] for e in answers] == [3] * 4, count
        assert len(before) == sum(b'"answer","' in line for line in written[:count])
        assert [e["trial"] for e in answers] == [1, 2, 3, 4]
        assert all(finding.good for finding in check(session.record)), count


def test_practice_says_whether_it_was_right(tmp_path):
    toml = DETECT + '[practice]\ntrials = 1\nstrings = ["ac"]\n'
    sat = Session(tmp_path / "s", toml).sit(("read:", "n"), ("practice: wrong", "stop"))
    assert "practice: wrong, it was something" in sat.said


@pytest.mark.parametrize(
    ("parameter", "said"), [("texture", "0.25 and 0.75"), ("dot_width_mm", "0.25 mm and 0.75 mm")]
)
def test_practice_says_values_with_the_unit_of_what_is_compared(tmp_path, parameter, said):
    toml = COMPARED.replace("dot_width_mm", parameter).replace("2.0", "0.5")
    toml += "[practice]\ntrials = 1\nvalues = [0.25, 0.75]\n"
    sat = Session(tmp_path / "s", toml).sit(("read: type", "1"), ("practice: they", "stop"))
    first, second = said.split(" and ")
    assert {f"practice: they were {said}", f"practice: they were {second} and {first}"} & set(
        sat.said
    )


class Pressing(BatchEngine):
    """An engine whose device has its first button pressed when a stimulus has been felt a while."""

    button = 1
    after = 3

    def __init__(self, *given, **named):
        super().__init__(*given, **named)
        self._polls = 0

    def show(self, picture, line):
        super().show(picture, line)
        self._polls = 0

    def poll(self):
        self._polls += 1
        if self._polls == self.after:
            self.device.press(self.button)
        if self._polls == self.after + 1:
            self.device.let_go(self.button)
        return super().poll()


class PressingAnother(Pressing):
    """The same with another button."""

    button = 2


KEYED = MINI + '[trial]\nend = "button:1"\n'


def test_a_button_ends_reading_and_times_it(tmp_path):
    session = Session(tmp_path / "s", KEYED)
    script = [("ended: .* s, by button 1; type the answer", "c")] * 4
    sat = session.sit(*script, ("last", ""), engine=Pressing)
    ended, answers = of(sat.events, "ended"), of(sat.events, "answer")
    cues = of(sat.events, "cue")
    assert [e["by"] for e in ended] == ["button:1"] * 4
    assert [e["ended_by"] for e in answers] == ["button:1"] * 4
    for row, cue, key, answer in zip(rows(sat.record), cues, ended, answers, strict=True):
        assert row["ended_by"] == "button:1"
        assert row["response_s"] == pytest.approx(key["t_s"] - cue["t_s"])
        assert key["t_s"] < answer["t_s"]
        assert row["early"] == 0
    assert all(finding.good for finding in check(sat.record))


def test_another_button_ends_nothing_and_an_answer_before_the_key_is_marked(tmp_path):
    session = Session(tmp_path / "s", KEYED)
    sat = session.sit(
        ("cue: trial 1", "c"), ("no answer: it was not read", "c"), ("answer", "stop"),
        engine=PressingAnother,
    )  # fmt: skip
    assert not of(sat.events, "ended")
    row = rows(sat.record)[0]
    (answer,) = of(sat.events, "answer")
    assert (row["ended_by"], answer["ended_by"]) == ("answer", "answer")
    assert row["response_s"] == pytest.approx(answer["t_s"] - of(sat.events, "cue")[0]["t_s"])


def test_enter_may_be_the_key(tmp_path):
    session = Session(tmp_path / "s", MINI + '[trial]\nend = "key:enter"\n')
    sat = session.sit(("cue: trial 1", ""), ("ended: .* by key enter", "c"), ("answer", "stop"))
    assert [e["by"] for e in of(sat.events, "ended")] == ["key:enter"]
    assert rows(sat.record)[0]["ended_by"] == "key:enter"


def test_killed_after_the_key_the_trial_is_shown_again(tmp_path):
    session = Session(tmp_path / "s", KEYED)
    script = [("ended", "c")] * 4
    sat = session.sit(*script, ("last", ""), engine=Pressing)
    kinds = [event.kind for event in sat.events]
    again = copy(session)
    again.folder = shutil.copytree(session.folder, tmp_path / "again")
    lines = (session.folder / "journal.jsonl").read_bytes().splitlines(keepends=True)
    crash(again.folder, sum(map(len, lines[: kinds.index("ended") + 1])))
    resumed = again.sit(*script, ("last", ""), engine=Pressing)
    told = Progress(session.plan, resumed.events).trials
    assert [told[n].attempts for n in (1, 2)] == [2, 1]
    assert {record.ended_by for record in told.values()} == {"button:1"}


def test_a_session_by_file_goes_on_where_nobody_presses(tmp_path):
    table = run(tmp_path, KEYED, ["c"] * 4).trials
    assert {row["ended_by"] for row in table} == {"answer"}


def test_what_the_experimenter_has_set_is_what_was_there(tmp_path):
    toml = DETECT.replace('["a", "c", "4", "0"]', '["a", "c"]')
    toml += '[practice]\ntrials = 1\nstrings = ["⠈"]\n'
    sat = Session(tmp_path / "s", toml).sit(
        ("cue: practice", "contrast 0"), ("read: ", "no"),
        ("cue: trial 1", ""), ("read: ", "no"),
        ("cue: trial 2", "contrast 1"), ("read: ", "no"), ("last", ""),
    )  # fmt: skip
    assert "practice: right, it was nothing" in sat.said
    told = [(row["contrast"], row["outcome"], row["correct"]) for row in rows(sat.record)]
    assert told == [(0.0, "correct rejection", 1), (1.0, "miss", 0)]
