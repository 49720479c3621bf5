"""Frames that are copied, and blended as one fades into another."""

from vbraille.render.waves import compiled


@compiled
def copy(given, out):
    """Fill ``out`` with a frame of the same shape.

    ``out[:] = given`` would be compiled with all the words of its refusal, which takes seconds.
    """
    rows, columns = out.shape
    for row in range(rows):
        for column in range(columns):
            out[row, column] = given[row, column]


@compiled
def blend(before, after, share, out):
    """Fill ``out`` with (1 - share) · before + share · after, frames of one shape.

    It is computed from the nearer end, so that both ends are exact and rounding never goes beyond
    them.
    """
    rows, columns = out.shape
    for row in range(rows):
        for column in range(columns):
            change = after[row, column] - before[row, column]
            if share < 0.5:
                out[row, column] = before[row, column] + share * change
            else:
                out[row, column] = after[row, column] - (1.0 - share) * change
