"""Trials chosen by the answers: the deck, its conditions, when enough was asked; bad tables."""

import pytest

from tests.sessions.planning.test_bad_protocols import PAIRS, STRINGS, VBD_HEAD, parse, refuse
from vbraille.errors import InputError
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.nexttrial import (
    Answered,
    ByAnswers,
    FixedOrder,
    describe,
    procedure_of,
)

WIDTHS = (
    '[design]\nkind = "choice"\nparameter = "dot_width_mm"\nvalues = [0.5, 3.0]\nstring = "a"\n'
    "repeats = 15\n"
)
TWO = '[[conditions]]\nname = "smooth"\ntexture = 0.0\n[[conditions]]\nname = "rough"\n'
QUEST = '[procedure]\nkind = "quest"\nspread = [0.1, 0.3]\n'
STEP = f"{QUEST}step = 0.1\n"
OF_CONTRAST = 'parameter = "contrast"\nleast = 0.1\nmost = 1.0\n'
STAIRS = f'[procedure]\nkind = "staircase"\n{OF_CONTRAST}start = [0.9]\nsteps = [0.1]\n'


def made(text, seed=1):
    protocol = parse(VBD_HEAD + text)
    return procedure_of(protocol, make_plan(protocol, "P1", seed))


def nearer_to(liked):
    """Answers of a participant who never errs."""

    def answer(trial):
        first, second = (abs(stimulus.value - liked) for stimulus in trial.stimuli)
        return "1" if first < second else "2"

    return answer


def through(procedure, answer, each_s=4.0):
    """All trials that are asked, with their answers."""
    history = []
    while (trial := procedure.next(history)) is not None:
        assert trial.number == len(history) + 1
        history.append(Answered(trial, answer(trial), each_s * trial.number))
    return history


def test_a_plan_is_followed_without_a_procedure():
    assert isinstance(made(WIDTHS), FixedOrder)
    assert made(WIDTHS).found([]) == ()


def test_it_finds_what_is_liked_and_keeps_the_order_of_the_plan():
    procedure = made(WIDTHS + STEP + "furthest = 0.8\n")
    history = through(procedure, nearer_to(1.83))
    assert len(history) == 30
    for planned, past in zip(procedure.plan.trials, history, strict=True):
        low_first = [t.stimuli[0].value < t.stimuli[1].value for t in (planned, past.trial)]
        assert low_first[0] == low_first[1]
        values = [stimulus.value for stimulus in past.trial.stimuli]
        assert abs(values[0] - values[1]) <= 0.8 + 1e-9
        assert [s.geometry.dot_width_mm for s in past.trial.stimuli] == values
    liked, interval = procedure.found(history)
    assert float(liked.removeprefix("preferred dot width: ").removesuffix(" mm")) == pytest.approx(
        1.83, abs=0.06
    )
    assert interval.startswith("95 % interval: 1.")


def test_the_history_alone_decides_whatever_was_asked_before():
    procedure = made(WIDTHS + STEP)
    history = through(procedure, nearer_to(2.2))
    for count in (17, 3, 29, 0):
        assert procedure.next(history[:count]) == history[count].trial
        assert made(WIDTHS + STEP).next(history[:count]) == history[count].trial


@pytest.mark.parametrize(
    ("stop", "asked"),
    [("trials = 12", 12), ("seconds = 20", 5), ("width = 0.2\nat_least = 6", range(6, 29)),
     ("sd = 0.1", range(10, 29)), ("sd = 2.0\nat_least = 4", 4)],
)  # fmt: skip
def test_when_enough_was_asked(stop, asked):
    history = through(made(f"{WIDTHS}{STEP}{stop}\n"), nearer_to(1.5))
    assert len(history) in ([asked] if isinstance(asked, int) else asked)


def test_conditions_have_their_own_answers_and_ends():
    procedure = made(f"{TWO}{WIDTHS.replace('15', '6')}{STEP}sd = 0.12\nat_least = 4\n")
    likes = {"smooth": nearer_to(1.0), "rough": nearer_to(2.5)}
    history = through(procedure, lambda trial: likes[trial.condition](trial))
    asked = [past.trial.condition for past in history]
    assert all(4 <= asked.count(name) < 12 for name in likes)
    said = procedure.found(history)
    assert [said[0], said[3]] == ["condition: smooth", "condition: rough"]
    found = [float(line.split()[3]) for line in (said[1], said[4])]
    assert found == pytest.approx([1.0, 2.5], abs=0.2)
    over = procedure.asked(history)["smooth"]
    table = procedure.protocol.procedure
    assert table.next(over, procedure.protocol.design) is None
    assert table.next(over[:-1], procedure.protocol.design) is not None


def test_strings_are_those_of_the_plan_with_the_chosen_contrast():
    for table in (STAIRS, f"{STEP}{OF_CONTRAST}", f'{STEP}{OF_CONTRAST}harder = "more"\n'):
        procedure = made(PAIRS + "repeats = 4\n" + table)
        history = through(procedure, lambda trial: trial.presented)
        assert isinstance(procedure, ByAnswers)
        assert [p.trial.presented for p in history] == [t.presented for t in procedure.plan.trials]
        contrasts = [past.trial.stimuli[0].tuning.contrast for past in history]
        assert len(set(contrasts)) > 2
        assert all(0.1 <= contrast <= 1.0 for contrast in contrasts)
        assert procedure.found(history)[0].startswith("threshold contrast: ")
        easy = contrasts[-1] < contrasts[0]
        assert easy == ("more" not in table)


