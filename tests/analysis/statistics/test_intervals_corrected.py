import numpy as np
import pytest

from vbraille.analysis.statistics.intervals import METHODS, adjust


@pytest.mark.parametrize(
    ("ours", "theirs"), [("bonferroni", "bonf"), ("holm", "holm"), ("fdr", "fdr_bh")]
)
@pytest.mark.parametrize("n", [1, 3, 26])
def test_it_is_pingouins(rng, pingouin, ours, theirs, n):
    p = rng.random(n) ** 3
    np.testing.assert_allclose(adjust(p, ours), pingouin.multicomp(p, method=theirs)[1])


def test_known_by_hand():
    p = [0.01, 0.04, 0.03]
    np.testing.assert_allclose(adjust(p, "bonferroni"), [0.03, 0.12, 0.09])
    np.testing.assert_allclose(adjust(p, "holm"), [0.03, 0.06, 0.06])
    np.testing.assert_allclose(adjust(p, "fdr"), [0.03, 0.04, 0.04])


def test_none_leaves_them_alone():
    p = np.array([0.2, 0.01])
    found = adjust(p, "none")
    np.testing.assert_array_equal(found, p)
    assert not np.shares_memory(found, p)


@pytest.mark.parametrize("method", METHODS)
def test_no_tests_need_no_correction(method):
    assert adjust([], method).shape == (0,)


def test_what_is_refused():
    with pytest.raises(ValueError, match="'tukey'; there are none, bonferroni, holm, fdr"):
        adjust([0.5], "tukey")
    with pytest.raises(ValueError, match="not all in"):
        adjust([0.5, 1.5], "holm")
    with pytest.raises(ValueError, match="not all in 0"):
        adjust([np.nan], "none")
