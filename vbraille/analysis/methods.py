"""Paragraph on what was done in sessions, made of a template and of what sessions recorded.

Every number is counted in the sessions' records, or stands in them. What a session's protocol had
planned is not told, if it was not done: a sentence of the template is left out where there is
nothing to put in one of its places.
"""

from __future__ import annotations

from collections import Counter
from string import Formatter
from typing import TYPE_CHECKING, Any

from vbraille.analysis.input.trials import natural
from vbraille.analysis.statistics.comparisons import CellShares
from vbraille.analysis.statistics.intervals import METHODS
from vbraille.braille.spelling import to_braille
from vbraille.render.braille.models import MODELS
from vbraille.sessions.planning.factors import within
from vbraille.sessions.planning.nexttrial import varied
from vbraille.sessions.planning.procedures import QuestProcedure, StaircaseProcedure
from vbraille.sessions.planning.questions import of_all
from vbraille.sessions.planning.sequencing import balanced_orders
from vbraille.sessions.planning.stimuli import GAP, KNOBS
from vbraille.sessions.record.codebook import ASKED
from vbraille.version import __version__
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    Facts = dict[str, str | None]
    Rows = Sequence[dict[str, Any]]

    from vbraille.analysis.input.sessions import SessionTrials
    from vbraille.analysis.input.study import Study
    from vbraille.analysis.primary import ComparedMeasure
    from vbraille.sessions.planning.analysis import PlannedAnalysis
    from vbraille.sessions.planning.protocol import Protocol

_DISTANCES = {
    "dot_width_mm": "dots {} mm wide",
    "dot_spacing_mm": "dot columns {} mm apart",
    "cell_gap_mm": "{} mm from a cell's last dot column to the next cell's first",
}
TEMPLATE = """
{people} {did}, in {sessions} of the protocol {protocol}
A simulated reader gave {simulated}
{scripted} came from a program or a file
A simulated hand moved the array in {moved}
They were asked: “{ask}”
{question}
After {sure} they said how sure they were, from {scale}
Beside these there were {catch}
Strings were read on {paper}, and timed by key
They were shown on {displays}{reference}
Strings of the {elsewhere} stood on a conventional display instead, and were timed by key
Their cells were made of texts in print by liblouis {liblouis}, with the {tables}
Participants were in {groups}
Within participants varied {factors}
There were {conditions}
All was of one condition: {condition}
{order}; orders were drawn with {seeds}
{rules}
The {varied} of each trial was chosen by the answers before it, by {procedure}
It was made harder after {right} running, and easier after {wrong}
A condition was to end by {stops}
Reading was ended by {keys}; response times are to there
What was shown could be felt for {exposure}, which were over before the answer in {over}
Answers were to come within {answer}; {late}
A questionnaire asked {asked}
{practice}
{breaks}
{unanswered} had no answer
{quitters} stopped for good, before all trials were done
{broken} did not come to the end
In {faults} the device had a fault
{repeated} had to be shown again
{early} came before the stimulus was read to its end
"""
"""Sentences on the sessions of one protocol, a line each."""
# Looks that follow from another one that two stimuli are compared by.
_BY = {"dot_spacing_mm": (GAP,)}
# What conditions and groups may differ in: columns of rows, and their words.
_ALWAYS = ("texture", "contrast")
_LOOKS = {
    **{name: KNOBS[name].words for name in KNOBS if name != GAP},
    "mapping": "mapping",
    "table": "table",
}


def methods(study: Study, *, left_out: bool = True) -> str:
    """Paragraph on the sessions of a study; empty if it has none, but tables alone.

    Parameters
    ----------
    left_out
        Whether it says what was left out of the analysis.

    Examples
    --------
    A paragraph begins so: "2 participants read 78 strings of 5 cells each, in 2 sessions of the
    protocol letters (Identification of letters; Lévesque 2009, 4.3)."
    """
    of: dict[str, list[SessionTrials]] = {}
    for session in study.sessions:
        of.setdefault(session.protocol.text, []).append(session)
    if not of:
        return ""
    sentences = [line for sessions in of.values() for line in filled(TEMPLATE, facts_of(sessions))]
    if left_out:
        dropped = "; ".join(f"{left.what} ({left.reason})" for left in study.left_out)
        told = f"Left out of the analysis: {dropped}"
        sentences.append(told if dropped else "Nothing was left out of the analysis")
    versions = dict.fromkeys(each.versions.get("vbraille", "unknown") for each in study.sessions)
    sentences += [
        f"Sessions were run with vbraille {', '.join(versions)}, and analysed with vbraille "
        f"{__version__}",
    ]
    return " ".join(f"{sentence}." for sentence in sentences)


