"""The paragraph on methods: each sentence is of what was counted in these trials."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from vbraille.analysis.measures import LOGS, SHARES
from vbraille.analysis.primary import Result, people
from vbraille.analysis.read import STRINGS, Trials
from vbraille.version import __version__

if TYPE_CHECKING:
    from pandas import DataFrame, Series

DISTANCES = {
    "dot_width_mm": "dots {} mm wide",
    "dot_spacing_mm": "dot columns {} mm apart",
    "cell_gap_mm": "{} mm between cells",
}


def span(counts: Series | list[int], noun: str) -> str:
    """Return a number of things, or the least and the largest.

    >>> span([26, 26], "trial"), span([1], "break"), span([2, 3], "break")
    ('26 trials', '1 break', '2 to 3 breaks')
    """
    least, most = int(min(counts)), int(max(counts))
    number = f"{most}" if least == most else f"{least} to {most}"
    return f"{number} {noun}{'' if most == 1 else 's'}"


def of_sessions(trials: Trials) -> list[str]:
    """Say who did what, as far as trials and the records of sessions tell."""
    frame = trials.frame
    counts = frame.groupby("participant", observed=True).size()
    each = " each" if counts.max() > 1 and len(counts) > 1 else ""
    text = f"{people(len(counts)).capitalize()} answered {span(counts, 'trial')}{each}"
    protocols = [name for name in frame["protocol"].unique() if name]
    if protocols:
        sessions = span([frame["session"].nunique()], "session")
        text += f" in {sessions} of the protocol {', '.join(protocols)}"
    made = [text + "."]
    strings = frame.loc[frame["question"] == STRINGS, "presented"]
    if len(strings):
        made.append(f"Strings had {span(strings.str.len(), 'cell')}.")
    conditions = [name for name in frame["condition"].cat.categories if name]
    if len(conditions) > 1:
        made.append(f"Conditions were {', '.join(conditions)}.")
    made += _display(frame)
    made += _happened(trials)
    return made


def _only(frame: DataFrame, column: str) -> str:
    """Return the value that all trials have; empty if they differ or have none."""
    values = frame[column].dropna().unique() if column in frame else []
    if len(values) != 1:
        return ""
    return f"{values[0]:g}" if isinstance(values[0], float) else str(values[0])


def _display(frame: DataFrame) -> list[str]:
    model = _only(frame, "model")
    if not model:
        return []
    how = [f"mapping {_only(frame, 'mapping')}"] if _only(frame, "mapping") else []
    for column, words in DISTANCES.items():
        if _only(frame, column):
            how.append(words.format(_only(frame, column)))
    return [f"They were shown on the display {model}{': ' if how else ''}{', '.join(how)}."]


def _happened(trials: Trials) -> list[str]:
    """Say what the records of sessions tell of practice, breaks, faults and repeats."""
    if not trials.contents:
        return []
    events = [Counter(event.kind for event in content.events) for content in trials.contents]
    practice = [
        len({e.trial for e in content.events if e.kind == "answer" and e.practice})
        for content in trials.contents
    ]
    made = [f"Sessions had {span(practice, 'trial')} of practice"]
    made[0] += f" and {span([each['break'] for each in events], 'break')}."
    faults = sum(each["fault"] for each in events)
    repeats = sum(each["repeat"] for each in events)
    if faults or repeats:
        made.append(
            f"The device had {span([faults], 'fault')}, and {span([repeats], 'trial')} were shown "
            f"again."
        )
    ended = sum(each["end"] > 0 for each in events)
    if ended < len(events):
        made.append(f"{ended} of {len(events)} sessions came to their end.")
    return made


def of_tests(result: Result) -> list[str]:
    """Say how values were compared."""
    scale = result.measure.scale
    what = "mean logarithm of the " * (scale == LOGS) + result.measure.name
    made = []
    within = result.cells.shape[1] > 1
    pairs = int(result.pairs["p"].notna().sum()) if len(result.pairs) else 0
    if within and pairs:
        made.append(f"The {what} of each person was compared by paired t-tests.")
    if result.groups is not None and pairs:
        made.append(f"Groups were compared by Welch’s t-tests of the {what} of each person.")
    if pairs and len(result.effects) and within:
        made.append(
            "Effects were tested by analysis of variance within people with the correction of "
            "Greenhouse and Geisser."
        )
    if pairs > 1:
        made.append(
            "p of all pairs were corrected by Holm’s method. Intervals of differences have levels "
            "of 1 − 0.05/k (column k of the pairs) in step with it, so that each holds 0 if and "
            "only if the corrected p is above 0.05."
        )
    if scale == SHARES and result.means["low"].notna().any():
        made.append(
            "Each person weighs the same, whatever the number of trials. Intervals of mean shares "
            "are Student’s on the logit scale."
        )
    if scale == LOGS and pairs:
        made.append("Differences of logarithms are told as ratios.")
    return made


def methods(trials: Trials, result: Result | None) -> list[str]:
    """Return the paragraph, a sentence each."""
    tests = [] if result is None else of_tests(result)
    runs = [event for content in trials.contents for event in content.events if event.kind == "run"]
    ran = sorted({run.data.get("versions", {}).get("vbraille", "unknown") for run in runs})
    versions = f"Sessions were run with vbraille {', '.join(ran)}, and a" if ran else "A"
    return [*of_sessions(trials), *tests, f"{versions}nalysed with vbraille {__version__}."]
