"""``vbraille power``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from vbraille.cli import options
from vbraille.cli.printing import show
from vbraille.errors import needing_extras

if TYPE_CHECKING:
    from vbraille.analysis.power import PowerRow


def _sizes(text: str) -> list[int]:
    """Numbers of people, such as 4-40, 12 or 6,12,24."""
    found: set[int] = set()
    for part in text.split(","):
        first, _, last = part.partition("-")
        try:
            found.update(range(int(first), int(last or first) + 1))
        except ValueError:
            found.clear()
            break
    if not found:
        raise click.BadParameter(f"{text!r} is no number of people such as 12 or 4-40")
    return sorted(found)


def _effect(text: str) -> dict[str, float]:
    """Values by condition, such as T0=0.5,T25=0.56."""
    number = options.Number()
    named = map(options.pair, text.split(","))
    return {name: number.convert(value, None, None) for name, value in named}


@options.command(
    "power letters --effect T0=0.5,T25=0.56,T100=0.64 --participants 4-40",
    click.argument("protocol"),
    options.option("--effect", type=_effect, required=True, metavar="NAME=VALUE,...",
                   help="Value of the planned measure in each condition, or GROUP:CONDITION."),
    options.option("--participants", type=_sizes, required=True, metavar="4-40",
                   help="Numbers of people."),
    options.option("--between", type=options.Number(0), default=0.5, show_default=True,
                   help="SD of people in all conditions alike: of shares in log odds."),
    options.option("--differing", type=options.Number(0), default=0.0, show_default=True,
                   help="SD of people in each condition by itself."),
    options.option("--studies", type=options.whole(1, 1_000_000), default=1000, show_default=True,
                   help="Studies of each size."),
    options.seed(group=options.FIRST),
    options.json,
)  # fmt: skip
def command(
    protocol: str,
    effect: dict[str, float],
    participants: list[int],
    between: float,
    differing: float,
    studies: int,
    seed: int,
    json: bool,
) -> None:
    """Print how often studies of a protocol find each difference, by their number of people.

    SDs are in log odds of shares, in logarithms of durations and magnitudes, and else in the unit
    of the measure. A difference of two conditions has 1.41 times --differing.
    """
    with needing_extras():
        from vbraille.analysis.power import enough, power, study_of
        from vbraille.sessions.planning.loading import load_protocol

    study = study_of(
        load_protocol(protocol), effect, between=between, differing=differing, seed=seed
    )
    rows = list(power(study, participants, studies=studies, seed=seed))
    least = enough(rows)
    lines = [_line(row) for row in rows]
    for compared, size in least.items():
        told = size or f"more than {participants[-1]}"
        lines.append(f"power 80 %: {compared}: {told} participants")
    show(lines, {"rows": [row._asdict() for row in rows], "enough": least}, as_json=json)


def _line(row: PowerRow) -> str:
    text = f"{row.participants} participants: {row.compared}: "
    if row.half_width is not None:
        return f"{text}95 % interval ± {row.half_width:.3g} on average"
    percent = [f"{100 * (share or 0.0):.1f}" for share in (row.power, row.low, row.high)]
    return "{}power {} % ({} to {} %)".format(text, *percent)