_SHARES = (
    "Shares of right answers were compared by a logistic regression of single trials with "
    "participants as clusters (Firth's penalty; the sandwich of participants' scores with "
    "Kauermann and Carroll's correction; tests of 2 asin √share, effects by Wald's test as F with "
    "the degrees of freedom of Hotelling's T²); the interval of a mean share is of the "
    "population's, by a logit-normal model of how people differ; effect sizes are odds ratios"
)
_MEANS = (
    "Participants' own {what} were compared: two levels by t of the participants' differences, or "
    "by Welch's t of groups, several by the analysis of variance with Greenhouse and Geisser's "
    "correction; intervals are Student's; effect sizes are Hedges's g"
)
_FAMILY = (
    "Effects were corrected together ({correction}); a difference of levels has at least the p of "
    "its effect, and is corrected for the others of it"
)
_ITEMS = "Items were taken as they are: conclusions are about people, not about other items"


def analysed_by(compared: ComparedMeasure | None, planned: PlannedAnalysis) -> str:
    """Sentences on the model of the primary analysis; empty if there is none."""
    if compared is None:
        return ""
    cells = compared.cells
    plural = {"log": "logarithms", "linear": "values", "share": "shares"}[cells.scale]
    shares = isinstance(cells.data, CellShares)
    told = [_SHARES if shares else _MEANS.format(what=f"{plural} of the {cells.words}")]
    if cells.scale == "log":
        told.append("Differences are told as ratios")
    if compared.effects:
        told.append(_FAMILY.format(correction=METHODS[planned.correction]))
    if shares:
        told.append(_ITEMS)
    return " ".join(f"{sentence}." for sentence in told)


def filled(template: str, facts: Facts) -> Iterable[str]:
    r"""Sentences of a template, without those that have a place for which there is no fact.

    >>> list(filled("{people} read\n{moved} moved", {"people": "2 people", "moved": None}))
    ['2 people read']
    """
    for line in template.strip().splitlines():
        names = [name for _, name, _, _ in Formatter().parse(line) if name]
        if all(facts[name] is not None for name in names):
            yield line.format(**facts)


def facts_of(sessions: Sequence[SessionTrials]) -> Facts:
    """Facts for `TEMPLATE` on the sessions of one protocol; None for one that there is not."""
    protocol = sessions[0].protocol
    answered = [[row for row in each.rows if row["answered"] != ""] for each in sessions]
    rows = [row for part in answered for row in part]
    # Blank trials are what detection needs, and keep no watch there.
    watches = protocol.asks.name != "detect" and protocol.design.catch is not None
    tested = [[row for row in part if not (watches and row["catch"])] for part in answered]
    kept = [row for part in tested for row in part]
    practised = [each.counts["practice"] for each in sessions]
    breaks = [each.counts["break"] for each in sessions]
    silent = "" if protocol.practice.feedback else ", without feedback"
    return {
        **_people(sessions, tested, kept),
        **_sources(rows),
        **_question(protocol, kept),
        "catch": _catch([row for row in rows if watches and row["catch"]]),
        **_displays(sessions, rows),
        "groups": _groups(sessions),
        "factors": _factors(protocol, rows),
        **_conditions(tested),
        **_order(sessions, answered),
        **_procedure(protocol),
        "keys": _keys(rows),
        **_limits(protocol, [row for each in sessions for row in each.rows]),
        "asked": _asked(sessions) or None,
        "practice": f"Before them came {_span(practised, 'trial')} of practice{silent}"
        if any(practised)
        else "There was no practice",
        "breaks": f"A session had {_span(breaks, 'break')}"
        if any(breaks)
        else "There were no breaks",
        **_troubles(sessions, rows),
    }


