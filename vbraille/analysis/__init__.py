"""Trials in; tables, the planned comparison, and a report out.

analysis = analyse(["P01.session", "P02.session"])
analysis.write("report")
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.errors import InputError, needing_extras

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from vbraille.analysis.report import Analysis


def analyse(
    paths: str | Path | Sequence[str | Path],
    *,
    protocol: str | None = None,
    measure: str | None = None,
    factors: Sequence[str] | None = None,
    exclude: Mapping[str, str] | None = None,
) -> Analysis:
    """Analyse sessions and tables of trials.

    Parameters
    ----------
    paths
        Files of sessions, and tables in CSV with the columns participant, presented and answered;
        one, or several.
    protocol
        Name of the protocol whose trials are taken; None if there is only one.
    measure, factors
        What is compared, and the columns by whose levels; None as the protocol plans, or as is
        usual for the question.
    exclude
        People who are left out, each with the reason.

    Raises
    ------
    InputError
        If something cannot be read or compared.
    """
    with needing_extras():
        from vbraille.analysis import primary, report
        from vbraille.analysis.methods import methods
        from vbraille.analysis.plan import asked_of, leave_out, plan_of
        from vbraille.analysis.read import read_trials

    trials = read_trials(_listed(paths), protocol=protocol, exclude=exclude)
    plan = plan_of(trials, measure, factors)
    leave_out(trials, plan)
    asked = asked_of(trials, plan)
    result = primary.compare(asked, plan) if plan.measure else None
    tables = {} if result is None else report.tables_of(result)
    left_out = trials.left_out + (result.left_out if result else [])
    known = {text.partition(": ")[0] for text in left_out}
    known |= set(asked["participant"] if result is None else result.cells.index)
    left_out += [f"{each}: no trial that counts" for each in trials.people if each not in known]
    people = asked["participant"].nunique()
    return report.Analysis(
        report.title_of(result, plan.question, people),
        result,
        tables | report.all_tables(trials, plan, asked),
        trials.warnings + plan.departures + (result.warnings if result else []),
        trials.notes,
        left_out,
        methods(trials, result),
        trials.sources,
    )


def analyse_scores(path: str | Path) -> Analysis:
    """Analyse a table of scores: columns participant, one to four factors, and score.

    Raises
    ------
    InputError
        If it is no such table.
    """
    with needing_extras():
        from vbraille.analysis import primary, report
        from vbraille.analysis.methods import methods

    result = primary.compare_scores(path)
    return report.Analysis(
        report.title_of(result, "", 0),
        result,
        report.tables_of(result),
        left_out=result.left_out,
        methods=methods(None, result),
        sources=[str(path)],
    )


def _listed(paths: str | Path | Sequence[str | Path]) -> list[Path]:
    """Return paths, one or several, as a list."""
    given = [paths] if isinstance(paths, str | Path) else list(paths or ())
    if not given:
        raise InputError("nothing is given to analyse; give files of sessions, or tables")
    return [Path(path) for path in given]


def methods_of(paths: str | Path | Sequence[str | Path]) -> list[str]:
    """Return the paragraph on what was done in sessions, a sentence each.

    Raises
    ------
    InputError
        If one cannot be read.
    """
    with needing_extras():
        from vbraille.analysis.methods import methods
        from vbraille.analysis.read import read_trials

    return methods(read_trials(_listed(paths)), None)
