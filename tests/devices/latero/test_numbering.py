"""What an answer's number says: new, late, doubled, or of no request."""

from vbraille.devices.latero.conversation import KEPT, LATE_NS, Fate, RequestNumbering

MS = 1_000_000


def asked(count, first=1):
    numbering = RequestNumbering(first)
    for n in range(count):
        numbering.sent(n * MS)
    return numbering


def test_an_answer_is_new_once():
    numbering = asked(3)
    assert numbering.judge(3, 3 * MS) is Fate.NEW
    assert numbering.judge(3, 3 * MS) is Fate.DOUBLED
    assert (numbering.late, numbering.doubled, numbering.unasked) == (0, 1, 0)


def test_an_answer_that_was_overtaken_is_late():
    numbering = asked(3)
    assert numbering.judge(3, 3 * MS) is Fate.NEW
    assert numbering.judge(2, 3 * MS) is Fate.LATE
    assert numbering.judge(2, 3 * MS) is Fate.DOUBLED


def test_an_answer_that_took_too_long_is_late_even_if_it_is_the_newest():
    numbering = asked(1)
    assert numbering.judge(1, LATE_NS + 1) is Fate.LATE
    assert numbering.judge(asked(1).next - 1, LATE_NS) is Fate.DOUBLED


def test_what_was_never_asked_is_nobodys():
    numbering = asked(3)
    for sequence in (0, 4, 100, 0x4000, 0xFFFF):
        assert numbering.judge(sequence, 3 * MS) is Fate.UNASKED
    assert numbering.unasked == 5


def test_a_lost_request_is_counted_and_blocks_nothing():
    numbering = asked(3)
    numbering.judge(1, MS)
    numbering.judge(3, 3 * MS)
    assert numbering.lost == 0  # it may still come
    for n in range(KEPT):
        numbering.judge(numbering.sent(n * MS), n * MS)
    assert numbering.lost == 1


def test_an_answer_to_a_request_that_is_kept_no_more_is_late_and_not_lost():
    numbering = asked(2)
    for n in range(KEPT):
        numbering.sent(n * MS)
    assert numbering.lost == 2
    assert numbering.judge(1, 300 * MS) is Fate.LATE
    assert numbering.lost == 1


def test_what_was_answered_long_ago_was_never_lost():
    numbering = RequestNumbering()
    for n in range(KEPT + 9):
        numbering.judge(numbering.sent(n * MS), n * MS)
    assert numbering.judge(1, 300 * MS) is Fate.LATE
    assert numbering.lost == 0


def test_numbers_wrap():
    numbering = asked(4, first=0xFFFE)
    assert numbering.next == 2
    for sequence in (0xFFFE, 0xFFFF, 0, 1):
        assert numbering.judge(sequence, 4 * MS) is Fate.NEW
    assert numbering.judge(0xFFFF, 4 * MS) is Fate.DOUBLED
