import json
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import entropy

from vbraille.analysis.statistics.information import (
    accuracy,
    cohen_kappa,
    presented_bits,
    transmitted_bits,
)
from vbraille.analysis.statistics.intervals import Unanswerable

ALL = [accuracy, cohen_kappa, presented_bits, transmitted_bits]
PUBLISHED = Path(__file__).parent.parent / "published.json"


def test_the_published_confusions():
    table = json.loads(PUBLISHED.read_text(encoding="utf-8"))["table_3_4"]
    counts, derived = table["counts"], table["derived"]
    assert accuracy(counts) == derived["accuracy"]
    # The note's last digit is one too high: in fractions kappa is 0.8666858.
    assert cohen_kappa(counts) == pytest.approx(derived["cohen_kappa"], abs=2e-6)
    assert cohen_kappa(counts) == pytest.approx(0.8666858, abs=5e-8)
    assert transmitted_bits(counts) == pytest.approx(derived["mutual_information_bits"], abs=5e-6)


def test_kappa_is_agreement_beyond_chance():
    counts = np.array([[25, 13, 12], [12, 2, 16], [3, 15, 2]])
    p = counts / 100
    by_chance = p.sum(axis=0) @ p.sum(axis=1)
    assert cohen_kappa(counts) == pytest.approx((0.29 - by_chance) / (1 - by_chance))


def test_a_column_of_what_was_not_read_counts_against():
    counts = np.array([[8, 0, 2], [0, 5, 5]])
    assert accuracy(counts) == 0.65
    # By chance: 10 · 8 and 10 · 5 of 400.
    assert cohen_kappa(counts) == pytest.approx((0.65 - 0.325) / (1 - 0.325))
    square = np.vstack([counts, np.zeros((1, 3), dtype=int)])
    for measure in ALL:
        assert measure(counts) == pytest.approx(measure(square))


@pytest.mark.parametrize("letters", [1, 2, 4, 26])
def test_all_comes_through_without_error(letters):
    counts = 5 * np.eye(letters, dtype=int)
    assert presented_bits(counts) == pytest.approx(np.log2(letters))
    assert transmitted_bits(counts) == pytest.approx(np.log2(letters))


def test_nothing_comes_through_of_guesses():
    assert transmitted_bits(np.full((4, 5), 7)) == pytest.approx(0, abs=1e-12)
    assert cohen_kappa(np.full((4, 4), 7)) == 0


def test_information_is_symmetric_and_the_divergence_from_independence(rng):
    counts = rng.integers(0, 9, (6, 6))
    joint = counts / counts.sum()
    apart = np.outer(joint.sum(axis=1), joint.sum(axis=0))
    found = transmitted_bits(counts)
    assert found == pytest.approx(entropy(joint.ravel(), apart.ravel(), base=2))
    assert found == pytest.approx(transmitted_bits(counts.T))


def test_one_character_alone_has_no_kappa():
    with pytest.raises(Unanswerable, match="one character"):
        cohen_kappa([[9, 0], [0, 0]])
    assert cohen_kappa([[0, 9]]) == 0  # never read: no better than chance
