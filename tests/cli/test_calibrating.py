"""The round through the actuators: what is next, what is set, and undo."""

from vbraille.cli.old.commands.calibrate import ActuatorRound
from vbraille.devices.calibration import Calibration, Tried

NONE = Calibration("bench", 2, 2)


def places(found):
    return [one.place for one in found.tried]


def test_findings_lead_in_reading_order_to_the_end():
    turn = ActuatorRound.of(NONE)
    for place in ((0, 0), (0, 1), (1, 0), (1, 1)):
        assert turn.now == Tried(*place)
        turn = turn.is_("ok")
    assert turn.found.whole
    assert places(turn.found) == [(0, 0), (0, 1), (1, 0), (1, 1)]


def test_what_was_set_is_found():
    turn = ActuatorRound.of(NONE).inverted().louder(-3).is_("weak")
    assert turn.found.tried == (Tried(0, 0, "weak", True, 0.85),)
    assert turn.go(-1).now == Tried(0, 0, "ok", True, 0.85)
    assert turn.go(-1).inverted().is_("dead").found.inverted == []


def test_gains_stay_within_bounds():
    assert ActuatorRound.of(NONE).louder(1).now.gain == 1
    assert ActuatorRound.of(NONE).louder(-50).now.gain == 0.05


def test_undo_goes_back_through_all_findings_and_those_of_before():
    first = ActuatorRound.of(NONE).is_("weak")
    second = first.go(-1).is_("dead")  # found anew
    assert second.found.tried == (Tried(0, 0, "dead"),)
    back = second.undo()
    assert back.found.tried == (Tried(0, 0, "weak"),)
    assert back.undo().found == NONE
    assert back.undo().undo() is None
    taken_up = ActuatorRound.of(second.found)
    assert taken_up.now == Tried(0, 1)
    assert taken_up.undo().found == NONE
    assert taken_up.undo().now.place == (0, 0)


def test_a_round_that_is_whole_begins_at_the_first_and_goes_on():
    whole = NONE
    for place in ((0, 1), (1, 0), (0, 0), (1, 1)):
        whole = whole.with_tried(Tried(*place, gain=0.5))
    turn = ActuatorRound.of(whole)
    assert turn.now == Tried(0, 0, gain=0.5)
    assert turn.is_("dead").now.place == (0, 1)
    assert turn.go(-1).now.place == (1, 1)


def test_the_reference_is_the_last_other_one_that_was_well():
    turn = ActuatorRound.of(NONE)
    assert turn.reference is None
    turn = turn.is_("ok").is_("weak")
    assert turn.reference == (0, 0)
    assert turn.go(-2).reference is None


def test_the_actuator_in_turn_swings_as_it_is_set_even_if_it_was_dead():
    turn = ActuatorRound.of(NONE).is_("dead").go(-1).louder(-2)
    assert turn.shown.tried == (Tried(0, 0, gain=0.9),)
