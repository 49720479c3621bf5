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
from vbraille.sessions.planning.choosing import describe
from vbraille.sessions.planning.conventionaltable import CONVENTIONAL
from vbraille.version import __version__
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from vbraille.analysis.input.sittings import SessionTrials
    from vbraille.analysis.input.study import Study
    from vbraille.analysis.input.trials import LeftOut
    from vbraille.sessions.planning.protocol import Protocol

_DISTANCES = {
    "dot_width_mm": "dots {} mm wide",
    "dot_spacing_mm": "dot columns {} mm apart",
    "cell_gap_mm": "{} mm from cell to cell",
}
# Distances that follow from the one that two stimuli are compared by.
_VARIED = {"dot_width_mm": ("dot_width_mm",), "dot_gap_mm": ("dot_spacing_mm",)}


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
    answered = [_answered(sitting) for sitting in sittings]
    rows = [row for part in answered for row in part]
    yield _who(sittings, answered)
    yield from _by_whom(rows)
    yield _display(sittings)
    yield from _conditions(answered)
    yield from _order(sittings, answered)
    practised = [sitting.counts["practice"] for sitting in sittings]
    yield (
        f"Before them came {_span(practised, 'trial')} of practice"
        if any(practised)
        else "There was no practice"
    )
    breaks = [sitting.counts["break"] for sitting in sittings]
    yield f"A session had {_span(breaks, 'break')}" if any(breaks) else "There were no breaks"
    yield from _troubles(sittings, rows)


def _answered(sitting: SessionTrials) -> list[dict[str, Any]]:
    return [row for row in sitting.rows if row["answered"] != ""]


def _who(sittings: Sequence[SessionTrials], answered: Sequence[Sequence[dict]]) -> str:
    """Who read how much of what."""
    protocol = sittings[0].protocol
    people = len({sitting.head["participant"] for sitting in sittings})
    rows = [row for part in answered for row in part]
    numbers = [len(part) for part in answered]
    if not rows:
        what = "answered no trial"
    elif all(row["parameter"] for row in rows):
        parameter = rows[0]["parameter"].removesuffix("_mm").replace("_", " ")
        values = {float(value) for row in rows for value in row["presented"].split()}
        what = (
            f"compared {_span(numbers, 'pair')} of {len(values)} values of the {parameter}, "
            f"{min(values):g} to {max(values):g} mm"
        )
    elif any(row["parameter"] for row in rows):
        what = f"answered {_span(numbers, 'trial')}"
    else:
        cells = _span([len(row["presented"]) for row in rows], "cell")
        each = " each" if max(numbers) > 1 else ""
        what = f"read {_span(numbers, 'string')} of {cells}{each}"
    often = f"in {count(len(sittings), 'session')}"
    simulated = {row["answers_from"].partition(":")[0] for row in rows} == {"simulated"}
    who = count(people, "simulated participant" if simulated else "participant")
    told = f"{protocol.name} ({protocol.title}; {protocol.source})"
    return f"{who} {what}, {often} of the protocol {told}"


def _by_whom(rows: Sequence[dict]) -> Iterable[str]:
    """Where the answers came from, and what moved the array, where that was no person."""
    kinds = Counter(row["answers_from"].partition(":")[0] for row in rows)
    if simulated := kinds.pop("simulated", 0):
        yield f"A simulated reader gave {_of_all(simulated, rows)} of the answers"
    kinds.pop("typed", None)
    if other := sum(kinds.values()):
        yield f"{_of_all(other, rows)} of the answers came from a program or a file"
    moved = sum(row["moved_by"].startswith("simulated") for row in rows)
    if moved:
        yield f"A simulated hand moved the array in {_of_all(moved, rows)} of the trials"


def _of_all(number: int, rows: Sequence[dict]) -> str:
    return f"all {number}" if number == len(rows) else f"{number} of {len(rows)}"


def _display(sittings: Sequence[SessionTrials]) -> str:
    """What was read on, with the distances of the record."""
    if sittings[0].protocol.medium == "paper":
        return "Strings were read on paper, and timed by key"
    parameter = sittings[0].protocol.parameter or ""
    told: list[str] = []
    for head in (sitting.head for sitting in sittings):
        array, geometry = head["array"], head["geometry"]
        lengths = [
            form.format(f"{geometry[name]:g}")
            for name, form in _DISTANCES.items()
            if name not in _VARIED.get(parameter, ())
        ]
        model = MODELS[head["model"]].title if head["model"] in MODELS else head["model"]
        device = head["device"].partition(":")[0]
        where = "a simulated device" if device == "sim" else "a device"
        told.append(
            f"the {model} ({array['rows']} × {array['columns']} actuators, {where}) at "
            f"{head['rate_hz']:g} frames a second, with the mapping {head['mapping']}, "
            f"{', '.join(lengths)}"
        )
    shown = f"They were shown on {'; or on '.join(dict.fromkeys(told))}"
    return f"{shown}{_beside(sittings[0].protocol)}"


def _beside(protocol: Protocol) -> str:
    """What stood on a conventional display instead, or beside."""
    there = [c.name for c in protocol.conditions if protocol.place_of(c) == CONVENTIONAL]
    if there:
        return (
            f"; those in {' and '.join(there)} on a conventional braille display, where reading "
            f"was timed by key"
        )
    reference = protocol.conventional.reference
    return (
        f"; {to_braille(reference)} stood on a conventional braille display, for comparison"
        if reference
        else ""
    )


def _conditions(answered: Sequence[Sequence[dict]]) -> Iterable[str]:
    """Conditions, with what they were shown with and how many trials each had."""
    rows = [row for part in answered for row in part]
    names = list(dict.fromkeys(row["condition"] for row in rows))
    told = []
    for name in sorted(names, key=natural):
        own = [row for row in rows if row["condition"] == name]
        values = []
        for knob in ("texture", "contrast"):
            levels = sorted({row[knob] for row in own if row[knob] != ""})
            if levels:
                ends = f"{levels[0]:g}" if len(levels) == 1 else f"{levels[0]:g} to {levels[-1]:g}"
                values.append(f"{knob} {ends}")
        each = [sum(row["condition"] == name for row in part) for part in answered]
        told.append(f"{name} ({', '.join([*values, _span(each, 'trial')])})")
    if len(names) > 1:
        yield f"There were {len(names)} conditions: {', '.join(told)}"
    elif names:
        yield f"All was of one condition: {told[0]}"


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
        yield f"Each condition had blocks of its own, {blocks} in a session; {drawn}"
    else:
        yield f"Conditions were mixed in {blocks}; {drawn}"
    if protocol.adaptive:
        yield f"The values were chosen by the answers: {describe(protocol)}"


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
