"""The host's loop on the manual clock: it does what its mailbox says."""

import os
import signal

import numpy as np
import pytest

from tests.engine.test_loop import Recording, biggest_step, picture, straight
from vbraille.engine.clock import ManualClock
from vbraille.engine.hostprocess import OrderedLoop, end_after, warm_up
from vbraille.engine.loop import Loop
from vbraille.engine.mailbox import _PIECE_WORDS, Extent, Mailbox, divide, watch
from vbraille.engine.record import Flag
from vbraille.render import STRESS2
from vbraille.render.program import Program
from vbraille.simulation.hand import Sweep
from vbraille.simulation.steering import ReadLine

EXTENT = Extent(6, 10, STRESS2.style.room(STRESS2.display, 20), 4000)


class Bench:
    """A host without a process, and its parent's ends of mailbox and ring."""

    def __init__(self, hand=None):
        memory = memoryview(bytearray(EXTENT.total_bytes))
        self.clock = ManualClock()
        self.device = Recording(self.clock, hand)
        theirs, ring = divide(memory, EXTENT)
        self.loop = Loop(self.device, self.clock, ring=ring)
        self.hosted = OrderedLoop(self.loop, theirs, os.getppid())
        self.mailbox, self.reader = watch(memory, EXTENT)
        self.memory = memory

    def run(self, seconds):
        for _ in range(round(seconds * 1000)):
            self.hosted.run()
        return self.reader.drain()


@pytest.fixture
def bench():
    return Bench()


@pytest.mark.parametrize("cells", [1, 7, 20])
def test_frames_are_those_of_the_picture_posted(bench, cells):
    line = picture(range(30, 30 + cells), mapping="row-sheared", texture=0.6)
    bench.device.move(straight((0, -10.8), (2, 200)))
    bench.mailbox.post(line, 3)
    ticks = bench.run(1.5)
    want = np.zeros((6, 10))
    assert ticks["line"][-1] == 3
    for tick in ticks[200:]:
        line.frame(float(tick["x_mm"]), want)
        np.testing.assert_array_equal(tick["frame"], want.astype(np.float32))


def test_a_new_picture_fades_in_and_the_old_one_is_forgotten(bench):
    bench.device.move(straight((0, 3.0), (60, 3.0)))
    bench.run(0.1)
    for number in range(5):
        bench.mailbox.post(picture((number + 1,) * (20 - number), mapping="sheared"), 1)
        bench.run(0.15)
    assert biggest_step(bench.device.sent) <= 1 / 100 + 1e-9
    want = np.zeros((6, 10))
    picture((5,) * 16, mapping="sheared").frame(bench.loop.x_mm, want)
    np.testing.assert_array_equal(bench.loop.output, want)


def test_of_several_pictures_at_once_the_last_counts(bench):
    for number in range(4):
        bench.mailbox.post(picture((number,)), number + 1)
    assert bench.run(0.01)["line"].tolist()[-1] == 4


