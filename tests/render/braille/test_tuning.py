import pytest

from vbraille.render import Tuning
from vbraille.render.braille.style import MOST_TEXTURE_CYCLES


@pytest.mark.parametrize("name", ["texture", "contrast"])
@pytest.mark.parametrize("value", [-0.001, 1.001, -1, 2, float("inf"), float("nan")])
def test_levels_out_of_range(name, value):
    with pytest.raises(ValueError, match=rf"^{name} is {value:g}; it must be 0 to 1$"):
        Tuning(**{name: value})


def test_texture_cycles_are_odd_and_go_to_the_bound():
    assert MOST_TEXTURE_CYCLES == 11
    for cycles in (1, 3, 5, 7, 9, 11):
        assert Tuning(cycles=cycles).cycles == cycles


@pytest.mark.parametrize("cycles", [-7, -1, 0, 2, 6, 8, 10, 12, 13])
def test_texture_cycles_out_of_range(cycles):
    says = rf"^texture cycles are {cycles}; they must be an odd number, 1 to 11$"
    with pytest.raises(ValueError, match=says):
        Tuning(cycles=cycles)
