"""Maps of the predictions over a grid."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

from vbraille.pictures.heatmaps import MapPanel, ShareMap

if TYPE_CHECKING:
    from vbraille.forecast.grids import GridFile, Prediction

_TITLE = "Characters read rightly (%)\nsimulated reader, no data about people"


def map_of(grid: GridFile, found: list[Prediction]) -> ShareMap:
    """Map of legibility: what has most values goes down, the speed across, a panel for the rest.

    Where there is one speed alone, what has the second most values goes across.
    """
    points = grid.points()
    values = {name: list(dict.fromkeys(p[name] for p in points)) for name in grid.varied}
    ranked = sorted(values, key=lambda name: -len(values[name]))
    speed = "speed_mm_s"
    down = next(name for name in ranked if name != speed)
    across = speed if len(values[speed]) > 1 else next(name for name in ranked if name != down)
    others = [name for name in values if name not in (down, across)]
    shares = {tuple(one.point.values()): one.legibility for one in found}

    def share(chosen: dict[str, object]) -> float | None:
        return shares.get(tuple(chosen[name] for name in grid.varied))

    panels = []
    for rest in product(*(values[name] for name in others)):
        fixed = dict(zip(others, rest, strict=True))
        title = ", ".join(f"{name} {_label(value)}" for name, value in fixed.items())
        rows = tuple(
            tuple(share({**fixed, down: row, across: column}) for column in values[across])
            for row in values[down]
        )
        panels.append(MapPanel(title, rows))
    labels = [tuple(map(_label, values[name])) for name in (down, across)]
    return ShareMap(_TITLE, down, across, labels[0], labels[1], tuple(panels))


def _label(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)
