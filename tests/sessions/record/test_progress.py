"""How far a session has come, after each of its events."""

import pytest

from tests.sessions.planning.test_protocols import load
from tests.sessions.sittings import MINI, WIDTHS
from vbraille.sessions.planning.plan import make_plan
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.record import Event


class Story:
    """A session of which events are told one by one."""

    def __init__(self, folder, text):
        protocol = load(folder, text)
        self.progress = Progress(protocol, make_plan(protocol, "P01", 1))
        self.events = []

    def tell(self, kind, trial=None, attempt=1, **data):
        where = (None, None, None) if trial is None else (*map(int, trial.key), attempt)
        event = Event(len(self.events) + 1, kind, float(len(self.events)), "", *where, data)
        self.events.append(event)
        self.progress.take(event)

    def show(self, trial, parameter="contrast"):
        for number, stimulus in enumerate(trial.stimuli):
            value = stimulus.value
            value = getattr(stimulus.look, parameter) if value is None else value
            self.tell("cue", trial, stimulus=number, line=len(self.events), value=value)

    def answer(self, right=True):
        """Show the next trial, and answer it."""
        trial = self.progress.next_trial
        self.show(trial)
        wanted = self.progress.protocol.asks.right_answer(trial)
        self.tell("answer", trial, answer=wanted if right else "?" * len(wanted))
        return trial

    @property
    def again(self):
        """What a session that is resumed with these events knows."""
        return Progress(self.progress.protocol, self.progress.plan, self.events)


def test_questions_are_due_in_their_place(tmp_path):
    items = "".join(
        f'[[questionnaire]]\nkind = "text"\nname = "at_{when}"\nwhen = "{when}"\nask = "?"\n'
        for when in ("begin", "trial", "block", "end")
    )
    story = Story(tmp_path, MINI.replace("[design]", "[design]\nblocks = 2") + items)
    asked = []
    while True:
        if (item := story.progress.next_item) is not None:
            asked.append((item[0].name, item[1]))
            story.tell("reply", name=item[0].name, number=item[1], reply="x")
        elif story.progress.next_trial is None:
            break
        else:
            story.answer()
    assert (asked[0], asked[-1]) == (("at_begin", 0), ("at_end", 0))
    assert [n for name, n in asked if name == "at_trial"] == [1, 2, 3]
    assert [n for name, n in asked if name == "at_block"] == [1, 2]
    newest = story.progress.newest_given
    story.tell("undo", name=newest.data["name"], number=newest.data["number"])
    assert story.progress.next_item[0].name == "at_end"


CONTRAST = 'parameter = "contrast"\nleast = 0.0\nmost = 1.0\n'
QUEST = f'[procedure]\nkind = "quest"\n{CONTRAST}step = 0.1\nspread = [0.1, 0.2]\ntrials = 8\n'
STAIRCASE = f'[procedure]\nkind = "staircase"\n{CONTRAST}start = [0.5, 0.9]\nsteps = [0.2, 0.1]\n'
PREFERRED = '[procedure]\nkind = "quest"\nstep = 0.25\nspread = [0.1, 0.3]\n'


@pytest.mark.parametrize(("table", "trials"), [(QUEST, 8), (STAIRCASE, 15)])
def test_what_the_answers_choose_is_chosen_again_after_a_resume(table, trials, tmp_path):
    story, levels = Story(tmp_path, f"{MINI}repeats = 5\n{table}"), []
    while (trial := story.progress.next_trial) is not None:
        assert trial == story.again.next_trial
        levels.append(trial.stimuli[0].look.contrast)
        story.show(trial)
        story.tell("answer", trial, answer=trial.cells if levels[-1] > 0.35 else "??")
    assert len(levels) == trials
    assert len(set(levels)) > 2
    assert story.progress.found


def test_two_values_are_chosen_of_which_one_is_preferred(tmp_path):
    story = Story(tmp_path, f"{WIDTHS}repeats = 5\n{PREFERRED}")
    while (trial := story.progress.next_trial) is not None:
        assert trial == story.again.next_trial
        story.show(trial)
        nearest = min(trial.values, key=lambda value: abs(value - 1.25))
        story.tell("answer", trial, answer=str(trial.values.index(nearest) + 1))
    assert story.progress.found[0].split()[1].startswith("1.2")
    first = story.progress.plan.trials[0]
    told = [e.data["value"] for e in story.events if e.key == first.key and e.kind == "cue"]
    assert story.again.shown(first).values == told
