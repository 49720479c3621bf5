"""What was asked, and what decided which trial came next, in sentences on methods."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

from vbraille.sessions.planning.chance import balanced_orders
from vbraille.sessions.planning.choosing import varied
from vbraille.sessions.planning.procedures import (
    FixedProcedure,
    QuestProcedure,
    StaircaseProcedure,
)
from vbraille.sessions.planning.questions import (
    DetectQuestion,
    FreeQuestion,
    MagnitudeQuestion,
    RatingQuestion,
    SameQuestion,
    WhichQuestion,
)
from vbraille.sessions.planning.stimuli import KNOBS
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from vbraille.adaptive.stopping import StopRule
    from vbraille.sessions.planning.protocol import Protocol

_LOOKED_FOR = ("hit", "miss")


def of_all(number: int, rows: Sequence[Any], noun: str, of_the: str = "") -> str:
    """Words for a number of things out of all.

    >>> of_all(2, [0, 0, 0], "trial"), of_all(3, [0, 0, 0], "trial", "of the ")
    ('2 of 3 trials', 'all 3 of the trials')
    >>> of_all(1, [0], "trial"), of_all(0, [0], "trial")
    ('the only trial', '0 of 1 trial')
    """
    if number == len(rows) == 1:
        return f"the only {noun}"
    part = f"all {number}" if number == len(rows) else f"{number} of {len(rows)}"
    return f"{part} {of_the}{noun}{'s' * (len(rows) != 1)}"


def asked(protocol: Protocol, rows: Sequence[dict[str, Any]]) -> Iterable[str]:
    """Sentences on the question, for trials that have an answer."""
    if not rows:
        return
    question, looked_for = protocol.asks, sum(row["outcome"] in _LOOKED_FOR for row in rows)
    if question.ask:
        yield f"They were asked: “{question.ask}”"
    match question:
        case WhichQuestion():
            yield f"Of each pair one was chosen{_right(protocol, question)}"
        case SameQuestion():
            yield (
                "Of each pair it was said whether the two were the same or different; "
                f"{of_all(looked_for, rows, 'pair')} differed"
            )
        case DetectQuestion():
            yield (
                "It was said whether there was anything; there was something in "
                f"{of_all(looked_for, rows, 'trial')}"
            )
        case RatingQuestion():
            ends = f"from {_step(question, question.least)} to {_step(question, question.most)}"
            yield f"They rated {question.scale} in whole numbers, {ends}"
        case MagnitudeQuestion():
            standard = (
                "everybody chose their own standard"
                if question.modulus is None
                else f"the standard was {question.modulus:g}"
            )
            yield f"They estimated a magnitude, as a number above 0; {standard}"
        case FreeQuestion():
            yield "They answered in words of their own, which were not scored"
        case _:
            pass
    sure = sum(row["confidence"] != "" for row in rows)
    if question.confidence is not None and sure:
        scale = question.confidence
        yield (
            f"After {of_all(sure, rows, 'answer')} they said how sure they were, from "
            f"{scale.least} to {scale.most}"
        )


def _right(protocol: Protocol, question: WhichQuestion) -> str:
    """Clause that says which one of two was right."""
    if question.right is None:
        return ", and neither was right or wrong"
    knob = KNOBS[protocol.parameter or "contrast"]
    if question.right == "nearest":
        return f"; the one nearest to {question.reference:g}{knob.unit} was right"
    return f"; the one with {question.right} {knob.words} was right"


def _step(question: RatingQuestion, step: int) -> str:
    label = question.named.get(step)
    return f"{step}" if label is None else f"{step} ({label})"


def caught(rows: Sequence[dict[str, Any]]) -> Iterable[str]:
    """Sentence on trials that kept watch over the participant."""
    if not rows:
        return
    kinds = Counter(row["catch"] for row in rows)
    shown = {"blank": "no dots", "repeat": "what the trial before them had shown"}
    told = " and ".join(
        f"{count(number, 'catch trial')} that showed {shown[kind]}"
        for kind, number in sorted(kinds.items())
    )
    right = sum(row["correct"] == 1 for row in rows)
    scored = any(row["correct"] != "" for row in rows)
    part = f"all {right}" if right == len(rows) else f"{right} of {len(rows)}"
    were = f"{part} were" if len(rows) > 1 else "it was" if right else "it was not"
    how = f"; {were} answered right" if scored else ""
    yield f"Beside these there were {told}{how}"


def ended(rows: Sequence[dict[str, Any]]) -> Iterable[str]:
    """Sentence on the participant's own key."""
    keys = Counter(row["ended_by"] for row in rows if row["ended_by"])
    if not keys:
        return
    answered = keys.pop("answer", 0)
    told = [
        f"{name.replace(':', ' ')} in {of_all(number, rows, 'trial')}"
        for name, number in sorted(keys.items())
    ]
    told += [f"their answer in {of_all(answered, rows, 'trial')}"] if answered else []
    yield f"Reading was ended by {', by '.join(told)}; response times are to there"


