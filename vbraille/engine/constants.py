"""Constants of the engine: fades, rest, and what counts as motion."""

from typing import Final

NS_PER_S: Final = 1_000_000_000
FADE_S: Final = 0.1
FADE_NS: Final = round(FADE_S * NS_PER_S)
PAUSE_FADE_NS: Final = 20_000_000
# What a hand moved in a gap of so long, or of more periods, is faded in over so long.
GAP_NS: Final = 4_000_000
GAP_PERIODS: Final = 2.5
CATCH_NS: Final = 50_000_000
# A frame counts for no more of a fade, however late it is.
STEP_NS: Final = 5_000_000
IDLE_NS: Final = 5 * NS_PER_S
SILENCE_NS: Final = 100_000_000
# A hand that moved less than this is at rest: some counts of a fine encoder.
STILL_MM: Final = 0.05
# No hand moves 5 m/s: a carriage that is further within a tick was lost and found again.
JUMP_MM_S: Final = 5_000.0
# How far from its centre an array's actuators are, about: turning it moves them so.
REACH_MM: Final = 10.0
# N poses and M velocities of Lévesque 2009, eqs. 9.4 and 9.5: the velocity is of 59 poses.
DIFFERENCE: Final = 10
MEAN: Final = 50
APART_NS: Final = NS_PER_S // 2  # poses farther apart are two movements
