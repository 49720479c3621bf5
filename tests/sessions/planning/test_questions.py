"""What is asked of a trial: how answers are spelled, how they are scored, what cannot be asked."""

import pytest

from tests.sessions.sittings import COMPARED, MINI
from vbraille.errors import InputError
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import load_protocol, parse_protocol
from vbraille.sessions.running.console import read_line

RATED = 'kind = "rating"\nscale = "roughness"\nleast = 1\nmost = 5\n'
BLANK = '[[conditions]]\nname = "blank"\ncontrast = 0.0\n[[conditions]]\nname = "full"\n'


def protocol(question, toml=MINI, more=""):
    """A protocol that asks this."""
    return parse_protocol(f"{toml}{more}[question]\n{question}\n", "p.toml")


def first(of):
    """The first trial of its plan."""
    return make_plan(of, "P1", 1).trials[0]


def read(question, line, toml=MINI):
    """Answer as it is kept, without its confidence."""
    of = protocol(question, toml)
    return read_line(of, first(of), line)[0]


@pytest.mark.parametrize(
    ("question", "toml", "line", "kept"),
    [
        ('kind = "identify"', MINI, "c", "⠉"),
        ('kind = "which"', COMPARED, "Second", "2"),
        ('kind = "same-different"', COMPARED, "S", "same"),
        ('kind = "same-different"', COMPARED, " different ", "different"),
        ('kind = "detect"', MINI, "y", "yes"),
        ('kind = "detect"', MINI, "NO", "no"),
        (RATED, MINI, "5", "5"),
        (RATED + 'labels = ["smooth", "rough"]', MINI, "Rough", "5"),
        ('kind = "magnitude"', MINI, "12,50", "12.5"),
        ('kind = "free"', MINI, " like sand; dry ", "like sand; dry"),
    ],
)
def test_an_answer_is_kept_in_one_spelling(question, toml, line, kept):
    assert read(question, line, toml) == kept


@pytest.mark.parametrize(
    ("question", "toml", "line", "said"),
    [
        ('kind = "which"', COMPARED, "3", "'3' is neither; type 1 for the first"),
        ('kind = "same-different"', COMPARED, "1", "'1' is not an answer; type different or same"),
        ('kind = "detect"', MINI, "maybe", "'maybe' is not an answer; type yes or no"),
        ('kind = "detect"', MINI, "", "nothing was typed; type yes or no"),
        (RATED, MINI, "6", "'6' is not an answer; type a whole number, 1 to 5"),
        (RATED, MINI, "2.5", "'2.5' is not an answer; type a whole number, 1 to 5"),
        ('kind = "magnitude"', MINI, "0", "'0' is not an answer; type a number above 0"),
        ('kind = "magnitude"', MINI, "nan", "'nan' is not an answer; type a number above 0"),
        ('kind = "free"', MINI, " ", "nothing was typed that can be kept"),
    ],
)
def test_what_is_no_answer_is_said_in_a_sentence(question, toml, line, said):
    with pytest.raises(ValueError, match="^" + said.replace("?", r"\?")):
        read(question, line, toml)


def test_a_confidence_may_stand_after_a_semicolon():
    sure = "\nconfidence = { least = 1, most = 4 }"
    detect = protocol('kind = "detect"' + sure)
    assert read_line(detect, first(detect), "yes; 4") == ("yes", 4)
    assert read_line(detect, first(detect), "yes") == ("yes", None)
    with pytest.raises(ValueError, match="'5' is not an answer; type a whole number, 1 to 4"):
        read_line(detect, first(detect), "yes; 5")
    free = protocol('kind = "free"' + sure)
    assert read_line(free, first(free), "soft; dry") == ("soft; dry", None)
    assert read_line(free, first(free), "soft; dry; 2") == ("soft; dry", 2)


def test_detection_is_scored_by_what_there_was():
    of = protocol('kind = "detect"', more=BLANK)
    scored = {
        (trial.condition, answer): of.asks.outcome(trial, answer)
        for trial in make_plan(of, "P1", 1).trials
        if trial.presented != "⠀"
        for answer in ("yes", "no")
    }
    assert scored == {
        ("full", "yes"): "hit", ("full", "no"): "miss",
        ("blank", "yes"): "false alarm", ("blank", "no"): "correct rejection",
    }  # fmt: skip
    blank = [t for t in make_plan(of, "P1", 1).trials if t.presented == "⠀"]
    assert {of.asks.outcome(trial, "yes") for trial in blank} == {"false alarm"}


def test_same_or_different_is_scored_by_whether_they_differ():
    of = protocol('kind = "same-different"', COMPARED + "same = 1\n")
    scored = {
        (len({s.value for s in trial.stimuli}), answer): of.asks.outcome(trial, answer)
        for trial in make_plan(of, "P1", 1).trials
        for answer in ("same", "different")
    }
    assert scored == {
        (2, "different"): "hit", (2, "same"): "miss",
        (1, "different"): "false alarm", (1, "same"): "correct rejection",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("more", "wins"),
    [('right = "more"', 2.0), ('right = "less"', 1.0), ('right = "nearest"\nreference = 1.8', 2.0)],
)
def test_one_of_two_is_right_by_its_value(more, wins):
    of = protocol('kind = "which"\n' + more, COMPARED)
    for trial in make_plan(of, "P1", 1).trials:
        for place, stimulus in enumerate(trial.stimuli, 1):
            told = "right" if stimulus.value == wins else "wrong"
            assert of.asks.outcome(trial, str(place)) == told


