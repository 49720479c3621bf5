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
(`vbraille.sessions.simulated.feeling`), and the stimulus that is nearer to the nominal length is
chosen.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vbraille.braille.cells import PLACES, mask_of

if TYPE_CHECKING:
    from vbraille.display import Display
    from vbraille.render.braille.style import BrailleStyle

Floats = NDArray[np.float64]

CUTOFF_HZ = 200.0
FINEST_MM = 0.02
STILL_MM_S = 1.0
SPEED_SPAN_S = 0.02  # time for measuring a speed; counts of 45 µm make it 2 mm/s exact
MOST_MM_S = 1000.0
PLACE_MM = 0.005
LEAST_FELT = 1e-3  # least evidence, in units of E₀, that counts as felt
LEAST_SWING = 1e-4  # least swing, as a share of the largest; at rest it is exactly 0
APART = 0.1  # gap that parts two dots, in units of the nominal dot width
_REACHED = 0.9  # share of a way that must have been felt
_MOST = 1000  # points of a dot
_LEAST = np.finfo(float).tiny
_TAILS = 4  # reach of a kernel in standard deviations


@dataclass(frozen=True, slots=True, eq=False)
class FeltFrames:
    """Frames that a hand was given, with places and times, tick by tick.

    Parameters
    ----------
    frames : float[n, rows, columns]
        Deflections that were sent, 0 … 1.
    x_mm : float64[n]
        Places of the array's centre; NaN where one is not known.
    time_s : float64[n]
        Times of the ticks, counted from any moment.
    y_mm, theta_rad : float64[n], optional
        Places down the canvas, and angles by which the array is turned, where a picture is felt.
    """

    frames: NDArray[np.floating]
    x_mm: Floats
    time_s: Floats
    y_mm: Floats | None = None
    theta_rad: Floats | None = None

    def within(self, low_mm: float, high_mm: float) -> FeltFrames:
        """Ticks whose place is known, with the array's centre between two places."""
        near = (self.x_mm >= low_mm) & (self.x_mm <= high_mm)
        if near.all():
            return self
        return FeltFrames(self.frames[near], self.x_mm[near], self.time_s[near])

    def speeds_mm_s(self) -> Floats:
        """Speed at each tick, never negative; float64[n]."""
        before = np.maximum(self.time_s - SPEED_SPAN_S / 2, self.time_s[0])
        after = np.minimum(self.time_s + SPEED_SPAN_S / 2, self.time_s[-1])
        way = np.interp(after, self.time_s, self.x_mm) - np.interp(before, self.time_s, self.x_mm)
        return np.abs(way) / np.maximum(after - before, 1e-9)


def smoothing_mm(speed_mm_s: float) -> float:
    """Width σ of the smoothing by equation 2 at a speed, in mm."""
    per_mm_s = math.sqrt(math.log(2)) / (2 * math.pi * CUTOFF_HZ)
    return math.hypot(FINEST_MM, min(speed_mm_s, MOST_MM_S) * per_mm_s)


def reference_per_mm2(width_mm: float, pitch_mm: float) -> float:
    """Unit of evidence E₀: equation 3 for the wave [1 + cos(2πu/W)] / 2, not smoothed."""
    u_mm = np.linspace(-width_mm / 2, width_mm / 2, 2001)

    def wave(at_mm: Floats) -> Floats:
        inside = np.abs(at_mm) < width_mm / 2
        return np.where(inside, (1 + np.cos(2 * np.pi * at_mm / width_mm)) / 2, 0.0)

    strain = (wave(u_mm + pitch_mm / 2) - wave(u_mm - pitch_mm / 2)) / pitch_mm
    return float(np.sqrt(np.mean(np.gradient(strain, u_mm) ** 2)))


