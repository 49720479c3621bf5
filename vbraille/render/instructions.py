"""Instructions of compiled scenes, and the places of their numbers.

A scene is a list of instructions, each of which works on rows of numbers, one number for each
actuator. In a program an instruction is its operation, the distance to the next instruction, and
its constants. Shapes put coordinates into rows of their own; everything else is pushed on a stack
of rows.
"""

from vbraille.render.work import MOST_SIGNALS, OWN

# After the head (`vbraille.render.work`).
(
    COLUMN_MM,  # distances between actuators
    ROW_MM,
    RIGHT_MM,  # the canvas, from 0; beyond it nothing is shown
    BOTTOM_MM,
    ORIGIN_X,  # place of the canvas under an array at 0, 0
    ORIGIN_Y,
    SIGNALS,  # number of signals, and then each as `SIGNAL_NUMBERS` numbers
    SIGNAL_ROWS,
) = range(OWN, OWN + 8)
SIGNAL_NUMBERS = 12
CODE = SIGNAL_ROWS + MOST_SIGNALS * SIGNAL_NUMBERS  # place of the first instruction

(
    END,  # the result is in the lowest row of the stack
    GATE,  # skip instructions that cannot be felt here, and push zeros instead
    LEVEL,  # push a constant
    SIGNAL,  # push a signal
    ADD,  # join the two uppermost rows: their sum, at most 1
    MAXIMUM,
    MULTIPLY,
    OVER,  # r, δ, μ -> δ + (1 - μ) r, at most 1: Lévesque 2009, eq. 8.22
    OVER_ITSELF,  # the same where δ is its own mask
    BLEND,  # δ₁, δ₂, α -> (1 - α) δ₁ + α δ₂: eq. 8.21
    SCALE,  # change the uppermost row: times a constant
    BY_SIGNAL,  # times a signal
    INVERT,
    VIBRATE_HIGH,
    VIBRATE_LOW,
    VIBRATION,  # push a pattern
    LINEAR,
    RADIAL,
    AXIAL,
    IMAGE,
    PIXELS,  # image by its nearest pixels
    LABEL,
    LABEL_MASK,
    DOTS,
    CIRCLE,  # coordinates of a shape
    PATH,
    PROFILE,  # push the profile of a stroke
    BANDS,  # push bands along the path
    GROOVE,  # change the uppermost row: times what an outline leaves out, eq. 8.9
    MARKERS,  # blend into markers at the vertices
    BEYOND,  # push what is left beyond the ends of an open path
    CUE,  # bands -> what they show, what they hide
    FILL,  # fill, stroke -> both
    FILL_BLENDED,  # fill, stroke, profile -> both: eq. 8.20
    FILL_MASK,  # mask -> 1 inside
    WRAP,  # wrap the places into a tile, until RESTORE
    SHIFT,  # move the places, until RESTORE
    RESTORE,
) = range(38)

# Rows of the scratch: places and signs, coordinates of shapes, room, and the stack.
(
    X_ROW,
    Y_ROW,
    SIGN_ROW,
    ACROSS_ROW,
    ALONG_ROW,  # how far along, within ridges where contours have cycles of their own
    PLACE_ROW,  # how far along
    INSIDE_ROW,
    PART_ROW,
    FREE_ROW,
    SPARE_ROW,
    DOT_ROW,
    GIVEN_ROW,  # the values of the signals, then where the array's centre is
    STACK,
) = range(13)
CENTER_X, CENTER_Y = MOST_SIGNALS, MOST_SIGNALS + 1
LEAST_LANES = MOST_SIGNALS + 2  # so that these fit into a row
DEPTH = 32  # rows of the stack
SCRATCH_ROWS = STACK + DEPTH

CHUNK = 8  # segments or dots that share a box

# Numbers of a segment of a path: start, direction and length, y of its end.
(
    START_X,
    START_Y,
    RIGHT,
    DOWN,
    LENGTH,
    END_Y,
    SHORT,  # how many numbers there are where only the distance counts
) = range(7)
# How a corner is halved between the two segments that meet there: side of the bisector at the
# start, and at the end with a bias by which an open end has no other side.
(
    HALF_X,
    HALF_Y,
    END_HALF_X,
    END_HALF_Y,
    END_BIAS,
    BEGIN,  # how far along the path its straight part begins, minus the place of that on it
    INDEX,  # number of the segment in its contour
    RIDGE,  # of the texture along it; 0 for that of the stroke
    CYCLE,
    VELOCITY,
    CORNER,  # the corner at its start, and then the one at its end
) = range(SHORT, SHORT + 11)
# Numbers of a corner.
REACH, PIVOT_X, PIVOT_Y, ONWARD_X, ONWARD_Y, INWARD_X, INWARD_Y, ARC_RADIUS, ARC_HALF, MIDDLE = (
    range(10)
)
CORNER_NUMBERS = 10
# Depth to which the coordinates of a path are wanted, which is how many numbers a segment has.
ACROSS, ALONG, ROUNDED = SHORT, CORNER, CORNER + 2 * CORNER_NUMBERS

# Numbers of a row of dots that moves along a segment or around a circle, or of a dot that stays.
(
    ROW_X,  # start of the segment, or middle of the circle
    ROW_Y,
    ROW_RIGHT,
    ROW_DOWN,
    ROW_LENGTH,
    ROW_RADIUS,  # of a circle; 0 for a segment
    ROW_AT,  # place along the row where the segment begins
    ROW_PITCH,
    ROW_MOVES,  # 1 if it does, 0 for a dot that stays
    ROW_VERTEX,  # 1 for a dot on a vertex
    ROW_LOW,  # the dots of the row that are on this segment
    ROW_HIGH,
    ROW_BEGIN,  # place along the row where its window begins, and the row's direction there, as
    ROW_BEGIN_ALONG,  # seen from the segment
    ROW_BEGIN_ACROSS,
    ROW_END,
    ROW_END_ALONG,
    ROW_END_ACROSS,
    ROW_OPEN_BEGIN,  # 1 if dots are cut off beyond a round end there
    ROW_OPEN_END,
    ROW_NUMBERS,
) = range(21)
