"""Predictions of the simulated reader over a grid of styles, texts and speeds; no data on people.

Each point of the grid is read in one even pass, at 1,000 frames a second, string after string.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from itertools import product
from math import inf, prod
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import msgspec
import numpy as np

from vbraille.braille.geometry import BOUNDS_MM
from vbraille.errors import VbrailleError, check_range
from vbraille.files import read_text
from vbraille.forecast.workers import KeptResults, work_on
from vbraille.render import MODELS
from vbraille.sessions.planning.spellings import Masks, SpellingKeys, spelled
from vbraille.sessions.simulated.observer import Observer
from vbraille.sessions.simulated.skin import FeltFrames
from vbraille.tomlfile import Table, TomlFile, which

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from vbraille.forecast.workers import Workers
    from vbraille.render import BrailleStyle

TUNED = ("texture", "contrast")
MOST_POINTS = 100_000
MOST_ANSWERS = 10_000
FASTEST_MM_S = 1000.0
_RATE_HZ = 1000.0
_BESIDE_MM = 2.0


class GridFile(Table, frozen=True, kw_only=True):
    """The keys of a grid's file.

    Parameters
    ----------
    format
        Format of the file, which is 1.
    model_name
        Name of the display's model.
    texts
        Strings of each text, by its name.
    style
        Values of each part of the style that is varied: ``texture``, ``contrast``, or a distance
        of the geometry in mm. All are crossed.
    speeds_mm_s
        Speeds of the hand.
    noise
        Noise of the simulated reader.
    answers
        How often each string is answered, each time with other noise.
    seed
        What the noise is drawn by.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    format: Literal[1]
    model_name: str = msgspec.field(name="model")
    texts: dict[str, tuple[Masks, ...]]
    style: dict[str, tuple[float, ...]] = msgspec.field(default_factory=dict)
    speeds_mm_s: tuple[float, ...]
    noise: float = 0.4
    answers: int = 20
    seed: int = 1

    def __post_init__(self) -> None:
        if self.model_name not in MODELS:
            raise ValueError(f"model is {self.model_name!r}{which(self.model_name, MODELS)}")
        known = (*TUNED, *BOUNDS_MM)
        for name, values in self.style.items():
            if name not in known:
                raise ValueError(f"[style] has {name!r}{which(name, known)}")
            _check_values(f"[style] {name}", values)
        _check_values("speeds_mm_s", self.speeds_mm_s)
        for speed in self.speeds_mm_s:
            check_range("speeds_mm_s: one", speed, 1, FASTEST_MM_S, " mm/s")
        if not self.texts:
            raise ValueError("[texts] has none; give one or more, such as letters = ['a', 'c']")
        for name, strings in self.texts.items():
            if not strings or not all(map(any, strings)):
                raise ValueError(f"[texts] {name} has no string, or one without dots")
        check_range("noise", self.noise, 0, 100)
        check_range("answers", self.answers, 1, MOST_ANSWERS)
        check_range("seed", self.seed, 0, 2**63 - 1)
        sizes = (*map(len, self.style.values()), len(self.texts), len(self.speeds_mm_s))
        if prod(sizes) > MOST_POINTS:
            raise ValueError(f"the grid has more than {MOST_POINTS} points; make it smaller")
        span_mm = MODELS[self.model_name].display.span_mm
        for values in product(*self.style.values()):
            style = self.style_at(dict(zip(self.style, values, strict=True)))
            style.geometry.cells_per_line(span_mm)

    @property
    def varied(self) -> list[str]:
        """Names of what is varied, in the order of the table's columns."""
        return [*self.style, "text", "speed_mm_s"]

    def points(self) -> list[dict[str, Any]]:
        """Points of the grid: a value of each that is varied."""
        values = (*self.style.values(), tuple(self.texts), self.speeds_mm_s)
        return [dict(zip(self.varied, point, strict=True)) for point in product(*values)]

    def style_at(self, point: dict[str, Any]) -> BrailleStyle:
        """Style at a point, of which the values of the style count.

        Raises
        ------
        ValueError
            If its values contradict each other.
        """
        style = MODELS[self.model_name].style
        tuned = {name: point[name] for name in self.style if name in TUNED}
        lengths = {name: point[name] for name in self.style if name not in TUNED}
        return replace(
            style,
            tuning=replace(style.tuning, **tuned),
            geometry=replace(style.geometry, **lengths),
        )


