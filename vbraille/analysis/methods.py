"""What was done, in a paragraph: made of what sessions recorded, and of nothing else.

Every number is counted in the sessions' records, or stands in them. What a session's protocol had
planned is not told, if it was not done.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

from vbraille.analysis.input.trials import natural
from vbraille.braille.spelling import to_braille
from vbraille.render.braille.models import MODELS
from vbraille.sessions.planning.chance import balanced_orders
from vbraille.sessions.planning.choosing import varied
from vbraille.sessions.planning.factors import within
from vbraille.sessions.planning.procedures import FixedProcedure, QuestProcedure, StaircaseProcedure
from vbraille.sessions.planning.questions import of_all
from vbraille.sessions.planning.stimuli import GAP, KNOBS
from vbraille.version import __version__
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from vbraille.adaptive.staircase import StopRule
    from vbraille.analysis.input.sittings import SessionTrials
    from vbraille.analysis.input.study import Study
    from vbraille.analysis.input.trials import LeftOut
    from vbraille.sessions.planning.protocol import Protocol

_DISTANCES = {
    "dot_width_mm": "dots {} mm wide",
    "dot_spacing_mm": "dot columns {} mm apart",
    "cell_gap_mm": "{} mm from a cell's last dot column to the next cell's first",
}
# Looks that follow from another one that two stimuli are compared by.
_BY = {"dot_spacing_mm": (GAP,)}
# What conditions and groups may differ in: columns of rows, and their words.
_ALWAYS = ("texture", "contrast")
_LOOKS = {
    **{name: KNOBS[name].words for name in KNOBS if name != GAP},
    "mapping": "mapping",
    "table": "table",
}


def methods(study: Study) -> str:
    """Paragraph on the sessions of a study; empty if it has none, but tables alone.

    Examples
    --------
    A paragraph begins so: "2 participants read 78 strings of 5 cells each, in 2 sessions of the
    protocol letters (Identification of letters; Lévesque 2009, 4.3)."
    """
    of: dict[str, list[SessionTrials]] = {}
    for sitting in study.sittings:
        of.setdefault(sitting.protocol.text, []).append(sitting)
    sentences = [sentence for sittings in of.values() for sentence in _told(sittings)]
    if not sentences:
        return ""
    sentences += [*_left_out(study.left_out), *_versions(study.sittings)]
    return " ".join(f"{sentence}." for sentence in sentences)


def _told(sittings: Sequence[SessionTrials]) -> Iterable[str]:
    """Sentences on the sessions of one protocol."""
    protocol = sittings[0].protocol
    answered = [_answered(sitting) for sitting in sittings]
    rows = [row for part in answered for row in part]
    # Blank trials are what detection needs, and keep no watch there.
    watches = protocol.asks.name != "detect" and protocol.design.catch is not None
    tested = [[row for row in part if not (watches and row["catch"])] for part in answered]
    kept = [row for part in tested for row in part]
    yield _who(sittings, tested)
    yield from _by_whom(rows)
    yield from asked(protocol, kept)
    yield from caught([row for row in rows if watches and row["catch"]])
    yield _display(sittings, rows)
    yield from _elsewhere(rows)
    yield from _texts(sittings, rows)
    yield from _groups(sittings)
    yield from _factors(protocol, rows)
    yield from _conditions(tested)
    yield from _order(sittings, answered)
    yield from ended(rows)
    practised = [sitting.counts["practice"] for sitting in sittings]
    with_feedback = "" if protocol.practice.feedback else ", without feedback"
    yield (
        f"Before them came {_span(practised, 'trial')} of practice{with_feedback}"
        if any(practised)
        else "There was no practice"
    )
    breaks = [sitting.counts["break"] for sitting in sittings]
    yield f"A session had {_span(breaks, 'break')}" if any(breaks) else "There were no breaks"
    yield from _troubles(sittings, rows)


def _answered(sitting: SessionTrials) -> list[dict[str, Any]]:
    return [row for row in sitting.rows if row["answered"] != ""]


def _who(sittings: Sequence[SessionTrials], tested: Sequence[Sequence[dict]]) -> str:
    """Who read how much of what."""
    protocol = sittings[0].protocol
    people = len({sitting.head["participant"] for sitting in sittings})
    rows = [row for part in tested for row in part]
    numbers = [len(part) for part in tested]
    if not rows:
        what = "answered no trial"
    elif protocol.parameter is not None:
        knob = KNOBS[protocol.parameter]
        values = {float(value) for row in rows for value in row["presented"].split()}
        what = (
            f"compared {_span(numbers, 'pair')} of {len(values)} values of the {knob.words}, "
            f"{min(values):g} to {max(values):g}{knob.unit}"
        )
    else:
        cells = _span([len(row["presented"]) for row in rows], "cell")
        each = " each" if max(numbers) > 1 else ""
        verb = "read" if protocol.asks.name == "identify" else "felt"
        what = f"{verb} {_span(numbers, 'string')} of {cells}{each}"
    often = f"in {count(len(sittings), 'session')}"
    simulated = {row["answers_from"].partition(":")[0] for row in rows} == {"simulated"}
    who = count(people, "simulated participant" if simulated else "participant")
    told = f"{protocol.name} ({protocol.title}; {protocol.source})"
    return f"{who} {what}, {often} of the protocol {told}"


def _by_whom(rows: Sequence[dict]) -> Iterable[str]:
    """Where the answers came from, and what moved the array, where that was no person."""
    kinds = Counter(row["answers_from"].partition(":")[0] for row in rows)
    if simulated := kinds.pop("simulated", 0):
        yield f"A simulated reader gave {of_all(simulated, rows, 'answer', 'of the ')}"
    kinds.pop("typed", None)
    if other := sum(kinds.values()):
        told = of_all(other, rows, "answer", "of the ")
        yield f"{told[0].upper()}{told[1:]} came from a program or a file"
    moved = sum(row["moved_by"].startswith("simulated") for row in rows)
    if moved:
        told = of_all(moved, rows, "trial", "of the ")
        yield f"A simulated hand moved the array in {told}"


def _display(sittings: Sequence[SessionTrials], rows: Sequence[dict]) -> str:
    """What was read on, with the distances of the record that were the same for all."""
    protocol = sittings[0].protocol
    if protocol.medium == "paper":
        return "Strings were read on paper, and timed by key"
    parameter = protocol.parameter or ""
    varied = {parameter, *_differing(rows)}
    varied |= {name for name, by in _BY.items() if parameter in by}
    told: list[str] = []
    for head in (sitting.head for sitting in sittings):
        array, geometry = head["array"], head["geometry"]
        lengths = [
            form.format(f"{geometry[name]:g}")
            for name, form in _DISTANCES.items()
            if name not in varied
        ]
        mapping = () if "mapping" in varied else (f"with the mapping {head['mapping']}",)
        model = MODELS[head["model"]].title if head["model"] in MODELS else head["model"]
        device = head["device"].partition(":")[0]
        where = "a simulated device" if device == "sim" else "a device"
        how = ", ".join([f"at {head['rate_hz']:g} frames a second", *mapping, *lengths])
        size = f"{array['rows']} × {array['columns']} actuators"
        told.append(f"the {model} ({size}, {where}) {how}")
    shown = f"They were shown on {'; or on '.join(dict.fromkeys(told))}"
    reference = protocol.conventional.reference
    if reference and any(sitting.counts["stood"] for sitting in sittings):
        shown += f"; {to_braille(reference)} stood on a conventional display, for comparison"
    return shown


def _elsewhere(rows: Sequence[dict]) -> Iterable[str]:
    """Which conditions stood on a conventional display instead."""
    there = {row["condition"] for row in rows if row["shown_on"] == "conventional"}
    if there:
        what = "the condition" if len(there) == 1 else "the conditions"
        yield (
            f"Strings of {what} {', '.join(sorted(there, key=natural))} stood on a conventional "
            f"display instead, and were timed by key"
        )


def _texts(sittings: Sequence[SessionTrials], rows: Sequence[dict]) -> Iterable[str]:
    """Which braille tables made the cells of texts."""
    tables = sorted({row["table"] for row in rows if row.get("table")})
    if tables:
        versions = {sitting.head["versions"].get("liblouis", "unknown") for sitting in sittings}
        yield (
            f"Their cells were made of texts in print by liblouis {', '.join(sorted(versions))}, "
            f"with the {'table' if len(tables) == 1 else 'tables'} {', '.join(tables)}"
        )


def _groups(sittings: Sequence[SessionTrials]) -> Iterable[str]:
    """Groups of participants, and how many were in each."""
    people: dict[str, set[str]] = {}
    for sitting in sittings:
        if group := sitting.head.get("group", ""):
            people.setdefault(group, set()).add(sitting.head["participant"])
    if not people:
        return
    differing = _between(sittings)
    told = []
    for group in sorted(people, key=natural):
        own = [row for s in sittings if s.head.get("group") == group for row in s.rows]
        looks = [_look(name, own) for name in differing]
        told.append(f"{group} ({', '.join([count(len(people[group]), 'participant'), *looks])})")
    many = "1 group" if len(told) == 1 else f"{len(told)} groups"
    yield f"Participants were in {many}: {', '.join(told)}"


def _factors(protocol: Protocol, rows: Sequence[dict]) -> Iterable[str]:
    """What was crossed within participants, as far as it was shown."""
    own = within(protocol.factors)
    if not own or not rows:
        return
    told = []
    possible = 1
    for factor in own:
        shown = {row[f"factor_{factor.name}"] for row in rows}
        levels = [level.name for level in factor.levels if level.name in shown]
        possible *= len(factor.levels)
        told.append(f"{factor.name} ({', '.join(levels)})")
    if len(told) == 1:
        yield f"Within participants varied {told[0]}"
        return
    number = len({row["condition"] for row in rows})
    part = f"all {number}" if number == possible else f"{number} of the {possible}"
    yield f"Within participants varied {' and '.join(told)}, {part} combinations of them"


def _conditions(answered: Sequence[Sequence[dict]]) -> Iterable[str]:
    """Conditions, with what they were shown with and how many trials each had."""
    rows = [row for part in answered for row in part]
    names = list(dict.fromkeys(row["condition"] for row in rows))
    within_people = {name for part in answered for name in _differing(part)}
    told = []
    for name in sorted(names, key=natural):
        own = [row for row in rows if row["condition"] == name]
        looks = [
            _look(knob, own)
            for knob in _LOOKS
            if (knob in _ALWAYS or knob in within_people) and _values(knob, own)
        ]
        each = [sum(row["condition"] == name for row in part) for part in answered]
        told.append(f"{name} ({', '.join([*looks, _span(each, 'trial')])})")
    if len(names) > 1:
        yield f"There were {len(names)} conditions: {', '.join(told)}"
    elif names:
        yield f"All was of one condition: {told[0]}"


def _values(name: str, rows: Sequence[dict]) -> list[Any]:
    """Values that rows have of a look, in order; nothing of pairs that are compared by it."""
    compared = {row["parameter"] for row in rows} & {name, *_BY.get(name, ())}
    given = set() if compared else {row.get(name, "") for row in rows} - {""}
    return sorted({float(value) for value in given} if name in KNOBS else given)


def _differing(rows: Sequence[dict]) -> list[str]:
    """Looks of which rows have several values."""
    return [name for name in _LOOKS if len(_values(name, rows)) > 1]


def _between(sittings: Sequence[SessionTrials]) -> list[str]:
    """Looks that are the same in each session, and differ between sessions."""
    whole = _differing([row for sitting in sittings for row in sitting.rows])
    own = {name for sitting in sittings for name in _differing(sitting.rows)}
    return [name for name in whole if name not in own]


def _look(name: str, rows: Sequence[dict]) -> str:
    """Words for a look of some rows: "texture 0", "dot width 1 to 2 mm"."""
    values = _values(name, rows)
    if name not in KNOBS:
        return f"{_LOOKS[name]} {' and '.join(values)}"
    ends = f"{values[0]:g}" if len(values) == 1 else f"{values[0]:g} to {values[-1]:g}"
    return f"{_LOOKS[name]} {ends}{KNOBS[name].unit}"


def _order(sittings: Sequence[SessionTrials], answered: Sequence[Sequence[dict]]) -> Iterable[str]:
    """In which order trials came, and by which procedure."""
    protocol = sittings[0].protocol
    blocks = _span([len({row["block"] for row in part}) for part in answered], "block")
    seeds = sorted({sitting.head["seed"] for sitting in sittings})
    drawn = f"orders were drawn with {'seed' if len(seeds) == 1 else 'seeds'} "
    drawn += ", ".join(map(str, seeds))
    if len(protocol.conditions) < 2:
        yield f"Trials came in {blocks}; {drawn}"
    elif protocol.design.blocks == "conditions":
        how = ordered(protocol, [sitting.head for sitting in sittings])
        yield f"Each condition had blocks of its own, {blocks} in a session, {how}; {drawn}"
    else:
        yield f"Conditions were mixed in {blocks}; {drawn}"
    yield from ruled(protocol)
    yield from chosen(protocol)


def _troubles(sittings: Sequence[SessionTrials], rows: Sequence[dict]) -> Iterable[str]:
    """What did not go as planned."""
    unanswered = sum(len(sitting.rows) for sitting in sittings) - len(rows)
    if unanswered and not sittings[0].protocol.adaptive:
        yield f"{count(unanswered, 'planned trial')} had no answer"
    if broken := sum(sitting.state != "ended" for sitting in sittings):
        yield f"{count(broken, 'session')} did not come to the end"
    if faults := sum(row["faults"] != "" for row in rows):
        yield f"In {count(faults, 'trial')} the device had a fault"
    if again := sum(int(row["attempt"] or 0) > 1 for row in rows):
        yield f"{count(again, 'trial')} had to be shown again"
    if early := sum(row["early"] == 1 for row in rows):
        yield f"{count(early, 'answer')} came before the stimulus was read to its end"


def _left_out(left_out: Sequence[LeftOut]) -> Iterable[str]:
    told = "; ".join(f"{left.what} ({left.reason})" for left in left_out)
    yield f"Left out of the analysis: {told}" if told else "Nothing was left out of the analysis"


def _versions(sittings: Sequence[SessionTrials]) -> Iterable[str]:
    versions = dict.fromkeys(sitting.versions.get("vbraille", "unknown") for sitting in sittings)
    yield (
        f"Sessions were run with vbraille {', '.join(versions)}, and analysed with vbraille "
        f"{__version__}"
    )


def _span(numbers: Sequence[int], noun: str) -> str:
    """A number with its noun, or the least and the largest of several.

    >>> _span([78, 78], "trial"), _span([25, 30], "trial")
    ('78 trials', '25 to 30 trials')
    """
    least, most = min(numbers), max(numbers)
    return count(most, noun) if least == most else f"{least} to {count(most, noun)}"


def asked(protocol: Protocol, rows: Sequence[dict[str, Any]]) -> Iterable[str]:
    """Sentences on the question, for trials that have an answer."""
    if not rows:
        return
    question = protocol.asks
    if question.ask:
        yield f"They were asked: “{question.ask}”"
    if told := question.describe(rows, protocol.parameter):
        yield told
    sure = sum(row["confidence"] != "" for row in rows)
    if question.confidence is not None and sure:
        scale = question.confidence
        yield (
            f"After {of_all(sure, rows, 'answer')} they said how sure they were, from "
            f"{scale.least} to {scale.most}"
        )


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


def chosen(protocol: Protocol) -> Iterable[str]:
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
