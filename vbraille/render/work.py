"""Places of the numbers that kernels work with: in a program, and in what each tick tells them.

A program is two plain arrays: ``numbers``, float64[n], and ``table``, uint16[m]. The numbers of
every kind begin with the same head; what follows is the kind's own.
"""

from enum import IntEnum

MOST_SIGNALS = 8  # of a scene; a text, which has none, does not load what reads scenes


class ProgramKind(IntEnum):
    """Kinds of programs; only kernels distinguish them."""

    LINE = 0
    PAGE = 1
    VIBRATION = 2
    SCENE = 3


# The head, which is alike for every kind; the engine reads it.
(
    KIND,  # a number of `ProgramKind`
    OWN_Y,  # y of the array on a carriage that has no such axis, mm
    FREQUENCY,  # at which a picture moves by itself, Hz; 0 if it does not
    AMPLITUDE,  # its largest swing of an actuator by itself, as a share of the full swing
    EXPOSURE,  # how long it may move by itself before it fades, s
    TILT,  # angle of the array beyond which nothing is shown, rad; infinite if any will do
    ROWS,  # rows and columns of the display that it was compiled for
    COLUMNS,
    OWN,  # first of the numbers whose meaning differs from kind to kind
) = range(9)

# Braille: a line, or a page of lines.
(
    ANCHOR,  # from the left column to the point of the array that x tells, mm
    COLUMN_PITCH,
    ROW_PITCH,
    LINES,  # how many lines the page has; 0 for a line alone
    LINE_PITCH,
    HYSTERESIS,  # distance between going to the next line and coming back, in line pitches
    FREE,  # 1 if each actuator shows what lies under it, 0 if rows keep to the line's rows of dots
    DOT_ROW_PITCH,  # from one row of dots to the next, mm
    SLOTS,  # slots of a line: 2 · (cells + 2)
    CELLS_PER_MM,
    CELL_PITCH,
    DOTS_PER_MM,
    DOT_SPACING,
    PROFILE,
    OVERLAP,  # 1 if two dots can be under one place
    SHAPE,  # the 6 coefficients of the profile
    _S1,
    _S2,
    _S3,
    _S4,
    _S5,
    IDLE,  # deflection of each row off the dots, then how far and which way a dot swings it
) = range(OWN, OWN + 22)

# Numbers that a frame is evaluated at: pose, the picture's own time, velocity, the states of
# switches (three bits for each signal), the values of signals, and what these remember.
X, Y, THETA, TIME, VX, VY, SWITCHES, SIGNAL = range(8)
MEMORY = SIGNAL + MOST_SIGNALS
AT = MEMORY + MOST_SIGNALS

# Rows of the kernels' scratch: the swing under each column, and the slot that the column is over.
SWING, SLOT = range(2)
# How long a scene that moves by itself is shown to a hand that does not, s.
PATIENCE_S = 60.0
# Value for no part: no line of a page was under the array yet.
NO_PART = -2
