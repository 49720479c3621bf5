"""Questions: what may be typed, how it is kept, and how it is scored."""

import pytest

from tests.sessions.planning.test_protocols import load
from tests.sessions.sittings import HEAD, MINI, WIDTHS
from vbraille.devices.events import Button, Knob
from vbraille.sessions.planning.loading import load_protocol
from vbraille.sessions.planning.plan import make_plan
from vbraille.sessions.planning.questionnaire import Item
from vbraille.toml import WrongValue


def ask(folder, text, trial=0):
    """Return a function that reads a line, and the protocol with a trial of its plan."""
    protocol = load(folder, text)
    shown = make_plan(protocol, "P01", 1).trials[trial]
    spelling = protocol.spelling(shown.stimuli[0])
    return (lambda line: protocol.asks.parse(line, shown, spelling)), protocol.asks, shown


def one(folder, question):
    return ask(folder, f"{MINI}[question]\nkind = {question}\n")


def test_cells_are_typed_by_letters_keys_or_dots(tmp_path):
    text = MINI.replace("[design]", "[keys]\nl = '4'\n[design]").replace('"ac", "ca", "aa"', '"al"')
    parse, asks, trial = ask(tmp_path, text)
    for line in ("al", "a l", "1 4", "⠁⠈", " AL "):
        assert asks.correct(trial, parse(line))
    assert asks.outcome(trial, parse("a?")) == "wrong"
    for line in ("", "a", "alc", "a!"):
        with pytest.raises(ValueError, match=r"type|cell|place"):
            parse(line)


def test_texts_are_typed_in_print_and_composed_or_not_is_the_same(tmp_path):
    text = HEAD.replace("vbd", "stress2") + (
        '[display]\ntable = "de-g0.utb"\n[design]\nkind = "list"\nstrings = ["Äpfel"]\n'
    )
    parse, asks, trial = ask(tmp_path, text)
    for line in ("Äpfel", "A\u0308pfel", "äpfel", trial.cells):
        assert asks.correct(trial, parse(line))
    assert set(parse("?")) == {"?"}
    assert not asks.correct(trial, parse("Apfel"))


CHOSEN = '[question]\nkind = "which"\nright = "more"\n'


def test_one_of_two_is_chosen_and_kept_as_its_value(tmp_path):
    parse, asks, trial = ask(tmp_path, WIDTHS + CHOSEN)
    more = "1" if trial.values[0] > trial.values[1] else "2"
    assert asks.outcome(trial, parse(more)) == "right"
    assert parse("first") == "1"
    assert asks.cell(trial, more) == "2"
    with pytest.raises(ValueError, match="3"):
        parse("3")


@pytest.mark.parametrize(
    ("question", "lines"),
    [
        ('"detect"', {"Yes": "yes", "n": "no"}),
        ('"rating"\nscale = "x"\nleast = 1\nmost = 3\nlabels = ["low", "high"]',
         {"1": "1", "HIGH": "3"}),
        ('"magnitude"', {"2,50": "2.5", "10": "10"}),
        ('"free"', {" any words ": "any words"}),
    ],
)  # fmt: skip
def test_lines_are_read_and_others_refused(question, lines, tmp_path):
    parse, asks, _ = one(tmp_path, question)
    assert {line: parse(line) for line in lines} == lines
    for line in ("", *(() if "free" in question else ("-1", "perhaps", "nan"))):
        with pytest.raises(ValueError, match="type"):
            parse(line)
    assert "\n" not in asks.typed


def test_signals_are_hits_and_misses_and_others_false_alarms(tmp_path):
    text = MINI.replace("strings", "repeats = 2\nstrings") + (
        '[question]\nkind = "detect"\n[[conditions]]\nname = "none"\ncontrast = 0.0\n'
        '[[conditions]]\nname = "some"\ncontrast = 1.0\n'
    )
    for number in range(2):
        _, asks, trial = ask(tmp_path, text, number * 6)
        none = trial.condition == "none"
        wanted = ("false alarm", "correct rejection") if none else ("hit", "miss")
        assert (asks.outcome(trial, "yes"), asks.outcome(trial, "no")) == wanted
        assert asks.correct(trial, "no") is none


def test_equal_values_are_the_same(tmp_path):
    text = WIDTHS + 'same = 1\n[question]\nkind = "same-different"\n'
    protocol = load(tmp_path, text)
    trials = make_plan(protocol, "P01", 1).trials
    right = {trial.presented: protocol.asks.right_answer(trial) for trial in trials}
    assert right == {"1 1": "same", "2 2": "same", "1 2": "different", "2 1": "different"}


def test_a_value_is_turned_until_it_is_equal(tmp_path):
    more = (
        'reference = 1.5\nform = "standard"\n[question]\nkind = "adjust"\nstep = 0.1\n'
        "least = 0.5\nmost = 3.0\nknob = 2\nbuttons = [1, 2, 3]\n"
    )
    parse, asks, trial = ask(tmp_path, WIDTHS + more)
    assert (asks.steps("++-"), asks.steps("standard"), asks.steps("equal")) == (1, 0, None)
    assert asks.turned(2.95, 3) == 3.0
    turned = trial.turned("dot_width_mm", 1.7)
    lines = [asks.controlled(Button(number=n, pressed=True), turned) for n in (1, 2, 3, 4)]
    assert lines == ["-", "+", "=", ""]
    lines = [asks.controlled(Knob(*turn), turned) for turn in ((2, 0.0), (2, 1.0), (1, 0.5))]
    assert lines == ["-" * 12, "+" * 13, ""]
    assert asks.parse("equal", turned, None) == asks.parse("=", turned, None) == "1.7"
    with pytest.raises(ValueError, match="type"):
        parse("about equal")


def test_pictures_are_named_by_keys_in_any_order():
    protocol = load_protocol("icons")
    trial = next(trial for trial in make_plan(protocol, "P01", 1).trials if not trial.practice)
    asks = protocol.asks
    keys = ["".join(k for k, name in choice.names.items() if name == trial.columns[choice.of])
            for choice in asks.choices]  # fmt: skip
    for line in (" ".join(keys), "".join(keys), ", ".join(reversed(keys))):
        assert asks.outcome(trial, asks.parse(line, trial, None)) == "right"
    with pytest.raises(ValueError, match="missing"):
        asks.parse(keys[0], trial, None)
    with pytest.raises(ValueError, match="~"):
        asks.parse("~", trial, None)
    assert len({asks.parse(guess, trial, None) for guess in asks.guesses(trial)}) > 1


def item(**how):
    return Item(**{"kind": "text", "name": "x", "when": "end", "ask": "What?", **how})


def test_replies_are_read_by_their_kind():
    number = item(kind="number", least=0.0, most=99.0)
    assert number.parse("12,5") == "12.5"
    choice = item(kind="choice", choices=("yes", "no"))
    assert choice.parse("YES") == "yes"
    rating = item(kind="rating", least=1, most=5, labels=("low", "high"))
    assert rating.parse("high") == "5"
    for question, line in ((number, "100"), (number, "nan"), (choice, "?"), (rating, "0")):
        with pytest.raises(ValueError, match="type"):
            question.parse(line)
        assert question.parse(question.simulate())


def test_a_question_may_be_about_the_item():
    asked = item(ask="Was it a {shape}?", kind="choice", choices=("{shape}", "other"),
                 right="{shape}")  # fmt: skip
    about = asked.of({"shape": "circle"})
    assert (about.ask, about.choices[0], about.right) == ("Was it a circle?", "circle", "circle")
    with pytest.raises(WrongValue):
        item(kind="choice", choices=("only",))
