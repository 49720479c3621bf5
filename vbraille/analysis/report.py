"""An analysis as text, as JSON, and as a directory: one accessible page, tables and figures."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from vbraille.analysis import tables
from vbraille.analysis.measures import (
    CHOICES,
    detections,
    differences,
    level_of,
    preferences,
    thresholds,
)
from vbraille.analysis.primary import Result, cell_words, people, plain
from vbraille.analysis.read import SIGNALS, STRINGS, Trials
from vbraille.analysis.templates import render
from vbraille.files import write_folder
from vbraille.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterator

    from pandas import DataFrame

    from vbraille.analysis.plan import Plan

MOST_ROWS = 12
SHOWN = {
    "averages": "Averages over people",
    "information": "Accuracy and information",
    "dots": "Legibility by number of dots",
    "errors": "Errors by dots",
    "detections": "Hits and false alarms",
    "thresholds": "Thresholds",
    "levels": "Right answers by level",
    "preferences": "Preferred values",
    "names": "Right names",
    "ratings": "Ratings",
    "fatigue": "First and second half of the trials (not planned; p not corrected)",
    "duration_legibility": "Correlation of duration with right answers (not planned)",
}
"""Tables of the page, by their files, in their order."""
INDEXED = ("confusion", "answers")


@dataclass
class Analysis:
    """An analysis of trials or of scores.

    Parameters
    ----------
    result
        Planned comparison; None if nothing is compared.
    tables
        Every table, by the name of its file.
    warnings, notes, left_out
        What a reader must know first, what was left out or changed, and people who are in no
        test, each with the reason.
    methods
        Paragraph on what was done, a sentence each.
    sources
        Files, with their checksums.
    """

    title: str
    result: Result | None
    tables: dict[str, DataFrame]
    warnings: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    methods: list[str] = field(default_factory=list)
    sources: list[str] = field(default_factory=list)

    @property
    def sentences(self) -> list[str]:
        """Sentences on what was found."""
        return self.result.sentences if self.result else ["Nothing is compared in such answers."]

    def lines(self) -> Iterator[str]:
        """Return the analysis as lines for a terminal."""
        yield self.title
        for warning in self.warnings:
            yield f"warning: {warning}"
        yield from self.sentences
        for person in self.left_out:
            yield f"left out: {person}"
        for note in self.notes:
            yield f"note: {note}"

    def to_json(self) -> dict[str, Any]:
        """Return the analysis in the terms of JSON; a missing value is null."""
        texts = ("title", "warnings", "sentences", "left_out", "notes", "methods", "sources")
        told = {name: getattr(self, name) for name in texts}
        shown = [name for name in self.tables if name != "trials"]
        tables = {name: _records(_with_index(name, self.tables[name])) for name in shown}
        return {"vbraille": __version__, **told, "tables": tables}

    def write(self, folder: str | Path) -> None:
        """Write the page, the tables and the figures to a new directory, whole or not at all.

        Raises
        ------
        InputError
            If there is such a directory already, or it cannot be made.
        """
        from vbraille.analysis.codebook import codebook
        from vbraille.analysis.figures import draw

        tables = {name: _with_index(name, table) for name, table in self.tables.items()}
        files = {f"tables/{name}.csv": _csv(table) for name, table in tables.items()}
        files["codebook.csv"] = _csv(codebook(tables))
        figures = draw(self.result, self.tables)
        files |= {f"figures/{name}": content for name, content in figures.items()}
        files["results.json"] = msgspec.json.encode(self.to_json())
        files["report.html"] = self._page(list(figures)).encode()
        write_folder(Path(folder), files)

    def _page(self, drawn: list[str]) -> str:
        from vbraille.analysis.figures import alt_of_means

        shown = [(SHOWN[name], self.tables[name]) for name in SHOWN if name in self.tables]
        return render(
            "report.html",
            analysis=self,
            alt=alt_of_means(self.result) if self.result else "",
            shown=[_shown(caption, table) for caption, table in shown if len(table)],
            drawn=drawn,
        )


def _csv(table: DataFrame) -> bytes:
    return table.to_csv(index=False, lineterminator="\n").encode()


def _with_index(name: str, table: DataFrame) -> DataFrame:
    return table.rename_axis("presented").reset_index() if name.startswith(INDEXED) else table


def _records(table: DataFrame) -> list[dict[str, Any]]:
    return msgspec.json.decode(table.to_json(orient="records", double_precision=15))


def _shown(caption: str, table: DataFrame) -> dict[str, Any]:
    """Return a table as the page shows it: as text, and its first rows."""
    more = f" (first {MOST_ROWS} of {len(table)} rows)" if len(table) > MOST_ROWS else ""
    full = table.astype(object).where(table.notna(), "")
    full = full.loc[:, (full != "").any()]
    return {
        "caption": caption + more,
        "columns": [str(name).replace("_", " ") for name in full],
        "rows": [[_text(value) for value in row] for row in full.head(MOST_ROWS).to_numpy(object)],
    }


def _text(value: object) -> str:
    if isinstance(value, float | np.floating):
        return f"{value:.0f}" if float(value).is_integer() else plain(float(value))
    return str(value)


def all_tables(trials: Trials, plan: Plan, asked: DataFrame) -> dict[str, DataFrame]:
    """Return the tables of the planned question, by the names of their files."""
    keys = ["participant", *plan.factors]
    made = {}
    if plan.question == STRINGS:
        made = string_tables(asked)
    elif plan.question == "name":
        counts = tables.confusion(asked["presented"], asked["answered"])
        made["names"] = tables.by_factors(asked, list(plan.factors))
        made["confusion_names"] = counts
        made["answers_names"] = tables.distribution(counts)
    elif plan.question in SIGNALS:
        made["detections"] = detections(asked, keys)
    elif plan.measure == "preferred":
        made["choices"] = tables.choices(asked)
        made["preferences"] = preferences(asked, keys)
    elif plan.measure in ("rating", "adjusted", "magnitude"):
        made["ratings"] = tables.ratings(asked, "answered", list(plan.factors) or ["condition"])
    if plan.question in CHOICES and plan.measure != "preferred":
        made["levels"] = tables.by_difference(asked, differences(asked))
    if plan.question == "detect" and level_of(asked):
        made["levels"] = tables.by_difference(asked, asked[level_of(asked)])
    if plan.measure == "threshold":
        made["thresholds"] = thresholds(asked, keys)
    if "confidence" in asked and asked["confidence"].notna().any():
        made["confidence"] = tables.ratings(asked, "confidence", ["condition", "right"])
    return made | {"trials": trials.frame.astype({"right": int})}


def string_tables(trials: DataFrame) -> dict[str, DataFrame]:
    """Return the tables of strings by the names of their files."""
    each = tables.places(trials)
    own = tables.legibility(trials, each)
    made = {
        "legibility": own,
        "averages": tables.averages(own),
        "strings": tables.named_levels(trials, "string_set"),
        "over_time": tables.over_time(trials),
        "fatigue": tables.fatigue(trials),
        "duration_legibility": tables.duration_legibility(trials),
    }
    if len(each):
        counts = tables.confusion(each["presented"], each["answered"])
        made["characters"] = tables.named_levels(each, "presented")
        made["confusion_characters"] = tables.of_cells(counts)
        made["information"] = tables.all_information(each)
        if tables.is_braille(each):
            made["dots"] = tables.by_dots(each)
            made["errors"] = tables.errors(each)
    if trials["presented"].str.len().eq(2).all():
        pairs = tables.confusion(trials["presented"], trials["answered"])
        made["confusion_pairs"] = tables.of_cells(pairs)
    if "pattern" in trials and trials["pattern"].notna().any():
        made["patterns"] = tables.patterns(trials)
    return made


def tables_of(result: Result) -> dict[str, DataFrame]:
    """Return the tables of a comparison, by the names of their files."""
    cells = result.cells.copy()
    cells.columns = [cell_words(name) for name in cells]
    if result.groups is not None:
        cells.insert(0, str(result.groups.name), result.groups)
    made = {
        "primary_means": result.means,
        "primary_people": cells.reset_index(),
        "primary_effects": result.effects,
        "primary_pairs": result.pairs,
        "primary_simple": result.simple,
    }
    return {name: table for name, table in made.items() if len(table)}


def title_of(result: Result | None, question: str, count: int) -> str:
    """Return the title: what was measured, and of how many people."""
    what = result.measure.name if result else f"answers to {question}"
    tested = people(len(result.cells) if result else count)
    first = what[0].upper() if what[1].isalpha() else what[0]
    return f"{first}{what[1:]}, {tested}"