def test_most_trials_and_what_a_plan_says():
    protocol = parse(f"{VBD_HEAD}{TWO}{WIDTHS}{STEP}trials = 8\n")
    assert protocol.trials == made(f"{TWO}{WIDTHS}{STEP}trials = 8\n").most == 16
    says = "quest, dot width by the answers, 26 values from 0.5 to 3 mm"
    assert describe(protocol) == says
    stairs = parse(f"{VBD_HEAD}{PAIRS}{STAIRS}")
    assert describe(stairs) == "staircase, contrast by the answers, from 0.1 to 1"


BAD = [
    (WIDTHS + '[procedure]\nkind = "qest"', "[procedure] kind is 'qest'; the nearest is quest…"),
    (WIDTHS + "[procedure]\nkind = 'quest'", "[procedure] lacks spread; add it"),
    (f"{WIDTHS}{STEP}{OF_CONTRAST}", "[procedure] parameter, least and most are those of…out"),
    (WIDTHS + STEP.replace("0.1\n", "0.3\n"), "[procedure] step is 0.3, and steps of it…does"),
    (WIDTHS + STEP.replace("0.1\n", "9\n"), "[procedure] step is 9; it must be above 0…"),
    (f"{WIDTHS}{STEP}furthest = 0.01", "[procedure] furthest is 0.01, and no two…larger"),
    (f"{WIDTHS}{STEP}sd = 0", "[procedure] sd is 0; it must be above 0"),
    (f"{WIDTHS}{STEP}lapse = [0.1, 0.1]", "[procedure] lapse has values that do not…them"),
    (f"{WIDTHS}{STEP}start = [1]", "[procedure] start is of kind = 'staircase'; leave it out…"),
    (f"{WIDTHS}{STEP}[rules]\nnever_twice_running = true", "[rules] never_twice_running is of…"),
    (f"{WIDTHS}{STAIRS}", "[procedure] kind is 'staircase', which needs right answers…'quest'"),
    (f"{STRINGS}{STEP}", "[procedure] lacks parameter; add it"),
    (f"{STRINGS}{QUEST}{OF_CONTRAST}", "[procedure] lacks step; add it"),
    (f"{STRINGS}{STEP}{OF_CONTRAST}furthest = 1", "[procedure] furthest is of kind = 'choice'…"),
    (f"{STRINGS}{STAIRS}".replace("most = 1.0", "most = 0.1"), "…nothing can move between…larger"),
    (f"{STRINGS}{STAIRS}".replace("steps = [0.1]", "steps = [0]"), "…the staircase cannot move…"),
    (f"{STRINGS}{STAIRS}".replace("steps = [0.1]", "steps = [2]"), "…only stand at its ends…"),
    (f"{STRINGS}{STAIRS}right = 9\nwrong = 9", "…has 2 trials: the staircase cannot move…"),
    (f"{STRINGS}{STAIRS}target = 0.75", "[procedure] target is of staircases with right = 1…"),
    (f"{TWO}{STRINGS}{STEP}{OF_CONTRAST}".replace("contrast", "texture"),
     "[procedure] parameter is 'texture', which the condition smooth sets itself…"),
    (f'{PAIRS}{STEP}{OF_CONTRAST}[question]\nkind = "detect"',
     "[procedure] guess is 0, and…0.4]"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "says"), BAD)
def test_what_cannot_be_used_is_said(text, says):
    beginning, _, end = says.partition("…")
    with pytest.raises(InputError, match=r"^mine\.toml( line \d+)?: ") as refused:
        parse(VBD_HEAD + text)
    said = str(refused.value).split(": ", 1)[1]
    assert said.startswith(beginning)
    assert all(part in said for part in end.split("…"))


def test_what_is_detected_may_be_guessed():
    text = f"{VBD_HEAD}{PAIRS}{STEP}{OF_CONTRAST}guess = [0.01, 0.2]\n"
    protocol = parse(f'{text}[question]\nkind = "detect"\n')
    assert protocol.procedure.quest(protocol.design).axes[2].values == (0.01, 0.2)


def test_what_the_procedure_chooses_is_no_option():
    protocol = parse(f"{VBD_HEAD}{PAIRS}{STEP}{OF_CONTRAST}")
    assert make_plan(protocol, "P1", 1, texture=0.5).trials[0].stimuli[0].tuning.texture == 0.5
    says = "^the procedure of mine chooses contrast; leave ‹contrast› out$"
    with pytest.raises(InputError, match=says):
        make_plan(protocol, "P1", 1, contrast=0.5)


def test_paper_cannot_vary():
    refuse(
        f'{VBD_HEAD}medium = "paper"\n{STRINGS}{STEP}{OF_CONTRAST}', 10,
        ": [procedure] varies what a device shows; with medium = 'paper' leave it out",
    )  # fmt: skip
