"""Lines that do not come to their end, on the manual clock: what is the matter is said, once."""

import pytest

from tests.engine.test_loop import straight
from tests.reading import test_reader
from vbraille.devices.base import Placing
from vbraille.engine.record import Flag


def Bench(**options):  # noqa: N802 - as the one of all tests of readers
    """A bench of few ticks a second: what is tested here takes many seconds."""
    return test_reader.Bench(rate_hz=200.0, **options)


def waiting(bench):
    return [said for said in bench.said if said.startswith("waiting")]


@pytest.mark.no_cover
def test_a_hand_that_stops_within_a_line_is_told_once_how_the_next_one_comes():
    bench = Bench(text="one two thr\n")
    bench.device.move(straight((0, -10.8), (1, 40.0)))
    bench.run(10.5)
    assert waiting(bench) == []
    bench.run(1.5)
    (said,) = waiting(bench)
    assert said.startswith("waiting: the finger is still at 45 mm, and line 1 ends at ")
    assert said.endswith("read to its end and move back to the left, or Ctrl-C stops")
    bench.run(15)
    bench.device.move(straight((0, 40.0), (1, 42.0)))
    bench.run(15)
    assert len(waiting(bench)) == 1
    assert bench.reader.under.hopeless is None


@pytest.mark.no_cover
def test_at_a_terminal_it_says_the_key_and_a_line_that_is_read_says_so():
    bench = Bench(text="one\n\ntwo\n", stay=True)
    bench.device.move(straight((0, -10.8), (1, 100.0)))
    bench.run(12)
    assert waiting(bench) == [
        "waiting: line 1 is read; move back to the left and the next line comes, or n brings the "
        "next line"
    ]


@pytest.mark.no_cover
@pytest.mark.parametrize("how", ["by key", "paused", "at the mark", "at the end"])
def test_nobody_is_told_who_is_not_waited_for(how):
    bench = Bench(text="one", advance=how != "by key", stay=True)
    bench.device.move(straight((0, -10.8), (1, 40.0)))
    if how == "paused":
        bench.press(" ")
    elif how == "at the mark":
        bench.device.silent = True
        bench.device.placing = Placing.MARK
    elif how == "at the end":
        bench.device.move(straight((0, -10.8), (1, 100.0), (2, -10.8)))
    bench.run(15)
    assert waiting(bench) == []


@pytest.mark.no_cover
def test_a_carriage_whose_place_nobody_knows_is_said():
    bench = Bench(text="one")
    bench.device.silent = True
    bench.run(12)
    assert waiting(bench) == [
        "waiting: the device has not said for 10 s where its carriage is; see that it is on and "
        "plugged in, or Ctrl-C stops"
    ]


@pytest.mark.no_cover
@pytest.mark.parametrize(("places", "hopeless"), [((60, 60.3, 59.7), True), ((60, 40, 60), False)])
def test_a_hand_that_turns_back_before_the_end_is_told(places, hopeless):
    bench = Bench(text="one two three")
    way = [(0, -10.8)]
    for n, place_mm in enumerate(places):
        way += [(2 * n + 1, place_mm), (2 * n + 2, -10.8)]
    bench.device.move(straight(*way))
    bench.run(7)
    (said,) = waiting(bench)
    assert said.startswith(f"waiting: the finger turns back at {places[-1] + 5.4:.0f} mm, and line")
    assert (bench.reader.under.hopeless is not None) == hopeless
    if hopeless:
        assert bench.reader.under.hopeless.startswith("line 1 cannot be read to its end: ")
    assert bench.reader.line.number == 1


@pytest.mark.no_cover
def test_a_hand_that_waits_at_the_left_is_no_carriage_in_need():
    bench = Bench(text="one two three")
    bench.device.move(straight((0, -10.8), *((n, -10.8 + 5 * (n % 2)) for n in range(1, 20))))
    bench.run(21)
    assert bench.reader.under.hopeless is None


@pytest.mark.no_cover
def test_a_line_that_the_device_did_not_take_is_not_read():
    bench = Bench(text="one\n\ntwo\n")
    there_and_back = straight((0, -10.8), (1, 100.0), (2, -10.8))
    bench.device.taking = False
    bench.device.move(there_and_back)
    bench.run(3)
    assert bench.reader.line.number == 1
    assert waiting(bench) == [
        "waiting: the device takes no frames, so that nothing is felt; switch it off and on, and "
        "line 1 goes on"
    ]
    assert bench.engine.poll()["flags"][-1] & Flag.HELD
    assert bench.reader.under.hopeless is None
    bench.device.taking = True
    bench.run(0.1)
    assert bench.said[-1] == "device: takes frames again; line 1 is felt from here on"
    bench.device.move(there_and_back)
    bench.run(2.5)
    assert bench.reader.line.number == 2
    bench.device.taking = False
    bench.run(12)
    assert bench.reader.under.hopeless == (
        "the device has taken no frames for 10 s, and line 2 was not felt to its end; switch it "
        "off and on, and read on from there"
    )


@pytest.mark.no_cover
@pytest.mark.parametrize(("places", "hopeless"), [((0, 0.4, 0), True), ((0, 9, 0), False)])
def test_a_hand_that_never_comes_back_to_the_left_stop_is_told(places, hopeless):
    bench = test_reader.Bench(text="one\n\ntwo\n")  # a place is told to 0.1 mm
    way = [(0, 0.0), (1, 100.0)]
    for n, place_mm in enumerate(places):
        way += [(2 * n + 2, place_mm), (2 * n + 3, 100.0)]
    bench.device.move(straight(*way))
    bench.run(2.9)
    (said,) = waiting(bench)
    assert said == (
        "waiting: line 1 is read, and the finger turns right again at 5.4 mm; the next line comes "
        "at the left stop, which is at -5.4 mm, or Ctrl-C stops"
    )
    bench.run(4.5)
    assert len(waiting(bench)) == 1
    assert (bench.reader.under.hopeless is not None) == hopeless
    if hopeless:
        assert bench.reader.under.hopeless.startswith(
            "line 1 is read and never done: the finger turns"
        )
    assert bench.reader.line.number == 1


@pytest.mark.no_cover
def test_a_hand_that_reads_the_end_of_a_line_again_is_told_nothing():
    bench = Bench(text="one two three four")
    way = [(0, -10.8)]
    for n in range(5):
        way += [(2 * n + 1, 120.0), (2 * n + 2, 75.0)]
    bench.device.move(straight(*way))
    bench.run(9)
    assert waiting(bench) == []
    assert bench.reader.under.hopeless is None
