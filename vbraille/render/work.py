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
    SCENE = 2


# The head, which is alike for every kind; the engine reads it.
(
    KIND,  # a number of `ProgramKind`
    OWN_Y,  # y of the array on a carriage that has no such axis, mm
    FREQUENCY,  # at which a picture moves by itself, Hz; 0 if it does not
    AMPLITUDE,  # its largest swing of an actuator by itself, as a share of the full swing
    TILT,  # angle of the array beyond which nothing is shown, rad; infinite if any will do
    ROWS,  # rows and columns of the display that it was compiled for
    COLUMNS,
    COLUMN_PITCH,
    ROW_PITCH,
    CENTER,  # from the point of the array that x tells to its middle, mm
    ORIGIN_X,  # place of the canvas under an array at 0, 0
    ORIGIN_Y,
    OWN,  # first of the numbers whose meaning differs from kind to kind
) = range(13)

# A line, or a page of lines.
(
    HYSTERESIS,  # distance between going to the next line and coming back, in line pitches
    FREE,  # 1 if each actuator shows what lies under it, 0 if rows keep to the line's rows of dots
    CELLS,  # numbers of the cells
) = range(OWN, OWN + 3)

# Places of the numbers of lines of cells.
(
    LEFT,  # corner of the first cell, mm
    TOP,
    COSINE,  # of the direction of the lines
    SINE,
    WIDTH,  # of the rectangle of the cells, mm
    HEIGHT,
    LINES,
    LINE_PITCH,
    DOT_ROW_PITCH,
    SLOTS,  # slots of a line
    CELL_PITCH,
    DOT_SPACING,
    DOT_WIDTH,
    TABLE,  # first of the words in the table
    APART,  # 1 if no two columns of dots can be over one place
    CONTRAST,
    PROFILE,
    SHAPE,  # the 6 coefficients of the profile
) = range(18)
CELL_NUMBERS = SHAPE + 6

FADE_MM = 1.0  # over which the opacity of a label ends
LAST_ROW = 3  # of dots

# A scene.
(
    RIGHT_MM,  # the canvas, from 0; beyond it nothing is shown
    BOTTOM_MM,
    INSTRUCTIONS,  # how many there are
    SIGNALS,  # number of signals, and then each as `SIGNAL_NUMBERS` numbers
    SIGNAL_ROWS,
) = range(OWN, OWN + 5)
SIGNAL_NUMBERS = 12
CODE = SIGNAL_ROWS + MOST_SIGNALS * SIGNAL_NUMBERS  # place of the first instruction

# Numbers that a frame is evaluated at: pose, the picture's own time, velocity, the states of
# switches (three bits for each signal), the values of signals, and what these remember.
X, Y, THETA, TIME, VX, VY, SWITCHES, SIGNAL = range(8)
MEMORY = SIGNAL + MOST_SIGNALS
AT = MEMORY + MOST_SIGNALS

# Rows of the kernels' scratch: the places of actuators, and then either the swing at each and the
# slot that it is over, or rows of the evaluator: which way each vibrates, coordinates of shapes,
# values of signals, a stack of deflections, and the instructions that matter.
X_ROW, Y_ROW, SWING, SLOT = range(4)
(
    SIGN_ROW,
    ACROSS_ROW,
    ALONG_ROW,
    INSIDE_ROW,
    PART_ROW,
    GIVEN_ROW,
    STACK_ROW,
) = range(2, 9)
DEPTH = 32  # values on the evaluator's stack
LIVE_ROW = STACK_ROW + DEPTH + 1
# How long a scene that moves by itself is shown to a hand that does not, s.
PATIENCE_S = 60.0
# Value for no part: no line of a page was under the array yet.
NO_PART = -2