def _people(sessions: Sequence[SessionTrials], tested: Sequence[Rows], rows: Rows) -> Facts:
    """Facts on who read how much of what."""
    protocol = sessions[0].protocol
    numbers = [len(part) for part in tested]
    if not rows:
        did = "answered no trial"
    elif protocol.parameter is not None:
        knob = KNOBS[protocol.parameter]
        values = {float(value) for row in rows for value in row["presented"].split()}
        two = protocol.intervals == 2
        did = (
            f"{'compared' if two else 'judged'} {_span(numbers, 'pair' if two else 'trial')} of "
            f"{len(values)} values of the {knob.words}, {min(values):g} to {max(values):g}"
            f"{knob.unit}"
        )
    elif protocol.pictures:
        did = f"felt {_span(numbers, 'picture')}{' each' if max(numbers) > 1 else ''}"
    else:
        cells = _span([len(row["presented"]) for row in rows], "cell")
        verb = "read" if protocol.asks.name == "identify" else "felt"
        each = " each" if max(numbers) > 1 else ""
        did = f"{verb} {_span(numbers, 'string')} of {cells}{each}"
    simulated = {row["answers_from"].partition(":")[0] for row in rows} == {"simulated"}
    people = len({session.head["participant"] for session in sessions})
    return {
        "people": count(people, "simulated participant" if simulated else "participant"),
        "did": did,
        "sessions": count(len(sessions), "session"),
        "protocol": f"{protocol.name} ({protocol.title}; {protocol.source})",
    }


def _sources(rows: Rows) -> Facts:
    """Facts on what gave the answers and moved the array, where that was no person."""
    kinds = Counter(row["answers_from"].partition(":")[0] for row in rows)
    simulated, _ = kinds.pop("simulated", 0), kinds.pop("typed", 0)
    scripted = _of_all(sum(kinds.values()), rows, "answer")
    return {
        "simulated": _of_all(simulated, rows, "answer"),
        "scripted": scripted and scripted[0].upper() + scripted[1:],
        "moved": _of_all(
            sum(row["moved_by"].startswith("simulated") for row in rows), rows, "trial"
        ),
    }


def _question(protocol: Protocol, rows: Rows) -> Facts:
    """Facts on the question, for trials that have an answer."""
    question, scale = protocol.asks, protocol.asks.confidence
    sure = sum(row["confidence"] != "" for row in rows)
    return {
        "ask": question.ask if rows and question.ask else None,
        "question": (question.describe(rows, protocol.parameter) or None) if rows else None,
        "sure": of_all(sure, rows, "answer") if scale is not None and sure else None,
        "scale": None if scale is None else f"{scale.least} to {scale.most}",
    }


def _catch(rows: Rows) -> str | None:
    """Words for trials that kept watch over the participant."""
    if not rows:
        return None
    kinds = Counter(row["catch"] for row in rows)
    shown = {"blank": "no dots", "repeat": "what the trial before them had shown"}
    told = " and ".join(
        f"{count(number, 'catch trial')} that showed {shown[kind]}"
        for kind, number in sorted(kinds.items())
    )
    right = sum(row["correct"] == 1 for row in rows)
    part = f"all {right}" if right == len(rows) else f"{right} of {len(rows)}"
    were = f"{part} were" if len(rows) > 1 else "it was" if right else "it was not"
    scored = any(row["correct"] != "" for row in rows)
    return f"{told}; {were} answered right" if scored else told


