import numpy as np
import pytest

from tests.benchmarks.coverage_trials import bits_of, even, readers
from vbraille.analysis.statistics.information import presented_bits, transmission, transmitted_bits
from vbraille.analysis.statistics.intervals import Unanswerable

READERS = readers()


def answers(rng, shares, number):
    return rng.multinomial(number // len(shares), shares)


@pytest.mark.parametrize("name", READERS)
def test_it_is_within_a_tenth_of_a_bit(rng, name):
    shares = READERS[name]
    tables = [answers(rng, shares, 2080) for _ in range(4)]
    found = [transmission(table, seed=1) for table in tables]
    assert np.mean([f.bits for f in found]) == pytest.approx(bits_of(shares), abs=0.1)
    for one in found:
        assert one.interval.low <= one.bits <= one.interval.high <= one.interval.low + 0.5


def test_chance_is_not_information(rng):
    counts = answers(rng, even(26, 1 / 26), 520)
    assert transmitted_bits(counts) > 0.9
    found = transmission(counts, seed=1)
    assert found.bits < 0.1
    assert found.interval.low == 0


def test_what_few_answers_cannot_carry_has_no_number(rng):
    shares = READERS["26 letters, all errors alike"]
    with pytest.raises(Unanswerable, match=r"^5.0 answers to a character on average, fewer than"):
        transmission(answers(rng, shares, 130), seed=1)
    with pytest.raises(Unanswerable, match=r"interval of the bits would be 0\.\d\d wide"):
        transmission(answers(rng, even(4, 0.8), 80), seed=1)
    with pytest.raises(Unanswerable, match="one character alone"):
        transmission([[99, 3], [0, 0]], seed=1)


def test_all_comes_through_without_error():
    found = transmission(40 * np.eye(4, dtype=int), seed=1)
    assert found.bits == pytest.approx(2, abs=0.1)
    assert found.interval.high <= 2


def test_it_is_between_0_and_what_was_presented(rng):
    for _ in range(5):
        counts = rng.integers(0, 60, (3, 4)) + 10
        found = transmission(counts, seed=1)
        assert 0 <= found.interval.low <= found.bits <= presented_bits(counts)


def test_a_seed_gives_the_same_numbers(rng):
    counts = answers(rng, even(4, 0.8), 400)
    assert transmission(counts, seed=3) == transmission(counts, seed=3)
    assert transmission(counts, seed=3) != transmission(counts, seed=4)


def test_characters_never_presented_say_nothing(rng):
    counts = answers(rng, even(4, 0.8), 400)
    wider = np.zeros((5, 5), int)
    wider[:4, :4] = counts
    assert transmission(wider, seed=3).bits == pytest.approx(
        transmission(counts, seed=3).bits, abs=0.02
    )
