"""``vbraille power``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from vbraille.cli import options
from vbraille.cli.printing import print_json, say
from vbraille.errors import needing_extras

if TYPE_CHECKING:
    from vbraille.analysis.power import PowerRow


class Sizes(click.ParamType):
    """Numbers of people, such as 4-40, 12 or 6,12,24."""

    name = "sizes"

    def convert(self, value, param, ctx):
        """Return a list of numbers."""
        found = []
        for part in value.split(","):
            first, _, last = part.strip().partition("-")
            try:
                found += range(int(first), int(last or first) + 1)
            except ValueError:
                self.fail(f"{part.strip()!r} is no number of people such as 12 or 4-40", param, ctx)
        return sorted(set(found)) or self.fail(f"{value!r} is an empty range", param, ctx)


class Effect(click.ParamType):
    """Values by condition, such as T0=0.5,T25=0.56."""

    name = "effect"

    def convert(self, value, param, ctx):
        """Return a dict of numbers."""
        found = {}
        for part in value.split(","):
            name, _, number = part.partition("=")
            try:
                found[name.strip()] = float(number)
            except ValueError:
                self.fail(f"{part.strip()!r} is no value such as T0=0.5", param, ctx)
        return found


@click.command(
    cls=options.Command,
    epilog="Example: vbraille power letters --effect T0=0.5,T25=0.56,T100=0.64 --participants 4-40",
)
@click.argument("protocol")
@options.takes(
    options.option("--effect", type=Effect(), required=True, metavar="NAME=VALUE,...",
                   help="Value of the planned measure in each condition, or GROUP:CONDITION."),
    options.option("--participants", type=Sizes(), required=True, metavar="4-40",
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
    if json:
        print_json({"rows": [row._asdict() for row in rows], "enough": least})
        return
    for row in rows:
        say(_line(row))
    for compared, size in least.items():
        told = f"{size} participants" if size else f"more than {participants[-1]} participants"
        say(f"power 80 %: {compared}: {told}")


def _line(row: PowerRow) -> str:
    text = f"{row.participants} participants: {row.compared}: "
    if row.half_width is not None:
        return f"{text}95 % interval ± {row.half_width:.3g} on average"
    assert row.power is not None
    assert row.low is not None
    assert row.high is not None
    return f"{text}power {100 * row.power:.1f} % ({100 * row.low:.1f} to {100 * row.high:.1f} %)"
