"""``vbraille scene cost``: the time that frames of a picture take."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from vbraille.cli.old.commands.renderscene import path_options
from vbraille.cli.old.terminal import print_json, say_line
from vbraille.errors import InputError
from vbraille.feeling.composing import compose
from vbraille.feeling.costs import (
    ACTUATOR_BUDGET_US,
    BATCH_FRAMES,
    REPEATS,
    cost_map,
    costs_by_velocity,
    costs_of_elements,
    histogram,
    measure,
    to_csv,
    velocity_map,
)
from vbraille.feeling.loading import load_scene
from vbraille.feeling.paths import path_of
from vbraille.files import check_unused, write_file
from vbraille.render import MODELS
from vbraille.wording import setting

if TYPE_CHECKING:
    import argparse

    from vbraille.feeling.costs import Costs

_RATE_HZ = 1000.0


def run(arguments: argparse.Namespace) -> int:
    """Time the frames of a picture along a path, and say and write what they cost."""
    _check(arguments.out, "out", (".csv",), force=arguments.force)
    _check(arguments.map, "map", (".png", ".svg"), force=arguments.force)
    model = MODELS[arguments.model]
    display = model.display
    loaded = load_scene(arguments.file, model.style)
    path = path_of(path_options(arguments), loaded.scene.canvas, display.span_mm, _RATE_HZ)
    program = compose(loaded, display, rate_hz=_RATE_HZ)
    try:
        costs = measure(program, path)
    except ValueError as error:
        raise InputError(f"{error}; take a longer path") from None
    found = list(costs_of_elements(loaded, display, path, _RATE_HZ)) if arguments.elements else []
    found.sort(key=lambda each: -each.mean_us)
    if arguments.json:
        print_json(
            {
                "frames": costs.frame_us.size * BATCH_FRAMES,
                "median_us": float(np.median(costs.frame_us)),
                "mean_us": float(costs.frame_us.mean()),
                "most_us": float(costs.frame_us.max()),
                "actuator_us": costs.actuator_us,
                "program_bytes": program.nbytes,
                "velocities": [asdict(each) for each in costs_by_velocity(costs)],
                "elements": [asdict(each) for each in found],
            }
        )
    else:
        _say(costs)
        if loaded.scene.signals:
            _say_velocities(costs)
        say_line(f"program: {program.nbytes / 1000:.1f} kB, {len(loaded.scene.elements)} elements")
        for cost in found:
            say_line(
                f"element {cost.name}: {cost.mean_us:.3f} µs of a frame on average, "
                f"{cost.most_us:.2f} µs at most"
            )
    if arguments.out is not None:
        write_file(Path(arguments.out), to_csv(costs).encode(), replace=arguments.force)
        say_line(f"written: {arguments.out}", aside=arguments.json)
    if arguments.map is not None:
        # Only who wants a picture waits for what draws it.
        from vbraille.pictures.drawings import draw_costs

        draw_costs(
            cost_map(costs, loaded.scene.canvas),
            velocity_map(costs),
            Path(arguments.map),
            title=loaded.title,
            frame_us=costs.frame_us,
        )
        say_line(f"written: {arguments.map}", aside=arguments.json)
    return 0


def _check(path: str | None, name: str, suffixes: tuple[str, ...], *, force: bool) -> None:
    """Refuse a file that cannot be written, before anything is measured."""
    if path is None:
        return
    if Path(path).suffix.lower() not in suffixes:
        raise InputError(f"{path} does not end in {' or '.join(suffixes)}; name {setting(name)} so")
    check_unused(Path(path), replace=force)


def _say(costs: Costs) -> None:
    """Say what was measured, one thing a line."""
    frame_us = costs.frame_us
    most = int(frame_us.argmax())
    say_line(f"frames: {frame_us.size * BATCH_FRAMES}, in batches of {BATCH_FRAMES}")
    say_line(f"timed: the median of {REPEATS} repeats of each batch, in memory that is warm")
    say_line(f"clock: tells {costs.resolution_us:.3f} µs of a frame")
    say_line(
        f"frame: median {np.median(frame_us):.2f} µs, mean {frame_us.mean():.2f} µs, "
        f"99 % under {np.percentile(frame_us, 99):.2f} µs"
    )
    say_line(
        f"most: {frame_us[most]:.2f} µs, at {costs.x_mm[most]:.0f} mm from the left, "
        f"{costs.y_mm[most]:.0f} mm from the top"
    )
    say_line(
        f"actuator: {costs.actuator_us:.3f} µs of the {ACTUATOR_BUDGET_US:.1f} µs that each of "
        f"64 has at 1000 frames a second"
    )
    for low, high, share in histogram(costs):
        if share:
            say_line(f"histogram: {low:.2f} to {high:.2f} µs: {share:.1%}")


def _say_velocities(costs: Costs) -> None:
    """Say what frames cost under a hand of each speed and direction."""
    for cost in costs_by_velocity(costs):
        say_line(
            f"hand at {cost.from_mm_s:.0f} to {cost.to_mm_s:.0f} mm/s, {cost.direction}: mean "
            f"{cost.mean_us:.2f} µs, {cost.most_us:.2f} µs at most"
        )
