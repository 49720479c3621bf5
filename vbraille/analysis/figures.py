"""Figures of results, with what they show in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.analysis.results import Picture
from vbraille.analysis.tables import Column, Kind, Schema, to_print
from vbraille.analysis.trials import UNREAD, name_string
from vbraille.pictures.charts import Bars, Matrix, Path, Paths, Run, Runs, Series

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from vbraille.analysis.confusion import Confusion
    from vbraille.analysis.sittings import Example, Sitting
    from vbraille.analysis.tables import Row, Table

PATHS = Schema(
    "examples",
    "Trajectories of the trials that are drawn",
    "Of each reading pattern one trial: of all sessions, that whose duration is the median of "
    "theirs. At most 600 ticks of it.",
    (
        Column("pattern", "pattern", "reading pattern"),
        Column("participant", "participant", "pseudonym"),
        Column("session", "session", "name of the session"),
        Column("trial", "trial", "its number in the session", Kind.COUNT),
        Column("presented", "string", "names of its cells"),
        Column("time_s", "time (s)", "since the trial began", Kind.NUMBER),
        Column("x_mm", "x (mm)", "place of the array's left column", Kind.NUMBER),
        Column("counts", "counts", "1 within the time that counts, else 0", Kind.COUNT),
    ),
)


def legibility(table: Table, averages: Table) -> Picture:
    """Bars by participant and condition: Lévesque 2009, figs. 4.7 and 4.9."""
    people = _distinct(table, "participant")
    conditions = _distinct(table, "condition")
    at = {(row["participant"], row["condition"]): row for row in table.records()}
    panels = [("strings read right (%)", "legibility", 100.0)]
    if any(len_ > 1 for len_ in _places(table)):
        panels.append(("characters read right (%)", "character_legibility", 100.0))
    if any(table.column("timed")):
        panels.append(("mean duration (s)", "duration_mean_s", 1.0))
    drawn = tuple(
        (
            label,
            tuple(
                Series(
                    condition,
                    tuple(_scaled(at[who, condition][name], scale) for who in people),
                    *(
                        tuple(_scaled(at[who, condition][end], scale) for who in people)
                        for end in (("low", "high") if name == "legibility" else ())
                    ),
                )
                for condition in conditions
            ),
        )
        for label, name, scale in panels
    )
    known = [row for row in table.records() if row["trials"]]
    best, worst = (extreme(known, key=lambda row: row["legibility"]) for extreme in (max, min))
    means = ", ".join(
        f"{row['condition']} {to_print(row['legibility'], Kind.PERCENT)} %"
        for row in averages.records()
        if row["legibility"] is not None
    )
    text = (
        f"Bars for each participant in each condition, with 95 % intervals of legibility. Most "
        f"strings were read right by {_whose(best)}, fewest by {_whose(worst)}. Averages over "
        f"participants: {means}."
    )
    return Picture(
        "legibility",
        "Legibility and duration by participant and condition",
        text,
        table.name,
        Bars("Legibility and duration", "participant", tuple(people), drawn),
    )


def dots(table: Table) -> Picture:
    """Legibility by number of dots: Lévesque 2009, fig. 4.8."""
    rows = table.records()
    series = Series(
        "all", *(tuple(_scaled(row[n], 100) for row in rows) for n in ("legibility", "low", "high"))
    )
    shares = ", ".join(
        f"{row['dots']}: {to_print(row['legibility'], Kind.PERCENT)} %" for row in rows
    )
    return Picture(
        "dots",
        "Legibility of characters by their number of dots",
        f"One bar a number of dots, the mean over participants, with 95 % intervals. {shares}.",
        table.name,
        Bars(
            "Legibility by number of dots",
            "dots of the character",
            tuple(str(row["dots"]) for row in rows),
            (("characters read right (%)", (series,)),),
        ),
    )


def errors(table: Table) -> Picture:
    """Kinds of errors: Lévesque 2009, fig. 4.8."""
    rows = table.records()
    series = Series("all", tuple(row["count"] for row in rows))
    first = rows[0]
    return Picture(
        "errors",
        "Errors by dots added, removed and moved",
        f"One bar a kind of error. The most frequent is {first['error']}: {first['count']} places, "
        f"{to_print(first['share'], Kind.PERCENT)} % of all errors.",
        table.name,
        Bars(
            "Errors by dots",
            "error",
            tuple(row["error"] for row in rows),
            (("places", (series,)),),
        ),
    )


def confusion(counts: Confusion, table: Table) -> Picture:
    """Matrix of counts: Lévesque 2009, tables 3.4, 3.5 and 4.1."""
    errors = [
        (counts.counts[r, c], row, column)
        for r, row in enumerate(counts.rows)
        for c, column in enumerate(counts.columns)
        if row != column and counts.counts[r, c]
    ]
    text = "No answer was wrong."
    if errors:
        worst = sorted(errors, key=lambda error: -error[0])[:3]
        said = "; ".join(
            f"{row} for which {column} was answered, {n} times" for n, row, column in worst
        )
        text = f"{len(errors)} kinds of confusion. Most frequent: {said}."
    known = {name: at for at, name in enumerate(counts.columns)}
    return Picture(
        table.name,
        table.title,
        f"Rows are what was presented, columns what was answered; {UNREAD} is not read. {text}",
        table.name,
        Matrix(
            table.title,
            "presented",
            "answered",
            counts.rows,
            counts.columns,
            tuple(tuple(row) for row in counts.counts.tolist()),
            table.marks,
            tuple(known.get(name) for name in counts.rows),
        ),
    )


def over_time(table: Table, slopes: Table) -> Picture:
    """Single trials and their moving average: Lévesque 2009, fig. 3.14."""
    of: dict[tuple, list[Row]] = {}
    for row in table.records():
        of.setdefault((row["participant"], row["session"], row["condition"]), []).append(row)
    several = len({key[1] for key in of}) > len({key[0] for key in of})
    runs = [
        Run(
            f"{who}, {session}, {condition}" if several else f"{who}, {condition}",
            tuple(row["number"] for row in rows),
            tuple(row["correct"] for row in rows),
            tuple(row["average"] for row in rows),
        )
        for (who, session, condition), rows in of.items()
    ]
    sure = [row for row in slopes.records() if row["p"] is not None and row["p"] < 0.05]
    said = "; ".join(
        f"{row['participant']}, {row['condition']}, by {to_print(row['slope'], Kind.PERCENT)} % in "
        f"10 trials"
        for row in sure
    )
    return Picture(
        "over_time",
        "Legibility over time",
        "A panel a participant and condition; dots are single trials, the curve is the average of "
        f"the past 10. Legibility changed with p below 0.05: {said or 'nowhere'}.",
        table.name,
        Runs("Legibility over time", tuple(runs)),
    )


def examples(sittings: Sequence[Sitting]) -> tuple[Table, Picture] | None:
    """Trajectory of a trial of each pattern: Lévesque 2009, fig. 3.15; None if there are none."""
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
        for time_s, x_mm in zip(example.time_s.tolist(), example.x_mm.tolist(), strict=True)
    ]
    paths = tuple(
        Path(
            f"{example.pattern}: {example.participant}, {name_string(example.presented)}",
            tuple(example.time_s.tolist()),
            tuple(example.x_mm.tolist()),
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
    return table, Picture(
        "trajectories",
        "Typical reading patterns",
        "Where the array was while a string was read, a trial of each pattern: a band from its "
        f"left column to its right one, dotted where the time does not count. {said}.",
        table.name,
        Paths("Typical reading patterns", paths),
    )


def choices(table: Table, preferred: Table) -> Iterator[Picture]:
    """How often each value was chosen, a figure a parameter: Lévesque 2009, fig. 3.12."""
    for liked in preferred.records():
        name = liked["parameter"]
        rows = [row for row in table.records() if row["parameter"] == name]
        most = max(rows, key=lambda row: row["chosen"])
        said = (
            f"The preferred value is {to_print(liked['preferred'], Kind.NUMBER)}, 95 % interval "
            f"{to_print(liked['low'], Kind.NUMBER)} to {to_print(liked['high'], Kind.NUMBER)}."
            if liked["low"] is not None
            else f"The preferred value is {to_print(liked['preferred'], Kind.NUMBER)}; "
            f"{liked['note']}."
            if liked["preferred"] is not None
            else liked["note"]
        )
        yield Picture(
            f"choices_{_file_name(name)}",
            f"How often each {_in_words(name)} was chosen",
            f"One bar a value. Most often chosen was {most['value']:g}, {most['chosen']} times of "
            f"{most['presented']}. {said}",
            table.name,
            Bars(
                f"Choices of {_in_words(name)}",
                _in_words(name),
                tuple(f"{row['value']:g}" for row in rows),
                (("times chosen", (Series("chosen", tuple(row["chosen"] for row in rows)),)),),
            ),
        )


def level_means(table: Table) -> Iterator[Picture]:
    """Means of the levels with their intervals, a figure a factor."""
    for factor in _distinct(table, "factor"):
        rows = [row for row in table.records() if row["factor"] == factor]
        levels = list(dict.fromkeys(row["level"] for row in rows))
        panels = []
        for measure in dict.fromkeys(row["measure"] for row in rows):
            of = {row["level"]: row for row in rows if row["measure"] == measure}
            ends = (
                tuple(of[level][end] if level in of else None for level in levels)
                for end in ("mean", "low", "high")
            )
            panels.append((measure, (Series("mean", *ends),)))
        said = "; ".join(
            f"{row['measure']}, {row['level']}: {to_print(row['mean'], Kind.NUMBER)}"
            for row in rows
            if row["mean"] is not None
        )
        yield Picture(
            f"means_{_file_name(factor)}",
            f"Means by {factor}",
            f"Means over participants, with 95 % intervals. {said}.",
            table.name,
            Bars(f"Means by {factor}", factor, tuple(levels), tuple(panels)),
        )


def _chosen(sittings: Sequence[Sitting]) -> Iterator[tuple[str, Example]]:
    """Of the sessions' examples one of each pattern: that in the middle by duration."""
    found = [
        (sitting.folder.resolve().name, example)
        for sitting in sittings
        for example in sitting.examples
    ]
    for pattern in dict.fromkeys(sorted(example.pattern for _, example in found)):
        of = [pair for pair in found if pair[1].pattern == pattern]
        of.sort(key=lambda pair: (pair[1].end_s - pair[1].start_s, pair[0], pair[1].trial))
        yield of[(len(of) - 1) // 2]


def _places(table: Table) -> list[int]:
    """Mean places of a string, of each row that has any."""
    return [row["characters"] // row["trials"] for row in table.records() if row["trials"]]


def _distinct(table: Table, name: str) -> list[str]:
    return [str(value) for value in dict.fromkeys(table.column(name))]


def _scaled(value: float | None, scale: float) -> float | None:
    return None if value is None else scale * value


def _whose(row: Row) -> str:
    return (
        f"{row['participant']} in {row['condition']}, {to_print(row['legibility'], Kind.PERCENT)} %"
    )


def _in_words(parameter: str) -> str:
    """Words for a parameter with its unit: "dot width (mm)" for dot_width_mm."""
    unit = " (mm)" if parameter.endswith("_mm") else ""
    return parameter.removesuffix("_mm").replace("_", " ") + unit


def _file_name(name: str) -> str:
    """What a figure of something is called: letters and digits of its name."""
    return "".join(letter if letter.isascii() and letter.isalnum() else "_" for letter in name)