def ordered(protocol: Protocol, heads: Sequence[dict[str, Any]]) -> str:
    """Clause that says in which order the blocks of conditions came."""
    if protocol.order_rows:
        return "in the order that a table gives each participant"
    if protocol.balanced:
        number = len(balanced_orders(len(protocol.conditions)))
        used = ", ".join(map(str, sorted({head["order"] for head in heads})))
        return f"balanced by Williams squares (of {count(number, 'order')}: {used})"
    return "in random order" if protocol.block_order == "shuffled" else "always in the same order"


def ruled(protocol: Protocol) -> Iterable[str]:
    """Sentence on the rules that the order of trials kept."""
    rules, told = protocol.rules, []
    if protocol.adaptive:
        return
    if rules.never_twice_running:
        told.append("no two neighbouring trials showed the same")
    for name, most in rules.at_most_running.items():
        told.append(f"at most {count(most, 'neighbouring trial')} had the same {name}")
    if rules.balanced_quarters:
        told.append("each quarter had its share of each condition")
    if told:
        said = "; ".join(told)
        yield said[0].upper() + said[1:]


def procedure(protocol: Protocol) -> Iterable[str]:
    """Sentences on how the answers chose what was shown."""
    table = protocol.procedure
    if not protocol.adaptive:
        return
    knob = KNOBS[varied(protocol)]
    values = table.values(protocol.design)
    ends = f"{values[0]:g} to {values[-1]:g}{knob.unit}"
    if isinstance(table, QuestProcedure):
        yield (
            f"The {knob.words} of each trial was chosen by the answers before it, by QUEST+ "
            f"(Watson 2017) from {len(values)} values, {ends}"
        )
    elif isinstance(table, StaircaseProcedure):
        yield (
            f"The {knob.words} of each trial was chosen by the answers before it, by "
            f"{_staircases(table, knob.unit)}, within {ends}"
        )
        good, bad = ("“yes”", "“no”") if protocol.asks.name == "detect" else ("right", "wrong")
        yield (
            f"It was made harder after {count(table.right, f'{good} answer')} running, and easier "
            f"after {count(table.wrong, f'{bad} answer')}"
        )
    stop = [] if isinstance(table, FixedProcedure) else [*_stops(table.stop, knob.unit)]
    if isinstance(table, StaircaseProcedure) and table.reversals is not None:
        stop.append(f"{count(table.reversals, 'reversal')} of each staircase")
    if stop:
        yield f"A condition was to end by {', or by '.join(stop)}"


def _staircases(table: StaircaseProcedure, unit: str) -> str:
    starts = ", ".join(f"{start:g}" for start in table.start)
    steps = ", then ".join(f"{step:g}" for step in table.steps)
    weighted = "" if table.target is None else f", weighted for {100 * table.target:g} %"
    many = "interleaved staircases" if len(table.start) > 1 else "staircase"
    return (
        f"{len(table.start)} {many}{weighted}, which began at {starts}{unit} with steps of "
        f"{steps}{unit}"
    )


def _stops(stop: StopRule, unit: str) -> Iterable[str]:
    """What ended the questions of a condition."""
    if stop.trials is not None:
        yield count(stop.trials, "trial")
    after = f" (after {count(stop.at_least, 'trial')} or more)"
    if stop.sd is not None:
        yield f"a standard deviation of the estimate of {stop.sd:g}{unit}{after}"
    if stop.width is not None:
        yield f"an interval of 95 % that was {stop.width:g}{unit} wide{after}"
    if stop.seconds is not None:
        yield f"{stop.seconds:g} s of the session"
