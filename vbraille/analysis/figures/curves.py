"""Figures of what went on in time: legibility over trials, and the way of the hand."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.analysis.input.trials import name_string
from vbraille.analysis.results import ReportFigure
from vbraille.analysis.schemas import PARTICIPANT, SESSION, TRIAL, Column, Kind, Schema, to_print
from vbraille.pictures.charts import Curve, Path, Paths, Runs

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from vbraille.analysis.input.sittings import Example, SessionTrials
    from vbraille.analysis.schemas import ResultTable

MOST_RUNS = 24  # panels in one figure of curves
MOST_PAGES = 10  # figures of curves
PATHS = Schema(
    "examples",
    "Trajectories of the trials that are drawn",
    "Of each reading pattern one trial: of all sessions, that whose duration is the median of "
    "theirs. At most 600 ticks of it.",
    (
        Column("pattern", "pattern", "reading pattern"),
        PARTICIPANT,
        SESSION,
        TRIAL,
        Column("presented", "string", "names of its cells"),
        Column("time_s", "time (s)", "since the trial began", Kind.NUMBER),
        Column("x_mm", "x (mm)", "place of the array's left column", Kind.NUMBER),
        Column("counts", "counts", "1 within the time that counts, else 0", Kind.COUNT),
    ),
)


def over_time(table: ResultTable, slopes: ResultTable) -> Iterator[ReportFigure]:
    """Single trials and their moving average, `MOST_RUNS` to a figure: Lévesque 2009, fig. 3.14."""
    whose = ["participant", "session", "condition"]
    runs = []
    several = len(table.frame["session"].unique()) > len(table.frame["participant"].unique())
    by = table.frame.groupby(whose, sort=False)
    for (who, session, condition), rows in list(by)[: MOST_RUNS * MOST_PAGES]:
        average = rows["average"].astype(object).where(rows["average"].notna(), None)
        runs.append(
            Curve(
                f"{who}, {session}, {condition}" if several else f"{who}, {condition}",
                tuple(rows["number"].tolist()),
                tuple(rows["correct"].tolist()),
                tuple(average.tolist()),
            )
        )
    sure = [row for row in slopes.records() if row["p"] is not None and row["p"] < 0.05]
    said = "; ".join(
        f"{row['participant']}, {row['condition']}, by {to_print(row['slope'], Kind.PERCENT)} % in "
        f"10 trials"
        for row in sure
    )
    pages = -(-by.ngroups // MOST_RUNS)
    left = f" Of {pages} pages {MOST_PAGES} are drawn; the table has all." * (pages > MOST_PAGES)
    for page in range(min(pages, MOST_PAGES)):
        part = f", {page + 1} of {pages}" if pages > 1 else ""
        text = (
            f"A panel a participant and condition; dots are single trials, the curve is the "
            f"average of the past 10. Legibility changed with p below 0.05: {said or 'nowhere'}."
            f"{left}"
        )
        yield ReportFigure(
            "over_time" if not page else f"over_time_{page + 1}",
            f"Legibility over time{part}",
            text if not page else "As the figure before, of the participants that follow.",
            table.name,
            Runs(
                f"Legibility over time{part}",
                tuple(runs[page * MOST_RUNS : (page + 1) * MOST_RUNS]),
            ),
        )


def examples(sittings: Sequence[SessionTrials]) -> tuple[ResultTable, ReportFigure] | None:
    """Trajectories, one for each pattern (Lévesque 2009, fig. 3.15); None if there are none."""
    chosen = list(_chosen(sittings))
    if not chosen:
        return None
    rows = [
        {
            "pattern": example.pattern,
            "participant": example.participant,
            "session": session,
            "trial": example.trial,
            "presented": name_string(example.presented),
            "time_s": time_s,
            "x_mm": x_mm,
            "counts": int(example.start_s <= time_s <= example.end_s),
        }
        for session, example in chosen
        for time_s, x_mm in zip(example.time_s.tolist(), example.left_mm.tolist(), strict=True)
    ]
    paths = tuple(
        Path(
            f"{example.pattern}: {example.participant}, {name_string(example.presented)}",
            tuple(example.time_s.tolist()),
            tuple(example.left_mm.tolist()),
            example.start_s,
            example.end_s,
            example.span_mm,
            example.dots_mm,
        )
        for _, example in chosen
    )
    said = "; ".join(
        f"{example.pattern}: participant {example.participant} read "
        f"{name_string(example.presented)} in "
        f"{to_print(example.end_s - example.start_s, Kind.SECONDS)} s (trial {example.trial} of "
        f"{session})"
        for session, example in chosen
    )
    table = PATHS.fill(rows)
    return table, ReportFigure(
        "trajectories",
        "Typical reading patterns",
        "Where the array was while a string was read, a trial of each pattern: a band from its "
        f"left column to its right one, dotted where the time does not count. {said}.",
        table.name,
        Paths("Typical reading patterns", paths),
    )


def _chosen(sittings: Sequence[SessionTrials]) -> Iterator[tuple[str, Example]]:
    """One example of each pattern: the one whose duration is in the middle."""
    found = [(sitting.name, example) for sitting in sittings for example in sitting.examples]
    for pattern in dict.fromkeys(sorted(example.pattern for _, example in found)):
        of = [pair for pair in found if pair[1].pattern == pattern]
        of.sort(key=lambda pair: (pair[1].end_s - pair[1].start_s, pair[0], pair[1].trial))
        yield of[(len(of) - 1) // 2]