def test_without_a_right_one_a_choice_is_not_scored():
    of = protocol('kind = "which"', COMPARED)
    assert of.asks.outcome(first(of), "1") == ""


@pytest.mark.parametrize(
    ("question", "toml", "said"),
    [
        ('kind = "which"', MINI, "kind is 'which', which is asked of two stimuli"),
        ('kind = "detect"', COMPARED, "kind is 'detect', which is asked of one stimulus"),
        ('kind = "rating"\nscale = "r"\nleast = 7\nmost = 1', MINI, "the scale is read backwards"),
        (RATED + 'labels = ["a", "b", "c"]', MINI, "labels are 3; give 2 for the ends"),
        (RATED + 'labels = ["a", "A"]', MINI, "labels have 'A' twice"),
        (RATED + 'labels = ["1", "b"]', MINI, "labels have '1', which is a number"),
        ('kind = "detect"\nconfidence = {}', MINI, "lacks least; add it"),
        ('kind = "detect"\nconfidence = {least = 4, most = 1}', MINI, "read backwards"),
        ('kind = "magnitude"\nmodulus = 0', MINI, "modulus is 0; it must be a number above 0"),
        ('kind = "which"\nright = "nearest"', COMPARED, "go together; give both"),
        ('kind = "what"', MINI, "kind is 'what'"),
    ],
)
def test_what_cannot_be_asked_is_refused_in_a_sentence(question, toml, said):
    with pytest.raises(InputError, match=r"^p\.toml line ") as refused:
        protocol(question, toml)
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


def test_pairs_of_equal_values_are_for_same_or_different_alone():
    with pytest.raises(InputError, match="same is of"):
        parse_protocol(COMPARED + "same = 1\n", "p.toml")


def test_of_a_standard_and_its_equal_none_can_be_chosen():
    """Analysis knows the answer by its value, which both would have."""
    design = COMPARED + 'form = "standard"\nreference = 1.0\n'
    with pytest.raises(InputError, match="reference is 1, which is one of values"):
        protocol('kind = "which"', design)
    assert protocol('kind = "magnitude"', design).trials


def test_a_procedure_needs_answers_that_it_can_go_by():
    stairs = (
        '[procedure]\nkind = "staircase"\nparameter = "contrast"\nleast = 0.1\nmost = 1.0\n'
        "start = [0.9]\nsteps = [0.1]\n"
    )
    assert protocol('kind = "detect"', more=stairs).adaptive
    with pytest.raises(InputError, match="whose answers cannot choose what is shown next"):
        protocol('kind = "magnitude"', more=stairs)


@pytest.mark.parametrize("end", ["button:0", "button:9", "button:x", "key:shift", "key:ab", ""])
def test_a_key_that_there_is_not_is_refused(end):
    with pytest.raises(InputError, match="it must be 'button:1' to 'button:8', 'key:enter'"):
        parse_protocol(f'{MINI}[trial]\nend = "{end}"\n', "p.toml")


def test_on_paper_no_key_of_a_device_ends_reading():
    paper = MINI.replace('model = "vbd"', 'model = "vbd"\nmedium = "paper"')
    with pytest.raises(InputError, match="end is of a device"):
        parse_protocol(f'{paper}[trial]\nend = "button:1"\n', "p.toml")


def test_without_the_table_it_is_as_it_was():
    assert parse_protocol(MINI, "p.toml").asks.name == "identify"
    assert parse_protocol(COMPARED, "p.toml").asks.name == "which"
    asked = make_plan(protocol('kind = "identify"'), "P1", 1)
    assert asked == make_plan(parse_protocol(MINI, "p.toml"), "P1", 1)


def test_shipped_protocols_have_what_their_question_needs():
    of = load_protocol("detection")
    told = [of.asks.has_signal(trial) for trial in make_plan(of, "P1", 1).trials]
    assert (told.count(False), len(told)) == (12, 48)
    of = load_protocol("same-different")
    told = [of.asks.has_signal(trial) for trial in make_plan(of, "P1", 1).trials]
    assert (told.count(False), len(told)) == (36, 72)


def test_a_texture_without_cycles_is_not_compared_by_them():
    cycles = COMPARED.replace("dot_width_mm", "texture_cycles").replace("1.0, 2.0", "3, 5")
    said = "the texture of the VBD has a fixed wavelength, so that nothing would vary"
    with pytest.raises(InputError, match=said):
        parse_protocol(cycles, "p.toml")
    assert parse_protocol(cycles.replace("vbd", "stress2"), "p.toml").parameter == "texture_cycles"


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ('[order]\nkind = "williams"\n', "there is one condition, so that nothing can be ordered"),
        (
            '[procedure]\nkind = "staircase"\nparameter = "line_pitch_mm"\nleast = 8\nmost = 12\n'
            "start = [9]\nsteps = [1]\n",
            "'line_pitch_mm', which no actuator shows in a line of its own",
        ),
        (
            '[procedure]\nkind = "staircase"\nparameter = "contrast"\nleast = 0.1\nmost = 1\n'
            "start = [0.9, 0.5]\nsteps = [0.1]\nright = 3\nwrong = 3\n",
            "start is of 2 staircases, and a condition has 4 trials: one of them cannot move",
        ),
    ],
)
def test_what_could_not_vary_is_refused(more, said):
    with pytest.raises(InputError, match=said):
        parse_protocol(MINI + more, "p.toml")