def _displays(sessions: Sequence[SessionTrials], rows: Rows) -> Facts:
    """Facts on the displays, with the distances of the record that were the same for all."""
    protocol, told = sessions[0].protocol, dict[str, None]()
    parameter = protocol.parameter or ""
    varied = {parameter, *_differing(rows)}
    varied |= {name for name, by in _BY.items() if parameter in by}
    for head in (session.head for session in sessions):
        array, model = head["array"], MODELS.get(head["model"])
        simulated = head["device"].partition(":")[0] == "sim"
        how = [f"at {head['rate_hz']:g} frames a second"]
        if protocol.pictures:
            varied |= {"mapping", *_DISTANCES}
        how += [] if "mapping" in varied else [f"with the mapping {head['mapping']}"]
        how += [
            form.format(f"{head['geometry'][name]:g}")
            for name, form in _DISTANCES.items()
            if name not in varied
        ]
        told[
            f"the {head['model'] if model is None else model.title} ({array['rows']} × "
            f"{array['columns']} actuators, {'a simulated device' if simulated else 'a device'}) "
            f"{', '.join(how)}"
        ] = None
    reference = protocol.conventional.reference
    beside = reference and any(session.counts["stood"] for session in sessions)
    there = {row["condition"] for row in rows if row["shown_on"] == "conventional"}
    noun = "condition " if len(there) == 1 else "conditions "
    tables = sorted({row["table"] for row in rows if row.get("table")})
    versions = {session.head["versions"].get("liblouis", "unknown") for session in sessions}
    paper = protocol.medium == "paper"
    return {
        "paper": "paper" if paper else None,
        "displays": None if paper else "; or on ".join(told),
        "reference": f"; {to_braille(reference)} stood on a conventional display, for comparison"
        if beside
        else "",
        "elsewhere": noun + ", ".join(sorted(there, key=natural)) if there else None,
        "liblouis": ", ".join(sorted(versions)),
        "tables": f"{'table' if len(tables) == 1 else 'tables'} {', '.join(tables)}"
        if tables
        else None,
    }


def _groups(sessions: Sequence[SessionTrials]) -> str | None:
    """Words for groups of participants, and how many were in each."""
    people: dict[str, set[str]] = {}
    for session in sessions:
        if group := session.head.get("group", ""):
            people.setdefault(group, set()).add(session.head["participant"])
    if not people:
        return None
    differing = _between(sessions)
    told = []
    for group in sorted(people, key=natural):
        own = [row for s in sessions if s.head.get("group") == group for row in s.rows]
        looks = [_look(name, own) for name in differing]
        told.append(f"{group} ({', '.join([count(len(people[group]), 'participant'), *looks])})")
    many = "1 group" if len(told) == 1 else f"{len(told)} groups"
    return f"{many}: {', '.join(told)}"


def _factors(protocol: Protocol, rows: Rows) -> str | None:
    """Words for what was crossed within participants, as far as it was shown."""
    own = within(protocol.factors)
    if not own or not rows:
        return None
    told = []
    possible = 1
    for factor in own:
        shown = {row[f"factor_{factor.name}"] for row in rows}
        levels = [level.name for level in factor.levels if level.name in shown]
        possible *= len(factor.levels)
        told.append(f"{factor.name} ({', '.join(levels)})")
    if len(told) == 1:
        return told[0]
    number = len({row["condition"] for row in rows})
    part = f"all {number}" if number == possible else f"{number} of the {possible}"
    return f"{' and '.join(told)}, {part} combinations of them"


def _conditions(answered: Sequence[Rows]) -> Facts:
    """Facts on conditions: what they were shown with, and how many trials each had."""
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
    return {
        "conditions": f"{len(names)} conditions: {', '.join(told)}" if len(names) > 1 else None,
        "condition": told[0] if len(names) == 1 else None,
    }


def _values(name: str, rows: Rows) -> list[Any]:
    """Values that rows have of a look, in order; nothing of pairs that are compared by it."""
    compared = {row["parameter"] for row in rows} & {name, *_BY.get(name, ())}
    given = set() if compared else {row.get(name, "") for row in rows} - {""}
    return sorted({float(value) for value in given} if name in KNOBS else given)


def _differing(rows: Rows) -> list[str]:
    """Looks of which rows have several values."""
    return [name for name in _LOOKS if len(_values(name, rows)) > 1]


def _between(sessions: Sequence[SessionTrials]) -> list[str]:
    """Looks that are the same in each session, and differ between sessions."""
    whole = _differing([row for session in sessions for row in session.rows])
    own = {name for session in sessions for name in _differing(session.rows)}
    return [name for name in whole if name not in own]


