r"""Sessions in, tables and figures out. Sees no device and no engine.

`analyse` reads sessions and tables of trials, `analyse_scores` a table of scores; both give
`vbraille.analysis.results.Results`, whose tables are pandas data frames:

>>> from pathlib import Path
>>> from tempfile import mkdtemp
>>> path = Path(mkdtemp(), "trials.csv")
>>> _ = path.write_text("participant,condition,presented,answered\nP1,T0,ab,ab\nP1,T0,ca,c?\n")
>>> results = analyse([path])
>>> results.table("legibility")[["participant", "condition", "trials", "correct", "legibility"]]
  participant condition  trials  correct  legibility
0          P1        T0       2        1         0.5

Inside, `input` reads and checks what is given. Each module of `measures` makes tables for one
question, and `figures` says what to draw of them. `primary` answers what the study asks, and
`chapters` puts all together as `results`, which `report` writes. `statistics` knows plain numbers
alone.
"""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from vbraille.analysis.results import Results

__all__ = ["analyse", "analyse_scores"]


def analyse(
    paths: str | PathLike[str] | Iterable[str | PathLike[str]],
    *,
    exclude: Mapping[str, str] | None = None,
    protocol: str | None = None,
    factors: Sequence[str] | None = None,
    correction: str | None = None,
    marks: Sequence[int] | None = None,
    seed: int | None = None,
    report: Callable[[int, int], None] = lambda _done, _parts: None,
) -> Results:
    """Analyse sessions and tables of trials together.

    Parameters
    ----------
    paths
        Directories of sessions, and CSV files with the columns ``participant``, ``condition``,
        ``presented`` and ``answered``, in any order; one may stand by itself.
    exclude
        Participants who are left out, each with the reason.
    protocol
        Name of the protocol whose trials are taken; None takes those of all.
    factors
        Columns by which trials are compared; those that the protocol plans if not given, and
        without a protocol the column ``condition``.
    correction
        How p are corrected for their number: "none", "bonferroni", "holm" or "fdr"; as planned if
        not given.
    marks
        Errors above these counts are marked in the report's confusion matrices; 4 and 9 if not
        given.
    seed
        Seed of random draws; the same one each time if not given.
    report
        Told how many parts of the work are done, out of how many: each path that is read is one,
        and so are the measures that are compared, and all else.

    Raises
    ------
    InputError
        If something is no session and no table of trials, cannot be read, or leaves nothing to
        analyse.
    ValueError
        If there is no such correction.
    VbrailleError
        If a session has lost what it began with.
    """
    # Imported here, so that a program that only offers this function need not wait for statistics.
    from vbraille.analysis.chapters import STAGES, analyse_study, options_of
    from vbraille.analysis.input.study import load_study

    try:
        options = options_of(
            correction=correction,
            factors=None if factors is None else tuple(factors),
            marks=marks,
            seed=seed,
        )
        given = [Path(p) for p in ([paths] if isinstance(paths, str | PathLike) else paths)]
    except TypeError:
        raise InputError(
            f"paths are {paths!r:.40} and factors {factors!r:.40}; give a path or several, and a "
            f"list of names"
        ) from None
    read, parts = len(given), len(given) + STAGES
    study = load_study(
        given,
        exclude=exclude,
        protocol=protocol,
        report=lambda done: report(done, parts),
    )
    return analyse_study(study, options, lambda done: report(read + done, parts))


def analyse_scores(
    path: str | PathLike[str], *, correction: str | None = None, seed: int | None = None
) -> Results:
    """Compare the levels of a table of scores.

    Parameters
    ----------
    path
        CSV file with the columns ``participant``, ``score``, and one or more columns of what was
        varied.
    correction, seed
        What they are in `analyse`.

    Raises
    ------
    InputError
        If the file is no such table.
    ValueError
        If there is no such correction.
    """
    from vbraille.analysis.chapters import compare_scores, options_of
    from vbraille.analysis.input.study import load_scores

    return compare_scores(*load_scores(Path(path)), options_of(correction=correction, seed=seed))
