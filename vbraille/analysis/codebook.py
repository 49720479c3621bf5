"""The codebook: what each column of each table holds."""

from __future__ import annotations

from pandas import DataFrame

MOST_VALUES = 12
MEANINGS = {
    "answered": "the answer",
    "at": "level of another factor at which the effect is tested",
    "average": "share of right answers of the last 10 trials, 0 to 1",
    "blanks": "trials with nothing to detect",
    "cell": "combination of levels",
    "character_legibility": "share of places read rightly, 0 to 1",
    "chosen": "comparisons in which the value was chosen",
    "comparisons": "number of comparisons",
    "condition": "name of the condition",
    "correct": "number of right answers",
    "count": "number of errors",
    "added": "dots in the answer that were not presented, less those moved",
    "removed": "dots presented that are not in the answer, less those moved",
    "moved": "dots added and removed as often",
    "d_prime": "d′, with half an answer added to each count",
    "df": "degrees of freedom of t",
    "df1": "degrees of freedom of F, corrected",
    "df2": "degrees of freedom of its error, corrected",
    "df1_uncorrected": "degrees of freedom of F",
    "df2_uncorrected": "degrees of freedom of its error",
    "duration_mean_s": "mean duration in s",
    "duration_sd_s": "standard deviation of durations in s",
    "effect": "factors whose effect or interaction is tested",
    "epsilon": "factor of Greenhouse and Geisser",
    "error": "standard error of the difference",
    "F": "F of the effect",
    "factor": "factor whose levels are compared",
    "false_alarms": "answers yes or different with nothing to detect",
    "first": "first level, from which the second is taken",
    "first_half": "mean share of right answers in people’s first half of the trials",
    "guesses": "share of positive answers at nothing",
    "hedges_g": "effect size of the difference",
    "high": "upper end of its interval",
    "hits": "answers yes or different with something to detect",
    "k": "the interval has the level 1 - 0.05/k",
    "kappa": "Cohen’s kappa",
    "accuracy": "share of right answers",
    "lapses": "share of answers that no level helps",
    "legibility": "share of right answers, 0 to 1",
    "level": "what was presented, or its level",
    "low": "lower end of its interval",
    "mean": "mean over people",
    "median": "median of all ratings",
    "name": "name in letters or dots",
    "noises": "trials with nothing to detect",
    "note": "reason for which there is no test",
    "number": "number of the trial in its run",
    "p": "p, two-sided, not corrected for other tests",
    "p_holm": "p corrected by Holm’s method among the rows",
    "p_uncorrected": "p without the correction of Greenhouse and Geisser",
    "parameter": "what values are compared of",
    "partial_eta2": "effect size of the effect",
    "participant": "pseudonym",
    "participants": "number of people",
    "preferred": "preferred value",
    "presented": "what was presented, or how often",
    "presented_bits": "information in what was presented",
    "ratings": "number of ratings",
    "right": "right answers, or whether the answer is right",
    "second": "second level",
    "second_half": "mean share of right answers in people’s second half of the trials",
    "session": "name of the session",
    "share": "share, 0 to 1",
    "share_sd": "its standard deviation over people",
    "signals": "trials with something to detect",
    "spread": "spread of the fitted function",
    "t": "t of the difference",
    "taken_s": "mean duration, or time to the answer, in s",
    "taken_sd_s": "its standard deviation over people",
    "threshold": "threshold, in the unit of the level",
    "timed": "trials with a duration",
    "transmitted_bits": "information transmitted, as counted (too high for few answers)",
    "trial": "number of the trial",
    "trials": "number of trials",
    "value": "difference, or value of the parameter",
    "why": "reason for which there is no value",
}


def codebook(tables: dict[str, DataFrame]) -> DataFrame:
    """Return a row for each column of each table: its meaning, and its values if they are few."""
    meanings = MEANINGS | _of_sessions()
    rows = []
    for name, table in tables.items():
        own = meanings if name == "trials" else MEANINGS
        for column in table:
            known = table[column].dropna().unique()
            text = table[column].dtype.kind not in "fiub" and len(known) <= MOST_VALUES
            values = "; ".join(sorted(map(str, known))) if text else ""
            meaning = own.get(str(column)) or _other(name, str(column))
            rows.append((name, str(column), meaning, values))
    return DataFrame(rows, columns=["table", "column", "meaning", "values"])


def _of_sessions() -> dict[str, str]:
    from vbraille.sessions.record.trials import COLUMNS

    return {name: column.meaning for name, column in COLUMNS.items()}


def _other(table: str, column: str) -> str:
    """Return the meaning of a column that has the name of a cell, a factor or an answer."""
    if table.startswith(("confusion", "answers")):
        return f"answers {column}"
    if table == "primary_people":
        return f"value in the cell {column}"
    return "column of the trials as they were given"