def _look(name: str, rows: Rows) -> str:
    """Words for a look of some rows: "texture 0", "dot width 1 to 2 mm"."""
    values = _values(name, rows)
    if name not in KNOBS:
        return f"{_LOOKS[name]} {' and '.join(values)}"
    ends = f"{values[0]:g}" if len(values) == 1 else f"{values[0]:g} to {values[-1]:g}"
    return f"{_LOOKS[name]} {ends}{KNOBS[name].unit}"


def _order(sessions: Sequence[SessionTrials], answered: Sequence[Rows]) -> Facts:
    """Facts on the order in which trials came, and on the rules that it kept."""
    protocol = sessions[0].protocol
    blocks = _span([len({row["block"] for row in part}) for part in answered], "block")
    if len(protocol.conditions) < 2:
        order = f"Trials came in {blocks}"
    elif protocol.design.blocks == "conditions":
        how = _order_of_blocks(protocol, [session.head for session in sessions])
        order = f"Each condition had blocks of its own, {blocks} in a session, {how}"
    else:
        order = f"Conditions were mixed in {blocks}"
    seeds = sorted({session.head["seed"] for session in sessions})
    rules = protocol.rules
    kept = ["no two neighbouring trials showed the same"] if rules.never_twice_running else []
    kept += [
        f"at most {count(most, 'neighbouring trial')} had the same {name}"
        for name, most in rules.at_most_running.items()
    ]
    kept += ["each quarter had its share of each condition"] if rules.balanced_quarters else []
    told = "" if protocol.adaptive else "; ".join(kept)
    return {
        "order": order,
        "seeds": f"{'seed' if len(seeds) == 1 else 'seeds'} {', '.join(map(str, seeds))}",
        "rules": told[:1].upper() + told[1:] or None,
    }


def _order_of_blocks(protocol: Protocol, heads: Sequence[dict[str, Any]]) -> str:
    """Clause on the order in which the blocks of conditions came."""
    if protocol.order_rows:
        return "in the order that a table gives each participant"
    if protocol.balanced:
        number = len(balanced_orders(len(protocol.conditions)))
        used = ", ".join(map(str, sorted({head["order"] for head in heads})))
        return f"balanced by Williams squares (of {count(number, 'order')}: {used})"
    return "in random order" if protocol.block_order == "shuffled" else "always in the same order"


def _procedure(protocol: Protocol) -> Facts:
    """Facts on how the answers chose what was shown, and when that was to end."""
    facts: Facts = dict.fromkeys(("varied", "procedure", "right", "wrong", "stops"))
    table = protocol.procedure
    if not isinstance(table, QuestProcedure | StaircaseProcedure):
        return facts
    knob = KNOBS[varied(protocol)]
    unit, values, stop = knob.unit, table.values(protocol.design), table.stop
    ends = f"{values[0]:g} to {values[-1]:g}{unit}"
    after = f" (after {count(stop.at_least, 'trial')} or more)"
    stops = [] if stop.trials is None else [count(stop.trials, "trial")]
    if stop.sd is not None:
        stops.append(f"a standard deviation of the estimate of {stop.sd:g}{unit}{after}")
    if stop.width is not None:
        stops.append(f"an interval of 95 % that was {stop.width:g}{unit} wide{after}")
    if stop.seconds is not None:
        stops.append(f"{stop.seconds:g} s of the session")
    if isinstance(table, QuestProcedure):
        facts["procedure"] = f"QUEST+ (Watson 2017) from {len(values)} values, {ends}"
    else:
        starts = ", ".join(f"{start:g}" for start in table.start)
        steps = ", then ".join(f"{step:g}" for step in table.steps)
        weighted = "" if table.target is None else f", weighted for {100 * table.target:g} %"
        many = "interleaved staircases" if len(table.start) > 1 else "staircase"
        facts["procedure"] = (
            f"{len(table.start)} {many}{weighted}, which began at {starts}{unit} with steps of "
            f"{steps}{unit}, within {ends}"
        )
        good, bad = ("“yes”", "“no”") if protocol.asks.name == "detect" else ("right", "wrong")
        facts["right"] = count(table.right, f"{good} answer")
        facts["wrong"] = count(table.wrong, f"{bad} answer")
        if table.reversals is not None:
            stops.append(f"{count(table.reversals, 'reversal')} of each staircase")
    return facts | {"varied": knob.words, "stops": ", or by ".join(stops) or None}


