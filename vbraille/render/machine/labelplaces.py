"""Places of the numbers that kernels work with in a label; `brailleplaces` fills them."""

# Places of a label's numbers in their run.
(
    X0,  # corner of the first cell, mm
    Y0,
    COSINE,  # of the direction of its lines
    SINE,
    WIDTH,  # of the rectangle of its cells, mm
    HEIGHT,
    LINES,
    LINE_PITCH,
    LINES_PER_MM,
    ROW_PITCH,
    ROWS_PER_MM,
    CELL_PITCH,
    CELLS_PER_MM,
    DOT_SPACING,
    DOT_WIDTH,
    DOTS_PER_MM,
    CONTRAST,
    PROFILE,
    SHAPE,  # the 6 coefficients of the profile
    _S1,
    _S2,
    _S3,
    _S4,
    _S5,
    STRIDE,  # words of a line in the table: its cells, an empty one before them and one after
    TABLE,  # first of its words in the table
    APART,  # 1 if no two dots can be over one place
    COUNT,  # how many numbers there are
) = range(28)

FADE_MM = 1.0  # over which the opacity of a label ends