class Wave(NamedTuple):
    """Strains or swings felt along a line, at the places that sensors came over.

    Parameters
    ----------
    u_mm : float64[m]
        Places along the line, increasing.
    felt : float64[m, channels]
        Strongest values that were felt at each place.
    """

    u_mm: Floats
    felt: Floats

    @classmethod
    def best(cls, x_mm: Floats, felt: NDArray[np.floating], pitch_mm: float) -> Wave:
        """Keep the strongest values that were felt at each place.

        Of all that sensors felt at one place of the line, what had most energy is kept. So each
        value was really felt, exactly where it says.

        Parameters
        ----------
        x_mm : float64[n]
            Places of the first sensor, n > 0.
        felt : float[n, sensors, channels]
            Values felt by sensors that stand a pitch apart.
        pitch_mm
            Distance between two sensors, which is a whole number of places.
        """
        u_mm = (x_mm[:, None] + pitch_mm * np.arange(felt.shape[1])).ravel()
        values = felt.reshape(u_mm.size, -1).astype(np.float64)
        place = ((u_mm - u_mm.min()) / _place_mm(pitch_mm)).astype(np.intp)
        order = np.lexsort(((values**2).sum(axis=1), place))
        kept = order[np.append(np.diff(place[order]) > 0, True)]
        kept = kept[np.argsort(u_mm[kept])]
        return cls(u_mm[kept], values[kept])

    def rms_rates(
        self, left_mm: float, right_mm: float, sigma_mm: float, step_mm: float, gap_mm: float
    ) -> Floats:
        """Rms rates of the smoothed wave between two places, by equation 3.

        The smoothed wave is a weighted mean. The weight of a value is the length of the line that
        it stands for, times a Gaussian of its distance. The sum is divided by that of the weights,
        so that uneven places do not look like waves.

        Parameters
        ----------
        sigma_mm
            Width of the smoothing.
        step_mm
            Distance between the points at which the rate is taken.
        gap_mm
            Longest distance between two values between which the line counts as felt.

        Returns
        -------
        float64[channels]
            Rates; NaN if too little of the way was felt.
        """
        points = min(round((right_mm - left_mm) / step_mm), _MOST)
        at_mm, step_mm = np.linspace(left_mm, right_mm, points + 1, retstep=True)
        gaps_mm = np.diff(self.u_mm)
        halves = np.minimum(gaps_mm, gap_mm) / 2
        stands_for = np.append(halves, gap_mm / 2) + np.append(gap_mm / 2, halves)
        after = np.searchsorted(self.u_mm, at_mm[:-1] + step_mm / 2)
        covered = np.concatenate(([False], gaps_mm <= gap_mm, [False]))[after]
        if np.mean(covered) < _REACHED:
            return np.full(self.felt.shape[1], np.nan)
        reach_mm = _TAILS * sigma_mm
        near = slice(*np.searchsorted(self.u_mm, (left_mm - reach_mm, right_mm + reach_mm)))
        away = (at_mm[:, None] - self.u_mm[near]) / sigma_mm
        weights = np.exp(-(away**2) / 2) * stands_for[near]
        smooth = weights @ self.felt[near] / np.maximum(weights.sum(axis=1, keepdims=True), _LEAST)
        rates = np.diff(smooth, axis=0)[covered] / step_mm
        return np.sqrt(np.mean(rates**2, axis=0))


