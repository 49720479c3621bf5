"""Sessions in, tables and figures out. Sees no device and no engine.

`study` reads sessions (`sittings`, `reading`) and tables (`sheets`, `parsing`, `values`) into
`trials`. A module a question makes `tables` of them: `legibility`, `characters`, `confusion`,
`errors`, `overtime`, `motion`, `levels` and `tuning`; `figures` says what to draw. `analyse` puts
all together as `results`, which `report` writes. `statistics` knows nothing but plain numbers.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from os import PathLike

    from vbraille.analysis.results import Results

__all__ = ["analyse"]


def analyse(
    paths: Iterable[str | PathLike[str]],
    *,
    exclude: Mapping[str, str] | None = None,
    protocol: str | None = None,
    sites: bool = False,
    factors: Sequence[str] = ("condition",),
    correction: str = "holm",
) -> Results:
    """Analyse sessions and tables of trials together.

    Parameters
    ----------
    paths
        Directories of sessions, and CSV files with the columns ``participant``, ``condition``,
        ``presented`` and ``answered``.
    exclude
        Participants who are left out, each with the reason.
    protocol
        Name of the protocol whose trials are taken; None takes those of all.
    sites
        Whether each folder that something stands in has participants of its own.
    factors
        Columns by which trials are compared.
    correction
        How the p-values of t-tests are corrected for their number: "none", "bonferroni", "holm"
        or "fdr".

    Raises
    ------
    InputError
        If something is no session and no table of trials, or leaves nothing to analyse.
    """
    # Here, so that a program that only offers this function need not wait for statistics.
    from vbraille.analysis.chapters import Options, analyse
    from vbraille.analysis.input.study import load_study

    study = load_study(
        [Path(path) for path in paths], exclude=exclude or {}, protocol=protocol, sites=sites
    )
    return analyse(study, Options(factors=tuple(factors), correction=correction))
