import numpy as np
import pytest

from vbraille.analysis.statistics.anova import arrange
from vbraille.analysis.statistics.intervals import Unanswerable


def test_levels_and_participants_come_in_order_of_appearance():
    cube, participants, *others = arrange(
        ["b", "b", "a", "a"], {"mode": ["T25", "T0", "T0", "T25"]}, [1, 2, 3, 4]
    )
    assert participants == ("b", "a")
    np.testing.assert_array_equal(cube, [[1, 2], [4, 3]])
    assert others == [(), ()]


def test_a_repeat_that_is_missing_is_no_repeat():
    cube, _, _, averaged = arrange(
        ["a", "a", "a", "b", "b", "a"],
        {"mode": ["x", "y", "x", "x", "y", "y"]},
        [1, 2, np.nan, 4, 5, 8],
    )
    np.testing.assert_array_equal(cube, [[1, 5], [4, 5]])
    assert averaged == (("a", 1),)


@pytest.mark.parametrize(
    ("participants", "levels", "scores", "reason"),
    [
        ([], [], [], "no scores"),
        (["a", "b"], ["x", "y"], [np.nan, np.nan], "no scores"),
        (["a", "b"], ["x", "x"], [1, 2], "same mode, 'x'; there is nothing to compare"),
        (["a", "a"], ["x", "y"], [1, 2], "^one participant, 'a', has a score in every cell; two"),
        (
            ["a", "a", "b"],
            ["x", "y", "y"],
            [1, 2, 3],
            r"^one participant, 'a', .* \('b' has none for 'x'\)$",
        ),
        (["a", "b"], ["x", "y"], [1, 2], r"^no participant .*'a' has none for 'y'; 'b' has none"),
        (["a", "a"], ["x", "y"], [1, np.nan], "no participant has a score for 'y'"),
        (list("abcde"), list("xyzxy"), [1] * 5, r"'a' has none for 'y'; 'b' has none for 'x'"),
    ],
)
def test_what_cannot_be_compared(participants, levels, scores, reason):
    with pytest.raises(Unanswerable, match=reason):
        arrange(participants, {"mode": levels}, scores)


def test_too_many_cells():
    levels = [str(i) for i in range(50)]
    with pytest.raises(Unanswerable, match="2500 cells; more than 2000"):
        arrange(["a"] * 50, {"one": levels, "two": levels}, [1] * 50)


def test_what_is_no_table_of_scores():
    with pytest.raises(ValueError, match="0 factors"):
        arrange(["a"], {}, [1])
    with pytest.raises(ValueError, match="5 factors"):
        arrange(["a"], {str(i): ["x"] for i in range(5)}, [1])
