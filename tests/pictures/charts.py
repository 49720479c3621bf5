"""Charts by hand: small ones of each kind, and those that fill a page."""

import math

from vbraille.pictures.charts import Bars, Curve, Matrix, Path, Paths, Runs, Series


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


CHARTS = [bars(), runs(), Paths("Reading patterns", (path(),)), matrix()]
