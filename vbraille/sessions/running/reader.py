"""The simulated reader as a source of answers: what it feels of a trial, and what it cannot tell.

Each class of `vbraille.sessions.planning.questions` says how it is answered by what is felt.
"""

from __future__ import annotations

from dataclasses import replace
from hashlib import sha256
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from vbraille.errors import InputError
from vbraille.sessions.planning.design import Choice
from vbraille.sessions.planning.style import CONVENTIONAL, Condition
from vbraille.sessions.record.trajectory import columns_of, edges_mm
from vbraille.sessions.running.responses import TrialResponses
from vbraille.sessions.simulated.feeling import CELL_GAP, LENGTHS, DotPair, FeltTrial
from vbraille.sessions.simulated.observer import Observer

if TYPE_CHECKING:
    from collections.abc import Mapping as Named
    from collections.abc import Sequence

    from vbraille.braille.geometry import Geometry
    from vbraille.render import Mapping
    from vbraille.render.braille.models import Model
    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.questionnaire import AnyItem
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.simulated.skin import FeltFrames


def pair_of(
    parameter: str, masks: Sequence[int], mapping: Mapping, geometry: Geometry
) -> DotPair | None:
    """Find two dot columns by which a distance can be told; None if the line has none.

    Parameters
    ----------
    parameter
        "dot_spacing_mm" or "cell_gap_mm".
    masks
        Dot masks of the line's cells, which are the same in all trials and known to the reader.
    mapping, geometry
        Which dots are shown, and the nominal distances.
    """
    columns = columns_of(masks, mapping)
    edges = edges_mm(masks, mapping, geometry)
    for number, (one, two) in enumerate(pairwise(columns)):
        cells = two[0] - one[0]
        if (cells > 0) is (parameter == CELL_GAP):
            return DotPair(len(columns), number, edges[number + 1] - edges[number], cells)
    return None


MOST_NOISE = 100.0
INSTEAD = "type the answers, or give a file of them"


class SimulatedPerson(TrialResponses):
    """A simulated person, whose noise and replies are drawn by protocol, participant and seed.

    Parameters
    ----------
    plan
        Plan of the session.
    noise
        Standard deviation of the noise, in a unit of the person's own.

    Raises
    ------
    InputError
        If the noise is out of range.
    """

    felt = True

    def __init__(self, plan: Plan, noise: float) -> None:
        if not 0 <= noise <= MOST_NOISE:
            raise InputError(f"noise is {noise:g}; it must be 0 to {MOST_NOISE:g}")
        self.name = f"simulated:{noise:g}"
        self._noise = noise
        self._drawn = f"{plan.protocol} {plan.participant} {plan.seed}"
        self._replied = 0

    def reply(self, item: AnyItem, columns: Named[str, str], /) -> tuple[str, int]:
        """Answer to a question of the questionnaire: the right one, or any."""
        self._replied += 1
        random = np.random.default_rng(seed_of(f"{self._drawn} {item.name} {self._replied}"))
        return item.simulate(columns, self._noise, random), 0

    def _random(self, trial: Trial, attempt: int) -> np.random.Generator:
        """Make the generator of an attempt at a trial."""
        drawn = f"{self._drawn} {trial.practice} {trial.number} {attempt}"
        return np.random.default_rng(seed_of(drawn))


class Simulated(SimulatedPerson):
    """A simulated reader, which is given the frames sent to the device, and nothing of the plan.

    Like a person, it has been told the task: where a string begins, how many characters it has,
    which of them are asked for, and by which length two stimuli are compared.

    Parameters
    ----------
    protocol
        Protocol of the session, which has the task and the display's nominal distances.
    plan
        Plan of the session. The noise is drawn by its protocol, participant and seed, and by the
        number and the attempt of the trial.
    noise
        Noise of the reader, described at `vbraille.sessions.simulated.observer`.

    Raises
    ------
    InputError
        If the protocol is for paper, or the noise is out of range.
    """

    def __init__(self, protocol: Protocol, plan: Plan, noise: float = 0.0) -> None:
        if protocol.medium == "paper":
            raise InputError(
                f"{protocol.name} is read on paper, which the simulated reader cannot feel; "
                f"{INSTEAD}"
            )
        if any(protocol.place_of(c) == CONVENTIONAL for c in protocol.conditions):
            raise InputError(
                f"{protocol.name} is read on a conventional display too, which the simulated "
                f"reader cannot feel; {INSTEAD}"
            )
        super().__init__(plan, noise)
        model: Model = protocol.model

        def told(condition: Condition) -> Observer:
            style = protocol.style_of(condition)
            style = replace(model.style, mapping=style.mapping, geometry=style.geometry)
            return Observer(model.display, style, noise=noise)

        self._observers = {c.name: told(c) for c in protocol.conditions}
        self._lead_cells = protocol.lead_cells
        self._parameter = protocol.parameter or ""
        self._question = protocol.asks
        self._pairs = {c.name: _dot_pair(protocol, c) for c in protocol.conditions}
        self._turned: tuple[int, int, int] | None = None  # trial and showings when it turned last
        pairs = isinstance(protocol.design, Choice) and protocol.design.form == "pairs"
        if why := self._question.unfelt(self._parameter, pairs=pairs):
            raise InputError(f"{protocol.name} {why}; {INSTEAD}")

    def next(self, trial: Trial, attempt: int, felt: list[FeltFrames], /) -> tuple[str, int]:
        """Answer to a trial, by what was felt of it."""
        random = self._random(trial, attempt)
        scale = self._question.confidence
        sure = "" if scale is None else f"; {(scale.least + scale.most) // 2}"
        number = len(trial.stimuli)  # of what was turned only the newest counts
        told = FeltTrial(
            self._observers[trial.condition],
            [*felt[: number - 1], felt[-1]],
            [self._lead_cells + len(stimulus.masks) for stimulus in trial.stimuli],
            slice(*(self._lead_cells + place for place in trial.asked)),
            self._parameter,
            self._pairs[trial.condition],
            len(felt) - number,
        )
        line = self._question.simulate(told, self._noise, random)
        if self._question.turns:
            known = None if line == "equal" else (trial.number, attempt, len(felt))
            if known is not None and known == self._turned:
                line, known = "equal", None  # the value was at its end: nothing more was felt
            self._turned = known
        return line + sure, 0


def _dot_pair(protocol: Protocol, condition: Condition) -> DotPair | None:
    """Dots by which a distance is told in a condition; None if none is compared or can be told."""
    design = protocol.design
    if not isinstance(design, Choice) or protocol.parameter not in LENGTHS:
        return None
    style = protocol.style_of(condition)
    line = protocol.line(design.string)
    return pair_of(protocol.parameter, line, style.mapping, style.geometry)


def seed_of(text: str) -> int:
    """Seed, 0 … 2⁶⁴ - 1, made from a text by its SHA-256."""
    return int.from_bytes(sha256(text.encode()).digest()[:8], "big")