def _check_values(name: str, values: tuple[float, ...]) -> None:
    if not values:
        raise ValueError(f"{name} has no value; give one or more")
    if len(set(values)) < len(values):
        raise ValueError(f"{name} has a value twice; leave one out")
    if not all(-inf < value < inf for value in values):
        raise ValueError(f"{name} has a value that is no number")


class GridTask(NamedTuple):
    """A point of a grid, with its number."""

    grid: GridFile
    point: dict[str, Any]
    number: int


@dataclass(frozen=True, slots=True)
class Prediction:
    """Result of the simulated reader at a point: right and all characters, and right strings."""

    point: dict[str, Any]
    characters: int
    right: int
    strings: int
    strings_right: int

    @property
    def legibility(self) -> float:
        """Share of the characters that were read rightly, each in its place; 0…1."""
        return self.right / self.characters

    def row(self) -> dict[str, Any]:
        """Row of the table."""
        return {
            **self.point,
            "characters": self.characters,
            "right": self.right,
            "legibility": self.legibility,
            "strings": self.strings,
            "strings_right": self.strings_right,
            "answers_from_whom": "simulated reader, no data about people",
        }


def read_grid(text: str, where: str) -> GridFile:
    """Read a grid from the text of its file.

    Raises
    ------
    InputError
        If it cannot be used; one sentence says where, and why.
    """
    return TomlFile(text, where).read(GridFile, spelled(SpellingKeys()))


def predict_point(task: GridTask) -> list[int]:
    """Characters, those right, strings, and those right, at a point of a grid."""
    grid, point = task.grid, task.point
    model, style = MODELS[grid.model_name], grid.style_at(point)
    observer = Observer(model.display, style, noise=grid.noise)
    sequence = np.random.SeedSequence(grid.seed, spawn_key=(task.number,))
    random = np.random.Generator(np.random.PCG64(sequence))
    counts = np.zeros(4, np.int64)
    for masks in grid.texts[point["text"]]:
        program = style.render(np.array(masks, np.uint8), model.display)
        aside_mm = model.display.span_mm / 2 + _BESIDE_MM
        way_mm = style.geometry.extent_mm(len(masks)) + 2 * aside_mm
        time_s = np.arange(int(way_mm / point["speed_mm_s"] * _RATE_HZ) + 1) / _RATE_HZ
        x_mm = time_s * point["speed_mm_s"] - aside_mm
        touch = observer.felt(FeltFrames(program.path(x_mm), x_mm, time_s), len(masks))
        shown = style.mapping.shown_dots()
        wanted = [mask & shown for mask in masks]
        for _ in range(grid.answers):
            answer = observer.answer(touch, random)
            right = np.array([one == other for one, other in zip(answer, wanted, strict=True)])
            counts += (right.size, int(right.sum()), 1, int(right.all()))
    return counts.tolist()


def predict(
    path: str,
    workers: Workers,
    *,
    keep: Path | None = None,
    report: Callable[[int, int], None] = lambda _done, _all: None,
) -> tuple[GridFile, list[Prediction], VbrailleError | None]:
    """Ask the simulated reader about each point of a grid.

    Parameters
    ----------
    path
        TOML file of the grid; docs/lab.md has one.
    workers
        Who works; the numbers do not depend on it.
    keep
        File that keeps what is done, so that work that was ended goes on; None for none.
    report
        Function that is called with how many points are done, and how many there are.

    Returns
    -------
    GridFile, list of Prediction, VbrailleError or None
        The grid, its points that are done, in order, and what ended the work early.

    Raises
    ------
    InputError
        If the file cannot be used, or `keep` is of another one.
    """
    text = read_text(path, "grid")
    grid = read_grid(text, path)
    points = grid.points()
    kept = KeptResults(keep, {"grid": text})
    tasks = [GridTask(grid, point, number) for number, point in enumerate(points)]
    ended = work_on(workers, predict_point, tasks, kept, report)
    found = [Prediction(points[number], *kept.found[number]) for number in sorted(kept.found)]
    if not found and ended is not None:
        raise ended
    return grid, found, ended


def to_json(grid: GridFile, found: list[Prediction]) -> dict[str, Any]:
    """Predictions in the terms of JSON."""
    return {
        "about": "simulated reader, no data about people",
        "varied": grid.varied,
        "points": [asdict(one) | {"legibility": one.legibility} for one in found],
    }
