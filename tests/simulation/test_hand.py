"""How hands move: laws for any line, and what tells the hands apart."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vbraille.errors import InputError
from vbraille.simulation.hand import (
    CLEAR_MM,
    DEVICE,
    FLUENT,
    RETURN_MM_S,
    Hand,
    HumanHand,
    Sweep,
)
from vbraille.simulation.recorded import Recorded
from vbraille.simulation.specs import parse_hand

START_MM, END_MM = -10.8, 270.0  # a line of 24 cells of 11.1 mm
LENGTH_MM = END_MM - START_MM
DONE_MM = 1.0  # how near to the start the program takes a hand for returned
RATE_HZ = 1000.0

specs = st.sampled_from(["sweep:0.1", "sweep:60", "sweep:1000", "device", "fluent"])
starts = st.floats(-50, 50)
lengths = st.floats(0, 300)
seeds = st.integers(0, 2**32)


def line_hand(spec, seed=1) -> Hand:
    return parse_hand(spec, seed)


def lines(spec, count=5, seed=3):
    hand = line_hand(spec, seed)
    return [hand.read_line(START_MM, END_MM) for _ in range(count)]


def movements(motion):
    """Length and speed of each movement, right positive; pauses left out."""
    way = np.diff(motion.x_mm)
    speed = way / np.diff(motion.t_s)
    return way[way != 0], speed[way != 0]


def pauses(motion):
    still = np.diff(motion.x_mm) == 0
    return np.diff(motion.t_s)[still]


def runs(motion):
    """Ways between turns, right positive: the length of each, and its highest speed."""
    way, speed = movements(motion)
    turns = np.flatnonzero(np.diff(np.sign(way))) + 1
    lengths = np.array([part.sum() for part in np.split(way, turns)])
    fastest = np.array([np.abs(part).max() for part in np.split(speed, turns)])
    return lengths, fastest


@given(spec=specs, start=starts, length=lengths, seed=seeds)
def test_any_line_begins_and_ends_at_its_start_and_reaches_its_end(spec, start, length, seed):
    hand = line_hand(spec, seed)
    for end in (start + length, start, start + length):
        motion = hand.read_line(start, end)
        assert motion.x_mm[0] == motion.x_mm[-1] == start
        assert motion.x_mm.max() == end
        assert motion.x_mm.min() == start
        assert motion.t_s[0] == 0
        assert np.all(np.diff(motion.t_s) > 0)


@given(spec=specs, start=starts, length=lengths, seed=seeds)
def test_a_hand_that_is_not_done_turns_short_of_both_ends(spec, start, length, seed):
    end = start + length
    x_mm = line_hand(spec, seed).read_line(start, end).x_mm
    at_end = np.flatnonzero(x_mm == end)
    reading = x_mm[: at_end[0]]
    away = np.flatnonzero(reading > start + CLEAR_MM)
    if away.size:
        assert reading[away[0] :].min() > start + DONE_MM
    if start < end:
        assert np.all(np.diff(at_end) == 1)
        assert list(x_mm[at_end[-1] :]) == [end, start]


@given(spec=specs, start=starts, length=lengths, seed=seeds)
def test_the_same_seed_reads_the_same_lines(spec, start, length, seed):
    first, second = line_hand(spec, seed), line_hand(spec, seed)
    for _ in range(2):
        one, other = (hand.read_line(start, start + length) for hand in (first, second))
        np.testing.assert_array_equal(one.t_s, other.t_s)
        np.testing.assert_array_equal(one.x_mm, other.x_mm)


@pytest.mark.parametrize("spec", ["sweep:60", "device", "fluent"])
def test_an_empty_line_is_a_short_wait(spec):
    motion = line_hand(spec).read_line(5.0, 5.0)
    assert set(motion.x_mm) == {5.0}
    assert 0.1 <= motion.duration_s <= 3


@pytest.mark.parametrize("spec", ["sweep:60", "device", "fluent"])
@pytest.mark.parametrize(
    ("start", "end"), [(1, 0), (float("nan"), 1), (0, float("nan")), (0, float("inf")), (0, 1e5)]
)
def test_a_line_that_cannot_be_is_refused(spec, start, end):
    with pytest.raises(ValueError, match="a line is from"):
        line_hand(spec).read_line(start, end)


@given(speed=st.floats(0.1, 1000), length=st.floats(0.1, 300))
def test_a_sweep_is_constant_both_ways(speed, length):
    motion = Sweep(speed).read_line(0.0, length)
    _, speeds = movements(motion)
    assert speeds == pytest.approx([speed, -RETURN_MM_S], rel=1e-6)
    assert motion.duration_s == pytest.approx(length / speed + length / RETURN_MM_S)


@pytest.mark.parametrize("seed", range(5))
def test_device_reads_forward_at_8_mm_s(seed):
    steps = np.concatenate([np.diff(line.sample(RATE_HZ)[1]) for line in lines("device", 5, seed)])
    assert np.median(steps[steps > 0]) * RATE_HZ == pytest.approx(8.0, abs=0.5)


@pytest.mark.parametrize("seed", range(5))
def test_fluent_moves_at_24_to_69_mm_s(seed):
    for line in lines("fluent", 10, seed):
        way, speeds = movements(line)
        assert speeds[way > 0].min() >= 24 - 1e-6
        assert speeds[way > 0].max() <= 69 + 1e-6
        back = -speeds[way < 0]
        assert back[-1] == pytest.approx(RETURN_MM_S)
        assert np.all((back[:-1] >= 24 - 1e-6) & (back[:-1] <= 69 + 1e-6))


@pytest.mark.parametrize("spec", ["device", "fluent"])
def test_speed_is_intermittent(spec):
    for line in lines(spec):
        way, speeds = movements(line)
        speeds = speeds[way > 0]
        assert speeds.size > 10
        assert np.std(np.log(speeds)) > 0.15


@pytest.mark.parametrize(("spec", "low", "high"), [("device", 0.2, 0.8), ("fluent", 0.1, 0.3)])
def test_pauses_have_their_lengths(spec, low, high):
    waits = [pauses(line) for line in lines(spec, 10)]
    assert min(wait.size for wait in waits) >= 1  # at the end at least
    assert max(wait.size for wait in waits) >= 3
    waits = np.concatenate(waits)
    assert low - 1e-9 <= waits.min() < waits.max() <= high + 1e-9


def test_fluent_reads_a_line_once_with_few_and_short_regressions():
    regressions = []
    for line in lines("fluent", 20):
        ways, _ = runs(line)
        assert ways[-1] == pytest.approx(-LENGTH_MM)
        back = -ways[1:-1:2]
        assert np.all((back >= 2 - 1e-9) & (back <= 10 + 1e-9))
        regressions.append(back.size)
        assert line.duration_s < 15
    assert 0 < np.mean(regressions) < 4


def test_device_reads_a_line_two_or_three_times():
    passes = []
    for line in lines("device", 20):
        ways, fastest = runs(line)
        passes.append(np.count_nonzero(ways < -0.8 * LENGTH_MM))
        assert (ways[-1], fastest[-1]) == pytest.approx((-LENGTH_MM, RETURN_MM_S))
    assert set(passes) == {2, 3}


def test_device_turns_round_at_90_to_99_percent_and_comes_back_quickly_or_slowly():
    turns, speeds = [], []
    for line in lines("device", 20):
        ways, fastest = runs(line)
        reached = (np.cumsum(ways) - ways) / LENGTH_MM  # where each way begins
        again = np.flatnonzero(ways < -0.8 * LENGTH_MM)[:-1]
        turns.extend(reached[again])
        speeds.extend(fastest[again])
    assert 0.9 - 1e-9 <= min(turns) < max(turns) <= 0.99 + 1e-9
    quick = np.isclose(speeds, RETURN_MM_S)
    assert quick.any()
    assert not quick.all()
    assert np.all(np.array(speeds)[~quick] <= 21 + 1e-6)


def test_device_regresses_and_scans_one_and_two_cells_again():
    back = np.concatenate([-runs(line)[0][1::2] for line in lines("device", 20)])
    assert np.count_nonzero((back >= 2) & (back <= 10)) > 20
    assert np.count_nonzero(np.isclose(back, 11.0)) > 5
    assert np.count_nonzero(np.isclose(back, 22.0)) > 5


def test_a_line_too_short_to_turn_in_is_read_once():
    length = 9 * CLEAR_MM
    hand = HumanHand(DEVICE, 1)
    for _ in range(20):
        ways, fastest = runs(hand.read_line(0.0, length))
        assert ways[-1] == pytest.approx(-length)
        assert np.all(-ways[1:-1:2] <= length - CLEAR_MM)
        assert np.all(fastest[:-1] <= 21 + 1e-6)


def test_a_seed_below_0_is_refused():
    with pytest.raises(ValueError, match="seed is -1"):
        HumanHand(FLUENT, -1)
    with pytest.raises(InputError, match="seed is -1"):
        parse_hand("fluent", -1)


def test_a_spec_gives_its_hand(tmp_path):
    path = tmp_path / "hand:1.csv"
    path.write_text("0,1\n0.1,2\n")
    device, fluent, recorded = (
        parse_hand(spec, 7) for spec in ("device", "fluent", f"recorded:{path}")
    )
    assert parse_hand("sweep:60") == Sweep(60.0)
    assert isinstance(device, HumanHand)
    assert device.habits == DEVICE
    slow = parse_hand("slow", 7)
    assert isinstance(slow, HumanHand)
    assert slow.habits == DEVICE
    assert isinstance(fluent, HumanHand)
    assert fluent.habits == FLUENT
    assert isinstance(recorded, Recorded)
    assert list(recorded.motion.x_mm) == [1.0, 2.0]


@pytest.mark.parametrize("speed", ["abc", "", "-3", "nan", "inf", "0", "1e400", "2000"])
def test_a_sweep_spec_out_of_range_names_the_range(speed):
    with pytest.raises(InputError, match=r"sweep speed is .* 0\.1 to 1000 mm/s") as caught:
        parse_hand(f"sweep:{speed}")
    assert caught.value.exit_code == 2


@pytest.mark.parametrize(
    "spec", ["", "sweeps", "device:", "device:3", "recorded", "recorded:", ":"]
)
def test_an_unknown_spec_names_the_forms(spec):
    with pytest.raises(InputError, match="sweep:SPEED in mm/s, slow, fluent or recorded:FILE"):
        parse_hand(spec)