def _place_mm(pitch_mm: float) -> float:
    """Length of a place, of which a pitch has a whole number."""
    return pitch_mm / math.ceil(pitch_mm / PLACE_MM)


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
        # Rows that show the same dots are one channel; each dot has the number of its channel.
        tables = mapping.left, mapping.right
        rows = {
            dot: tuple(r for r, shown in enumerate(tables[side]) if shown == dot_row)
            for dot, (side, dot_row) in PLACES.items()
            if dot_row in tables[side]
        }
        kinds = sorted({*rows.values()})
        self._channels = {dot: kinds.index(kind) for dot, kind in rows.items()}
        # A column of a frame times these weights is its swing in each channel.
        signs = 1 - 2 * mapping.idle()
        self._weights = np.zeros((array.rows, len(kinds)), np.float32)
        for channel, kind in enumerate(kinds):
            self._weights[own][list(kind), channel] = signs[list(kind)] / len(kind)

    def felt(self, exploration: FeltFrames, places: int) -> Floats:
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
        width_mm = geometry.dot_width_mm
        evidence = np.full((places, 8), np.nan)
        near = self._near(exploration, geometry.extent_mm(places))
        if not near.x_mm.size:
            return evidence
        # Distance of the outermost pair from the centre.
        reach_mm = (self.array.span_mm - pitch_mm) / 2
        strain = np.diff(self._swings(near), axis=1) / pitch_mm
        wave = Wave.best(near.x_mm - reach_mm, strain, pitch_mm)
        speeds = near.speeds_mm_s()
        moving = speeds > STILL_MM_S
        for place in range(places):
            for side in (0, 1):
                left_mm = place * geometry.cell_pitch_mm + side * geometry.dot_spacing_mm
                right_mm = left_mm + width_mm
                over = (near.x_mm >= left_mm - reach_mm) & (near.x_mm <= right_mm + reach_mm)
                over &= moving
                sigma_mm = smoothing_mm(float(np.median(speeds[over])) if over.any() else 0.0)
                rms = wave.rms_rates(left_mm, right_mm, sigma_mm, _place_mm(pitch_mm), width_mm / 2)
                for dot, channel in self._channels.items():
                    if PLACES[dot][0] == side:
                        evidence[place, dot - 1] = rms[channel]
        return evidence / reference_per_mm2(width_mm, pitch_mm)

    def answer(self, evidence: Floats, random: np.random.Generator) -> list[int | None]:
        """Dot masks of the cells felt; None for a cell without the hand, or if nothing was felt."""
        noisy = evidence + self.noise * random.standard_normal(evidence.shape)
        if not (evidence > LEAST_FELT).any():
            return [None] * len(noisy)
        strong = noisy[noisy > np.nanmax(noisy) / 2]
        criterion = strong.mean() / 2 if strong.size else math.inf
        masks = (noisy > criterion) @ [mask_of([dot]) for dot in PLACES]
        rows = zip(masks, noisy, strict=True)
        return [None if np.isnan(row).all() else int(mask) for mask, row in rows]

    def dots_mm(self, exploration: FeltFrames) -> Floats:
        """Find where each dot column of a line begins and ends, as far as dots were felt.

        Returns
        -------
        float64[n, 2]
            Places on the line, in the order of the columns.
        """
        near = self._near(exploration, self.geometry.travel_mm)
        if not near.x_mm.size:
            return np.empty((0, 2))
        swing = self._swings(near)
        swing -= swing.min(axis=1, keepdims=True)
        left_mm = near.x_mm - self.array.span_mm / 2
        u_mm, felt = Wave.best(left_mm, swing, self.array.column_pitch_mm)
        strength = felt.max(axis=1)
        at = np.flatnonzero(strength > LEAST_SWING * strength.max())
        if not at.size:
            return np.empty((0, 2))
        gaps_mm = np.diff(u_mm[at]) * (np.diff(at) > 1)
        apart = np.flatnonzero(gaps_mm > APART * self.geometry.dot_width_mm)
        firsts, lasts = np.r_[0, apart + 1], np.r_[apart, at.size - 1]
        return np.column_stack((u_mm[at[firsts]], u_mm[at[lasts]]))

    def _near(self, exploration: FeltFrames, right_mm: float) -> FeltFrames:
        """Ticks at which the array is over a line, or at most a dot's width beside it."""
        beside_mm = self.array.span_mm / 2 + self.geometry.dot_width_mm
        return exploration.within(-beside_mm, right_mm + beside_mm)

    def _swings(self, exploration: FeltFrames) -> NDArray[np.float32]:
        """Swings of the columns; float32[n, columns, channels]."""
        frames = np.asarray(exploration.frames, np.float32)
        return np.tensordot(frames, self._weights, (1, 0))
