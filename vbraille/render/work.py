"""Where the kernels find what: places in the rows of their array of work."""

# Places in the row of parameters.
(
    CELLS_PER_MM,
    CELL_PITCH,
    COLUMN_PITCH,
    COLUMNS,
    ANCHOR,  # from the left column to where a place is of: half the array's width, or 0
    DOTS_PER_MM,
    DOT_SPACING,
    PROFILE,
    OVERLAP,  # 1 if two dots can be under one place
    SHAPE,  # coefficients of the profile, 6
    _S1,
    _S2,
    _S3,
    _S4,
    _S5,
    IDLE,  # deflection of each row off the dots
) = range(16)
SWING, SLOT = 1, 2  # further rows of work
