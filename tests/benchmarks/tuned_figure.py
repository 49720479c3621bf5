"""The table and the figure of docs/measured.md on tuning by the answers: FOLDER is where it goes.

``python -m tests.benchmarks.tuned_figure docs/images`` asks 500 simulated people of each kind, by
the same seed as ``python -m tests.benchmarks adaptive``, and writes tuned-people.png.
"""

from __future__ import annotations

import sys
from pathlib import Path

from tests.benchmarks.tuned_people import KINDS, PEOPLE, PROTOCOLS, SEED, Tuned, tune
from vbraille.pictures.charts import Bars, Series
from vbraille.pictures.drawcharts import draw_chart
from vbraille.pictures.figurefiles import save

WAYS = ("90 fixed trials", "30 by the answers", "30 by the answers, six values")


def chart(asked: dict[str, dict[str, Tuned]]) -> Bars:
    """Bars of the errors by protocol and kind of people, with intervals of 95 %."""
    panels = []
    for protocol, kinds in asked.items():
        each = [(tuned.fixed, tuned.adaptive, tuned.six) for tuned in kinds.values()]
        series = []
        for way, name in enumerate(WAYS):
            ends = [Tuned.rmse_between(errors[way]) for errors in each]
            low, middle, high = zip(*ends, strict=True)
            series.append(Series(name, middle, low, high))
        panels.append((f"{protocol}: RMSE (mm)", tuple(series)))
    title = f"How far off the preferred value is found: {PEOPLE} simulated people of each kind"
    return Bars(title, "people", tuple(KINDS), tuple(panels))


if __name__ == "__main__":
    asked = {
        protocol: {kind: tune(kind, PEOPLE, SEED, protocol) for kind in KINDS}
        for protocol in PROTOCOLS
    }
    for protocol, kinds in asked.items():
        for kind, tuned in kinds.items():
            adaptive, six, fixed = tuned.rmse()
            print(
                f"| {protocol}, {kind} | {fixed:.3f} mm | {adaptive:.3f} mm | {six:.3f} mm | "
                f"{adaptive / fixed:.2f} ± {tuned.ratio_error():.2f} | {tuned.inside:.1%} |",
                flush=True,
            )
    save(draw_chart(chart(asked)), Path(sys.argv[1]) / "tuned-people.png")
