"""The rules of plans, counted anew: nothing here is the program's own check."""

from itertools import pairwise

from vbraille.sessions.planning.making import make_plan


def broken_rules(protocol, participant, seed):
    """Rules that a plan breaks, by name; none of them should be."""
    plan = make_plan(protocol, participant, seed)
    practised, tested = (
        [_shows(protocol, t) for t in run if not t.catch] for run in (plan.practice, plan.trials)
    )
    problems = []
    runs = [practised, tested]
    if protocol.adaptive and protocol.task == "choice":
        runs.pop()  # the answers choose the values; the plan says which of two comes first
    if any(one == other for run in runs for one, other in pairwise(run)):
        problems.append("twice running")
    if set(practised) & set(tested):
        problems.append("practice of what is tested")
    if (len(practised), len(plan.trials)) != (protocol.practice.trials, protocol.trials):
        problems.append("trials missing")
    others = [trial for trial in plan.trials if not trial.catch]
    for condition in protocol.conditions:
        of = [
            shows
            for shows, trial in zip(tested, others, strict=True)
            if trial.condition == condition.name
        ]
        if len({of.count(shows) for shows in of}) != 1 or len(of) != protocol.design.trials:
            problems.append("not equally often")
    return problems


def _shows(protocol, trial):
    """Braille asked for, in any order if it is reordered; or the values compared."""
    if protocol.task == "choice":
        return tuple(stimulus.value for stimulus in trial.stimuli)
    reorders = getattr(protocol.design, "reorder", False)
    return "".join(sorted(trial.presented)) if reorders else trial.presented
