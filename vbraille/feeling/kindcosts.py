"""What each kind of pattern has in the time of frames: Lévesque 2009, 8.5.2."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.feeling.costs import batches_of, time_frames
from vbraille.render.scene.stripping import WordKind, emptied, kinds_in, stripped

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from vbraille.feeling.paths import PosedPath
    from vbraille.render.program import Program

COMPOSITION: Final = "composition"
BLANK: Final = "blank"
# All that a frame's time is told apart by, in the order in which it is said and written.
KINDS: Final = (*(kind.value for kind in WordKind), COMPOSITION, BLANK)


# The place where frames cost most is timed by itself, so many times as often as the others: what is
# most of many was most by chance, too.
_CLOSER: Final = 16
_REPEATS: Final = 3


@dataclass(frozen=True, slots=True, eq=False)
class KindCosts:
    """What kinds of patterns have in the time of frames.

    Each is measured by itself, as the difference of two times; so their sum is near the whole but
    not the same, and what costs hardly anything may be a little below 0.

    Parameters
    ----------
    whole_us : float64[n]
        Time of a frame at each batch of frames on a path.
    kinds_us : dict of str to float64[n]
        What each of `KINDS` has in it; 0 of what the picture has not.
    found : tuple of str
        Kinds that the picture has.
    """

    whole_us: NDArray[np.float64]
    kinds_us: dict[str, NDArray[np.float64]]
    found: tuple[str, ...]

    def share(self, kind: str) -> float:
        """Share that a kind has in the time of all frames."""
        return float(self.kinds_us[kind].sum() / self.whole_us.sum())

    @property
    def told_apart(self) -> float:
        """Sum of all kinds as a share of the time of all frames: 1 if nothing was disturbed."""
        return sum(map(self.share, self.kinds_us))


def costs_of_kinds(
    program: Program,
    path: PosedPath,
    most: int,
    repeats: int = _REPEATS,
    timer: Callable[..., NDArray[np.float64]] = time_frames,
) -> tuple[KindCosts, KindCosts]:
    """Time frames with and without the words of each kind of pattern.

    What a kind costs is how much longer a frame takes with its words than without them. What is
    left without the words of any kind is composition - calling the patterns that are in reach and
    putting them together - but for what a frame takes that has nothing on it.

    Parameters
    ----------
    program
        The compiled scene.
    path
        Path of the array.
    most
        Number of the batch of frames that costs most.
    repeats
        How often each batch of frames is timed; the least time counts.
    timer
        Takes and gives what `time_frames` does.

    Returns
    -------
    KindCosts, KindCosts
        Costs on the whole path, and those of the batch that costs most.

    Raises
    ------
    ValueError
        If the path has less than one batch of frames.
    """
    at, found = batches_of(path), kinds_in(program)
    programs = [
        program,
        *(stripped(program, {kind}) for kind in found),
        stripped(program, set(WordKind)),
        emptied(program),
    ]
    everywhere = timer(programs, at, repeats).min(axis=1)
    closer = timer(programs, at[most : most + 1], _CLOSER * repeats).min(axis=1)
    return _told_apart(everywhere, found), _told_apart(closer, found)


def _told_apart(taken_us: NDArray[np.float64], found: list[WordKind]) -> KindCosts:
    """Take times apart: of the whole, without each kind, without all of them, and of nothing."""
    whole, *without, bare, empty = np.maximum(taken_us, 1e-6)  # a coarse clock may say 0
    kinds = {kind: np.zeros(whole.size) for kind in KINDS}
    for kind, other in zip(found, without, strict=True):
        kinds[kind] = whole - other
    # Where all is out of reach a frame is left out, too.
    kinds[BLANK] = np.minimum(empty, bare)
    kinds[COMPOSITION] = bare - kinds[BLANK]
    return KindCosts(whole, kinds, (*(kind.value for kind in found), COMPOSITION, BLANK))
