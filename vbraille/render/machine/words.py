"""The words of compiled scenes: what each tells the machine in `scenekernels`.

A scene is compiled to a program of a small stack machine. Each word works on all actuators at
once: on rows of numbers, one for each, so that its loops become vector instructions and reading the
words costs next to nothing. A word is a whole number, kept as float64: its operation, and
`OPERATIONS` times an argument, as a rule the place of its constants.
"""

# After the head (`vbraille.render.work`): where everything is.
from vbraille.render.work import OWN

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
    GRID,  # place of the first of the numbers that say, for each tile, where its words begin
) = range(OWN, OWN + 12)

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
) = range(39)

# How what a CALL pushes joins what is on the stack: by one of the words from ADD to OVER_ITSELF, or
# not at all, as one row or as a pair.
PUSHED, PUSHED_PAIR = 62, 63
JOINS = 64

# The block of a pattern: its box, then its words, then its constants.
BOX_LEFT, BOX_TOP, BOX_RIGHT, BOX_BOTTOM, WORDS = range(5)

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
    STACK,
) = range(11)
DEPTH = 32  # rows of the stack
SCRATCH_ROWS = STACK + DEPTH
