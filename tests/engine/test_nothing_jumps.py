"""Nothing jumps, over the wire: the law of `tests.wired`, and that it finds what it is for."""

import random

import pytest

from tests.controllers import Alone, HastyController
from tests.tiers import by_tier
from tests.troubles import Troubles
from tests.wired import Wired, reading
from vbraille.devices.serial.conversation import Conversation
from vbraille.simulation.firmware import Controller

BLOCK = by_tier(6, 15, 15)
BLOCKS = pytest.mark.parametrize("block", range(by_tier(1, 7, 200)))


def breaches(seeds, kind, *made):
    """What is against the law in readings with these troubles, as it is found."""
    return ((seed, breach) for seed in seeds for breach in reading(seed, kind, *made).breaches)


@BLOCKS
@pytest.mark.no_cover
@pytest.mark.parametrize(
    ("kind", "controller"),
    [
        ("host", Controller),
        ("host", Alone),
        ("host", HastyController),
        ("line", Controller),
        ("line", Alone),
    ],
)
def test_in_no_millisecond_do_actuators_move_faster_than_is_asked_for(block, kind, controller):
    assert list(breaches(range(block * BLOCK, (block + 1) * BLOCK), kind, controller)) == []


GAPS = {
    "host stopped": Troubles(stalls=((200_000, 11_000), (300_000, 23_000), (400_000, 37_000))),
    "stopped writing": Troubles(
        stalls=((200_000, 11_000), (350_000, 37_000)), stopped_writing=True
    ),
    "states muted": Troubles(up_dead=((200_000, 12_000), (300_000, 37_000), (400_000, 80_000))),
    "states lost": Troubles(lost_up=0.95),
    "states late": Troubles(jitter_us=(0, 30_000)),
    "states late and twice": Troubles(jitter_us=(0, 3000), doubled_up=0.2),
    "frames lost": Troubles(lost_down=0.9),
    "frames muted": Troubles(down_dead=((200_000, 12_000), (300_000, 37_000))),
    "frames held up": Troubles(down_held=((200_000, 12_000), (300_000, 37_000))),
    "frames late": Troubles(jitter_us=(30_000, 0)),
}


@pytest.mark.parametrize("controller", [Controller, Alone])
@pytest.mark.parametrize("gap", GAPS)
def test_a_hand_that_goes_on_in_a_gap_is_caught_up_with(gap, controller):
    wired = Wired(random.Random(gap), GAPS[gap], controller, swing=1.0, speed_mm_s=300.0)
    wired.run(0.5)
    wired.leave()
    assert wired.breaches == []
    assert wired.shown > 100


@pytest.mark.no_cover
def test_the_troubles_are_such_that_devices_rest_and_are_read_on_again():
    read = [reading(seed, "line") for seed in range(10)]
    assert sum(wired.rests for wired in read) > 15
    assert sum(wired.controller.trips for wired in read) > 5
    assert sum(wired.shown for wired in read) > 1000


class Heedless(Conversation):
    """A host that does not mind that it was stopped."""

    def mind_stall(self, _now_ns: int) -> bool:
        return False


@pytest.mark.no_cover
def test_the_law_misses_a_host_that_does_not_mind_that_it_was_stopped():
    assert any(breaches(range(40), "host", HastyController, Heedless))


@pytest.mark.no_cover
def test_the_law_misses_a_controller_that_a_frame_cuts_short():
    found = breaches(range(20), "line", HastyController)
    assert any("frame out of rest" in breach for _, breach in found)
