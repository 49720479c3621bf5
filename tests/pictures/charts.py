"""Charts by hand: small ones of each kind, and those that fill a page."""

import math

from vbraille.pictures.charts import (
    Bars,
    Curve,
    Matrix,
    Path,
    Paths,
    Rise,
    Rises,
    Runs,
    Series,
)


def series(name="T = 0 %", groups=3, missing=()):
    def values(by):
        return tuple(None if n in missing else 40 + n % 7 * 5 + by for n in range(groups))

    return Series(name, values(0), values(-8), values(6))


def bars(groups=("S1", "S2", "S3"), names=("T = 0 %", "T = 25 %"), missing=()):
    several = tuple(series(name, len(groups), missing) for name in names)
    panels = ("legibility (%)", several), ("reading time (s)", several)
    return Bars("Legibility and reading time", "participant", tuple(groups), panels)


def runs(count=1, trials=20):
    correct = tuple(int(n % 4 > 0) for n in range(trials))
    average = tuple(None if n < 9 else sum(correct[n - 9 : n + 1]) / 10 for n in range(trials))
    numbers = tuple(range(1, trials + 1))
    return Runs(
        "Legibility over time",
        tuple(Curve(f"S{n}, textured", numbers, correct, average) for n in range(count)),
    )


def path(start_s=1.0, end_s=7.0):
    time = tuple(n / 100 for n in range(801))
    x = tuple(-10 + 50 * math.sin(math.pi * t / 8) for t in time)
    return Path("one pass", time, x, start_s, end_s, 7.7, (0.0, 4.0, 10.5))


def matrix(counts=((30, 5, 0), (10, 28, 4)), diagonal=(0, 1)):
    return Matrix(
        "Confusions",
        "presented",
        "answered",
        tuple("abcdefghijklmnopqrstuvwxyz"[: len(counts)]),
        tuple("abcdefghijklmnopqrstuvwxyz."[: len(counts[0])]),
        counts,
        (4, 9),
        diagonal,
    )


def rise(across="difference of dot width (mm)"):
    levels, shares = (0.1, 0.2, 0.4, 0.8), (0.52, 0.6, 0.82, 0.97)
    curve = tuple((x / 100, 1 - 0.5 * 2 ** -((x / 30) ** 2)) for x in range(10, 81))
    trials = (40, 40, 20, 10)
    return Rise("S1, which", across, levels, shares, trials, curve, (0.3, 0.22, 0.41))


CHARTS = [
    bars(),
    runs(),
    Paths("Reading patterns", (path(),)),
    matrix(),
    Rises("Thresholds", (rise(), rise("contrast"))),
]
