"""The program killed in the middle of sessions: what it said is in, is in."""

import pytest

from tests.benchmarks.killing import ADAPTIVE, STAIRCASES, kill_often
from tests.conftest import SEED
from tests.tiers import by_tier, heavy

KILLS = by_tier(3, 20, 300)
KILLS_BY_ANSWERS = by_tier(1, 20, 300)


def test_a_session_that_is_killed_goes_on_where_it_was(tmp_path):
    print(f"seed: {SEED}")
    tally = kill_often(KILLS, SEED, tmp_path)
    assert (tally.lost, tally.skipped, tally.others) == ([], [], [])
    assert tally.kills == KILLS
    assert tally.starting
    assert tally.torn or KILLS < 20
    assert tally.acknowledged >= KILLS
    assert tally.most_attempts > 1


@heavy  # between any two events it is cut in this process, in tests/sessions/running
@pytest.mark.parametrize("protocol", [ADAPTIVE, STAIRCASES], ids=["quest", "staircases"])
def test_one_that_goes_by_the_answers_asks_what_it_would_have_asked(protocol, tmp_path):
    print(f"seed: {SEED}")
    tally = kill_often(KILLS_BY_ANSWERS, SEED, tmp_path, protocol)
    assert (tally.lost, tally.skipped, tally.others) == ([], [], [])
    assert tally.kills == KILLS_BY_ANSWERS
    assert tally.acknowledged >= KILLS_BY_ANSWERS
