"""What a device has to say: at once, but each kind at most once a second."""

from vbraille.devices.notices import EVERY_NS, Notices

MS = 1_000_000


def test_the_first_is_said_at_once_and_the_others_are_counted():
    notices = Notices()
    said = []
    for ms in range(3001):
        if ms < 2500:
            notices.add("hot", f"hot at {ms}", ms * MS)
        said += [(ms, sentence) for sentence in notices.take(ms * MS)]
    assert said == [
        (0, "hot at 0"),
        (1000, "hot at 1000 (1000 times in the last second)"),
        (2000, "hot at 2000 (1000 times in the last second)"),
        (3000, "hot at 2499 (499 times in the last second)"),
    ]


def test_what_is_rare_is_said_as_it_is():
    notices = Notices()
    said = []
    for ms in range(0, 10_000, 500):
        if ms % 1000 == 0:
            notices.add("hot", "hot", ms * MS)
        said += notices.take(ms * MS)
    assert said == ["hot"] * 10


def test_of_two_that_take_turns_the_later_is_said_later():
    notices = Notices()
    for ms in range(100):
        notices.add(("silent", "back")[ms % 2], ("silent", "back")[ms % 2], ms * MS)
        if ms == 1:
            assert notices.take(ms * MS) == ["silent", "back"]
    assert notices.take(EVERY_NS - 1) == []
    assert notices.take(2 * EVERY_NS) == [
        "silent (49 times in the last second)",
        "back (49 times in the last second)",
    ]
    assert notices.take(9 * EVERY_NS) == []


def test_who_never_says_the_same_is_not_heard_without_an_end():
    notices = Notices()
    said = []
    for ms in range(10_000):
        notices.add(f"kind {ms}", f"notice {ms}", ms * MS)
        said += notices.take(ms * MS)
    assert len(said) < 200