def _keys(rows: Rows) -> str | None:
    """Words for the participant's own key."""
    keys = Counter(row["ended_by"] for row in rows if row["ended_by"])
    answered = keys.pop("answer", 0)
    keys.pop("exposure", 0)  # which ends no response
    told = [
        f"{name.replace(':', ' ')} in {of_all(number, rows, 'trial')}"
        for name, number in sorted(keys.items())
    ]
    told += [f"their answer in {of_all(answered, rows, 'trial')}"] if answered else []
    return ", by ".join(told) or None if keys else None


def _limits(protocol: Protocol, planned: Rows) -> Facts:
    """Facts on how long a trial could be felt and answered, and on what came too late."""
    limits = protocol.trial
    facts: Facts = dict.fromkeys(("exposure", "over", "answer", "late"))
    answered = [row for row in planned if row["answered"] != ""]
    if limits.exposure_s is not None and answered:
        since = {"cue": "the start signal", "contact": "the first touch"}[limits.exposure_from]
        over = sum(row["ended_by"] == "exposure" for row in answered)
        facts |= {
            "exposure": f"{limits.exposure_s:g} s from {since}",
            "over": of_all(over, answered, "trial"),
        }
    begun = [row for row in planned if row["answered"] != "" or row.get("late") == 1]
    if limits.answer_s is not None and begun:
        since = "the start signal" if limits.exposure_s is None else "the end of the exposure"
        late = sum(row["late"] == 1 for row in begun)
        if limits.late == "kept":
            told = f"{of_all(late, begun, 'answer')} came later (late answers were kept)"
        else:
            told = f"without one the trial then ended, as in {of_all(late, begun, 'trial')}"
        facts |= {"answer": f"{limits.answer_s:g} s of {since}", "late": told}
    return facts


_WHEN = {
    "begin": "at the beginning",
    "trial": "after the answer to a trial",
    "block": "after a block",
    "end": "at the end",
}


def _asked(sessions: Sequence[SessionTrials]) -> str:
    """Words for the questions of the questionnaire that were answered, and how often."""
    told = []
    for item in sessions[0].protocol.questionnaire:
        # An answer is in the row of each trial that it goes with.
        numbers = sum(
            len({row.get(item.when) for row in each.rows if row[f"{ASKED}{item.name}"] != ""})
            for each in sessions
        )
        if numbers:
            told.append(f"“{item.ask}” {_WHEN[item.when]} ({count(numbers, 'answer')})")
    return ", and ".join(told)


def _troubles(sessions: Sequence[SessionTrials], rows: Rows) -> Facts:
    """Facts on what did not go as planned."""
    planned = sum(len(session.rows) for session in sessions)
    numbers = {
        "unanswered": (planned - len(rows), "planned trial"),
        "broken": (sum(session.state != "ended" for session in sessions), "session"),
        "quitters": (len({s.head["participant"] for s in sessions if s.quitted}), "participant"),
        "faults": (sum(row["faults"] != "" for row in rows), "trial"),
        "repeated": (sum(int(row["attempt"] or 0) > 1 for row in rows), "trial"),
        "early": (sum(row["early"] == 1 for row in rows), "answer"),
    }
    if sessions[0].protocol.adaptive:
        numbers["unanswered"] = (0, "planned trial")
    return {name: count(*of) if of[0] else None for name, of in numbers.items()}


def _of_all(number: int, rows: Rows, noun: str) -> str | None:
    """Words for a number of things out of all; None for none."""
    return of_all(number, rows, noun, "of the ") if number else None


def _span(numbers: Sequence[int], noun: str) -> str:
    """A number with its noun, or the least and the largest of several.

    >>> _span([78, 78], "trial"), _span([25, 30], "trial")
    ('78 trials', '25 to 30 trials')
    """
    least, most = min(numbers), max(numbers)
    return count(most, noun) if least == most else f"{least} to {count(most, noun)}"
