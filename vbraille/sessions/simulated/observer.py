"""A simulated reader of legibility sessions: a noisy observer of frames and places.

The reader knows what a hand on the carriage knows: what each contactor did, where the carriage
was, and when. It also knows how braille is laid out on this device. It does not know the page,
the plan, the tuning or the profile. It is for pilots, power analyses and tests. The model is our
own, and claims nothing about anybody's skin.

**What is felt.** The contactors stand at pitch p along x. w is the swing of a row's contactors
away from their idle end; rows that show the same dots are averaged. Between neighbours
i and i + 1 the skin is strained (Lévesque 2009, fig. 3.10) by

    s(u) = [w_{i+1} - w_i] / p,    u = x - S/2 + (i + 1/2) p,                (1)

which depends on the place u alone, whichever pair feels it, and whenever. x is the place of the
array's centre, and S is the array's width. The strain is smoothed twice. One Gaussian of 0.02 mm
is finer than any texture that the program makes. The other stands for the reconstruction filters
(200 Hz, Lévesque 2009, 6.2), and is 3 dB down at 200 Hz / v for a speed v:

    σ² = (0.02 mm)² + [v √(ln 2) / (2π · 200 Hz)]².                          (2)

v is the median speed of the hand while any pair is over the dot; times at which the hand stands
still are left out. The evidence of a dot of nominal width W, centred at c, is the rms rate of
change of the smoothed strain on the way over the dot,

    E = √ mean (ds/du)²,    |u - c| ≤ W / 2,                                 (3)

taken per mm and not per s, since a surface feels much the same at any speed. So a finer texture,
or one with more contrast, is felt more. Evidence is given in units of E₀, which is (3) for the
wave w = [1 + cos(2πu/W)] / 2 without smoothing, and depends on W and p alone. A dot counts as
reached if nine tenths of its width were felt. The line between two neighbouring places that were
felt counts as felt too, unless they are more than W / 2 apart.

**Best of the passes.** A place is 5 µm long. At each place, only the moment that moved the skin
most counts, whichever the pass and the pair. So a pass that a fade or a rest has weakened is
replaced by any better pass, and is not averaged with it.

**The answer.** Gaussian noise of standard deviation `noise` is added to each E / E₀. The values
above half of the largest are averaged, and a dot is read wherever the value exceeds half of that
mean.

**Comparing.** A dot reaches from the first to the last place at which contactors swing more than
the one that swings least. Places less than a tenth of W apart belong to one dot. Noise in units
of the nominal length is added to the width, or to the gap from one dot to the next
(`vbraille.sessions.running.reader`), and the stimulus that is nearer to the nominal length is
chosen.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import PLACES, mask_of
from vbraille.sessions.simulated.skin import (
    STILL_MM_S,
    FeltFrames,
    Wave,
    reference_per_mm2,
    smoothing_mm,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.render.braille.style import BrailleStyle

PLACE_MM = 0.005
LEAST_FELT = 1e-3  # least evidence, in units of E₀, that counts as felt
LEAST_SWING = 1e-4  # least swing, as a share of the largest; at rest it is exactly 0
APART = 0.1  # gap that parts two dots, in units of the nominal dot width


class Observer:
    """A simulated reader by the model of this module; it never changes once it is made.

    Parameters
    ----------
    array, style
        Array that braille is shown with, and the style with its nominal distances.
    noise
        Standard deviation of the noise, 0 or more: in units of E₀ for evidence, and in units of
        the nominal length for lengths.
    """

    def __init__(self, array: Display, style: BrailleStyle, *, noise: float = 0.0) -> None:
        mapping, own = style.mapping, style.rows_on(array)
        self.array = array
        self.geometry = style.geometry
        self.noise = noise
        self._half_mm = array.span_mm / 2
        self._steps = math.ceil(array.column_pitch_mm / PLACE_MM)
        # Rows that show the same dots are one channel; each dot has the number of its channel.
        tables = mapping.left, mapping.right
        rows = {}
        for dot, (side, dot_row) in PLACES.items():
            if dot_row in tables[side]:
                rows[dot] = tuple(r for r, shown in enumerate(tables[side]) if shown == dot_row)
        kinds = sorted({*rows.values()})
        self._channels = {dot: kinds.index(kind) for dot, kind in rows.items()}
        # A frame times these weights gives strains of pairs, or swings of columns, in each channel.
        signs = 1 - 2 * mapping.idle()
        weights = np.zeros((array.rows, len(kinds)))
        for channel, kind in enumerate(kinds):
            weights[own][list(kind), channel] = signs[list(kind)] / len(kind)
        differences = np.diff(np.eye(array.columns), axis=1) / array.column_pitch_mm
        self._pairs = _per_frame(weights, differences)
        self._swings = _per_frame(weights, np.eye(array.columns))

    def felt(self, exploration: FeltFrames, places: int) -> NDArray[np.float64]:
        """Evidence that an exploration gives of the dots of the first cells of a line.

        Parameters
        ----------
        exploration
            Frames, places and times.
        places
            Number of cells; the left edge of the first is at x = 0.

        Returns
        -------
        float64[places, 8]
            E / E₀ by cell and dot; NaN where the hand was not, and for dots that the mapping does
            not show.
        """
        geometry, pitch_mm = self.geometry, self.array.column_pitch_mm
        evidence = np.full((places, 8), np.nan)
        near = self._near(exploration, geometry.extent_mm(places))
        if not near.x_mm.size:
            return evidence
        strain = self._felt(near, self._pairs)
        # Distance of the outermost pair from the centre.
        reach_mm = self._half_mm - 0.5 * pitch_mm
        between_mm = near.x_mm - reach_mm
        wave = Wave.best(between_mm, strain, pitch_mm, self._steps)
        points = pitch_mm / self._steps, geometry.dot_width_mm / 2
        speeds = near.speeds_mm_s()
        moving = speeds > STILL_MM_S
        for place in range(places):
            for side in (0, 1):
                left_mm = place * geometry.cell_pitch_mm + side * geometry.dot_spacing_mm
                right_mm = left_mm + geometry.dot_width_mm
                over = (near.x_mm >= left_mm - reach_mm) & (near.x_mm <= right_mm + reach_mm)
                over &= moving
                speed_mm_s = float(np.median(speeds[over])) if over.any() else 0.0
                rms = wave.rms_rates(left_mm, right_mm, smoothing_mm(speed_mm_s), *points)
                for dot, channel in self._channels.items():
                    if PLACES[dot][0] == side:
                        evidence[place, dot - 1] = rms[channel]
        return evidence / reference_per_mm2(geometry.dot_width_mm, pitch_mm)

    def answer(
        self, evidence: NDArray[np.float64], random: np.random.Generator
    ) -> list[int | None]:
        """Dot masks of the cells felt; None for a cell without the hand, or if nothing was felt."""
        noisy = evidence + self.noise * random.standard_normal(evidence.shape)
        if not (evidence > LEAST_FELT).any():
            return [None] * len(noisy)
        strong = noisy[noisy > np.nanmax(noisy) / 2]
        criterion = strong.mean() / 2 if strong.size else math.inf
        masks = (noisy > criterion) @ [mask_of([dot]) for dot in PLACES]
        rows = zip(masks, noisy, strict=True)
        return [None if np.isnan(row).all() else int(mask) for mask, row in rows]

    def read(
        self, exploration: FeltFrames, places: int, random: np.random.Generator
    ) -> list[int | None]:
        """Dot masks of the first cells of a line; see `felt` and `answer`."""
        return self.answer(self.felt(exploration, places), random)

    def dots_mm(self, exploration: FeltFrames) -> NDArray[np.float64]:
        """Find where each dot column of a line begins and ends, as far as dots were felt.

        Returns
        -------
        float64[n, 2]
            Places on the line, in the order of the columns.
        """
        near = self._near(exploration, self.geometry.travel_mm)
        if not near.x_mm.size:
            return np.empty((0, 2))
        swing = self._felt(near, self._swings)
        swing -= swing.min(axis=1, keepdims=True)
        left_mm = near.x_mm - self._half_mm
        wave = Wave.best(left_mm, swing, self.array.column_pitch_mm, self._steps)
        strength = wave.felt.max(axis=1)
        at = np.flatnonzero(strength > LEAST_SWING * strength.max())
        if not at.size:
            return np.empty((0, 2))
        # An edge is halfway between the last place without a swing and the first with one.
        u_mm = np.pad(wave.u_mm, 1, mode="edge")
        starts_mm = (u_mm[at] + u_mm[at + 1]) / 2
        ends_mm = (u_mm[at + 1] + u_mm[at + 2]) / 2
        gaps_mm = starts_mm[1:] - ends_mm[:-1]
        apart = np.flatnonzero(gaps_mm > APART * self.geometry.dot_width_mm)
        firsts, lasts = np.r_[0, apart + 1], np.r_[apart, at.size - 1]
        return np.column_stack((starts_mm[firsts], ends_mm[lasts]))

    def _near(self, exploration: FeltFrames, right_mm: float) -> FeltFrames:
        """Ticks at which the array is over a line, or at most a dot's width beside it."""
        beside_mm = self._half_mm + self.geometry.dot_width_mm
        return exploration.within(-beside_mm, right_mm + beside_mm)

    def _felt(self, exploration: FeltFrames, weights: NDArray[np.float32]) -> NDArray[np.float32]:
        """Strains of pairs or swings of columns; float32[n, pairs or columns, channels]."""
        frames = exploration.frames.reshape(len(exploration.frames), -1)
        felt = np.asarray(frames, np.float32) @ weights.reshape(len(frames[0]), -1)
        return felt.reshape(len(frames), *weights.shape[1:])


def _per_frame(rows: NDArray[np.float64], columns: NDArray[np.float64]) -> NDArray[np.float32]:
    """Weights of all actuators of a frame; float32[rows · columns, pairs or columns, channels]."""
    weights = np.einsum("rk,cp->rcpk", rows, columns)
    return weights.reshape(-1, *weights.shape[2:]).astype(np.float32)