def test_a_picture_in_the_writing_is_left_for_later(bench):
    bench.mailbox.post(picture((1,)), 1)
    bench.run(0.01)
    bench.mailbox.post(picture((2,)), 2)
    # In the numbers of the picture in either slot: of the two, one is picture 2.
    first = 64 + 8 * 8
    places = (first, first + (EXTENT.mailbox_bytes - 64) // 2)
    for at in places:
        bench.memory[at] ^= 1
    assert set(bench.run(0.01)["line"].tolist()) == {1}
    for at in places:
        bench.memory[at] ^= 1
    assert bench.run(0.01)["line"].tolist()[-1] == 2


def test_a_hand_reads_on_while_the_tuning_changes():
    bench = Bench(hand=Sweep(100.0))
    bench.mailbox.post(picture(), 1)
    bench.device.steering.give(ReadLine(50.0))
    x_mm = bench.run(0.4)["x_mm"]
    bench.mailbox.post(picture(texture=0.1), 1)
    x_mm = np.concatenate((x_mm, bench.run(1.0)["x_mm"]))
    assert np.abs(np.diff(x_mm)).max() < 1
    assert x_mm.argmax() == pytest.approx(610, abs=3)  # at 100 mm/s, straight through
    assert bench.device.steering.done_at(bench.clock.now_ns())
    bench.mailbox.post(picture(), 2)
    bench.device.steering.give(ReadLine(50.0))
    assert bench.run(0.3)["x_mm"][-1] > 10


def test_pause_and_zero_and_stop(bench):
    zeros = []
    bench.device.set_zero = lambda: zeros.append(1)
    bench.device.move(straight((0, 3.0), (60, 3.0)))
    bench.mailbox.post(picture(mapping="sheared"), 1)
    bench.run(0.3)
    bench.mailbox.paused = True
    ticks = bench.run(0.1)
    assert ticks["flags"][-1] & Flag.PAUSED
    assert not ticks["frame"][-1].any()
    bench.mailbox.paused = False
    assert bench.run(0.2)["frame"][-1].any()
    bench.mailbox.zero()
    bench.run(0.01)
    assert zeros == [1]
    assert bench.hosted.wanted
    bench.mailbox.stop()
    assert not bench.hosted.wanted


def test_it_ends_with_its_parent_and_by_a_signal(bench):
    orphan = OrderedLoop(bench.loop, bench.mailbox, os.getppid() + 1)
    assert not orphan.wanted
    bench.hosted.end(15, None)
    assert not bench.hosted.wanted


def test_a_parent_that_was_gone_before_it_could_be_told_is_answered_at_once():
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            end_after(os.getppid() + 1)  # another has it by now
            os.write(write, bytes([signal.alarm(0)]))
        finally:
            os._exit(0)
    os.waitpid(child, 0)
    os.close(write)
    assert os.read(read, 1) in (b"\2", b"\3")  # seconds until the system ends it
    os.close(read)


def test_a_picture_that_does_not_fit_is_refused(bench):
    bench.mailbox.post(picture((1,) * 64), 1)  # a line may have the room of a page of one line
    with pytest.raises(ValueError, match="does not go into"):
        bench.mailbox.post(picture((1,) * 65), 1)
    assert bench.mailbox.published == 1


def test_warming_up_leaves_nothing_behind(bench):
    warm_up(bench.device.display, EXTENT)
    assert bench.mailbox.published == 0


def large(number, words=400_000):
    """A line whose program takes 3 MB: what its kernel does not look at is of no account."""
    line = picture((number,) * 3)
    numbers = np.concatenate((line.numbers, np.full(words, float(number))))
    return Program(numbers, line.table)


def roomy(number):
    """A mailbox with room for such pictures, as both sides have it."""
    room = large(number).nbytes
    buffer = memoryview(bytearray(Mailbox.bytes_needed(room)))
    return Mailbox(buffer, room), Mailbox(buffer, room), buffer


def pieces(mailbox):
    """Take a picture as the loop does; how many pieces that took, and the picture."""
    for count in range(1, 100):
        posted = mailbox.take_piece()
        if posted is not None:
            return count, posted
    pytest.fail("the picture never came")


def test_a_large_picture_is_taken_piece_by_piece_and_a_small_one_at_once():
    ours, theirs, _ = roomy(1)
    for number in (1, 2, 3):
        program = large(number)
        ours.post(program, number)
        count, posted = pieces(theirs)
        assert count == -(-(program.nbytes + 40) // (8 * _PIECE_WORDS))
        assert (posted.number, posted.line) == (number, number)
        np.testing.assert_array_equal(posted.program.numbers, program.numbers)
        np.testing.assert_array_equal(posted.program.table, program.table)
        whole = ours.take()
        assert whole is not None
        np.testing.assert_array_equal(whole.program.numbers, program.numbers)
    ours.post(picture(), 9)
    count, posted = pieces(theirs)
    assert (count, posted.line) == (1, 9)


def test_a_picture_that_is_shown_stays_whole_while_the_next_is_taken():
    ours, theirs, _ = roomy(1)
    ours.post(large(1), 1)
    shown = pieces(theirs)[1].program
    ours.post(large(2), 2)
    pieces(theirs)
    np.testing.assert_array_equal(shown.numbers, large(1).numbers)


def test_of_pictures_posted_while_one_is_taken_the_last_comes_and_none_is_mixed():
    ours, theirs, _ = roomy(1)
    ours.post(large(1), 1)
    for number in range(2, 12):
        theirs.take_piece()
        ours.post(large(number), number)
    while (posted := pieces(theirs)[1]).number < 11:
        assert set(posted.program.numbers[-400_000:]) == {float(posted.number)}
    np.testing.assert_array_equal(posted.program.numbers, large(11).numbers)


@pytest.mark.parametrize("at", [0, 1, 2, 3, 4, 5, 5000, 40_000, 399_999])
def test_a_word_that_is_wrong_anywhere_keeps_a_picture_from_being_taken(at):
    ours, theirs, buffer = roomy(1)
    ours.post(large(1), 1)
    words = buffer.cast("q")
    slot = 8 + (len(words) - 8) // 2  # the first picture goes into the second slot
    words[slot + at] ^= 1 << 40
    for _ in range(30):
        assert theirs.take_piece() is None
    assert theirs.take() is None
    words[slot + at] ^= 1 << 40
    assert pieces(theirs)[1].number == 1


def test_words_that_changed_places_are_seen():
    ours, theirs, buffer = roomy(1)
    program = large(1)
    program.numbers[-2:] = 3.0, 4.0
    ours.post(program, 1)
    words = buffer.cast("q")
    end = 8 + (len(words) - 8) // 2 + 5 + program.numbers.size
    words[end - 2], words[end - 1] = words[end - 1], words[end - 2]
    assert theirs.take() is None
