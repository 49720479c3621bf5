"""Shuffles are the same on every machine, and orders of conditions are balanced."""

from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.sessions.planning.rulebook import check_balance
from vbraille.sessions.planning.sequencing import Chance, balanced_orders


class TestChance:
    def test_it_is_the_same_on_every_machine(self):
        assert Chance("42 P07").shuffled(range(10)) == [9, 8, 1, 2, 7, 5, 6, 3, 0, 4]

    def test_each_order_is_as_likely(self):
        chance = Chance("many")
        seen = Counter(tuple(chance.shuffled("abc")) for _ in range(6000))
        assert len(seen) == 6
        assert all(850 < times < 1150 for times in seen.values())

    @given(st.text(), st.lists(st.integers()))
    def test_nothing_is_lost(self, seed, items):
        assert sorted(Chance(seed).shuffled(items)) == sorted(items)


class TestBalance:
    @pytest.mark.parametrize("number", range(1, 10))
    def test_each_place_and_each_neighbour_equally_often(self, number):
        orders = balanced_orders(number)
        assert len(orders) == (number if number % 2 == 0 or number == 1 else 2 * number)
        assert all(sorted(order) == list(range(number)) for order in orders)
        check_balance(orders)

    def test_orders_that_are_not_balanced(self):
        with pytest.raises(ValueError, match=r"^a condition is not equally often in each place"):
            check_balance([(0, 1), (0, 1)])
        with pytest.raises(ValueError, match=r"^a condition does not follow each other one"):
            check_balance([(0, 1, 2), (1, 2, 0), (2, 0, 1)])
