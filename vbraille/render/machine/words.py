"""The words of compiled scenes: what each tells the machine in `scenekernels`.

A scene is compiled to a program of a small stack machine. Each word works on all actuators at
once: on rows of numbers, one for each, so that its loops become vector instructions and reading the
words costs next to nothing. A word is a whole number, kept as float64: its operation, and
`OPERATIONS` times an argument, as a rule the place of its constants.
"""

# After the head (`vbraille.render.work`): where everything is.
from vbraille.render.work import MOST_SIGNALS, OWN

(
    COLUMN_MM,  # distances between actuators
    ROW_MM,
    LEFT_MM,  # the canvas; beyond it nothing is shown
    TOP_MM,
    RIGHT_MM,
    BOTTOM_MM,
    GRID_LEFT_MM,  # corner of the grid, which is wider than the canvas by the array's radius
    GRID_TOP_MM,
    TILES_PER_MM,
    GRID_COLUMNS,
    GRID_ROWS,
    ORIGIN_X,  # place of the canvas under an array at 0, 0
    ORIGIN_Y,
    SIGNALS,  # how many signals there are, and then each as `SIGNAL_NUMBERS` numbers
    SIGNAL_ROWS,
) = range(OWN, OWN + 15)
SIGNAL_NUMBERS = 12
# Place of the first of the numbers that say, for each tile, where its words begin.
GRID = SIGNAL_ROWS + MOST_SIGNALS * SIGNAL_NUMBERS

OPERATIONS = 64

(
    END,  # the result is in the lowest row of the stack
    RETURN,  # from a pattern's own words
    CALL,  # words of a pattern; argument: 64 · its place + how the result joins the stack
    CALL_PARTS,  # the same, followed by a count and so many places of parts in reach, from its own
    PARTS,  # parts of a pattern: place of a count, which the places of parts follow
    ZERO,  # push 0
    LEVEL,  # push a constant
    DROP,  # take the uppermost away
    ADD,  # the two uppermost, at most 1
    MAXIMUM,
    MULTIPLY,
    OVER,  # r, δ, μ -> δ + (1 - μ) r, at most 1: Lévesque 2009, eq. 8.22
    OVER_ITSELF,  # the same where δ is its own mask
    BLEND,  # δ₁, δ₂, α -> (1 - α) δ₁ + α δ₂: eq. 8.21
    BLEND_FIRST,  # δ₁, α -> (1 - α) δ₁
    SCALE,  # changes of the uppermost: times a constant
    INVERT,
    VIBRATE_HIGH,
    VIBRATE_LOW,
    VIBRATION,  # patterns, which push their deflection
    LINEAR,
    RADIAL,
    AXIAL,
    IMAGE,
    DOTS,
    DOTS_MASK,
    LABEL,
    LABEL_MASK,
    CIRCLE,  # coordinates of shapes: across, along, inside
    SEGMENTS,
    INSIDE,
    STROKE,  # push the deflection of a stroke at these coordinates
    PROFILE,  # push its profile at full amplitude, which is its opacity mask
    FILL,  # fill, stroke -> both
    FILL_BLENDED,  # fill, stroke, profile -> both: eq. 8.20
    FILL_MASK,  # mask -> 1 inside
    WRAP,  # places are wrapped into a tile, until UNWRAP
    UNWRAP,
    MARKERS,  # how much of each place is in a marker of a polygon
    SIGNAL,  # push a signal
    BY_SIGNAL,  # change of the uppermost: times a signal
    GATE,  # push 0, once or twice, instead of the words that follow, if these are shut
    SHIFT,  # places are moved, until UNWRAP
    MOVING_DOTS,  # push dots that move along the path of a shape
    MOVING_DOTS_MASK,
    CUE,  # push what bands along a shape add, and what they hide of it
    PIXELS,  # push an image by its nearest pixels
) = range(47)

# How what a CALL pushes joins what is on the stack: by one of the words from ADD to OVER_ITSELF, or
# not at all, as one row or as a pair.
PUSHED, PUSHED_PAIR = 62, 63
JOINS = 64

# The block of a pattern: its box, its gate, then its words, then its constants. A gate has a bit
# for each signal that shuts it where it is 0, and then one for each that does where it is 1.
BOX_LEFT, BOX_TOP, BOX_RIGHT, BOX_BOTTOM, SHUT_BY, WORDS = range(6)

# Rows of the scratch: places and signs, coordinates of shapes, room, and the stack.
(
    X_ROW,
    Y_ROW,
    SIGN_ROW,
    ACROSS_ROW,
    ALONG_ROW,
    INSIDE_ROW,
    MARKED_ROW,
    PART_ROW,
    FREE_ROW,
    SPARE_ROW,
    GIVEN_ROW,  # the values of the signals, then where the array's centre is
    PLACE_ROW,  # how far along, where the row for that has places in ridges
    STACK,
) = range(13)
CENTER_X, CENTER_Y = MOST_SIGNALS, MOST_SIGNALS + 1
LEAST_LANES = MOST_SIGNALS + 2  # so that these fit into a row
DEPTH = 32  # rows of the stack
SCRATCH_ROWS = STACK + DEPTH
