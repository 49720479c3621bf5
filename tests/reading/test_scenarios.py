"""Scenes of the source's scenarios under a hand in memory: Lévesque 2009, chapter 10."""

from pathlib import Path

import numpy as np
import pytest

from tests.reading.felt import Felt

SCENES = Path("texts/scenes")
# Where a finger goes, and what is said on entering each place.
WAYS = {
    "route": [
        (30, 120, "entering: Start"),
        (60, 120, "entering: Route on Mill Street"),
        (80, 95, "entering: Route on Church Street"),
        (120, 70, "entering: Route on High Street"),
        (160, 55, "entering: Route on Station Street"),
        (160, 25, "entering: Goal, the station"),
    ],
    "prices": [
        (55, 90, "entering: Bread in 2005, 2 euros"),
        (115, 100, "entering: Milk in 2005, 1 euro"),
        (175, 90, "entering: Tea in 2005, 3 euros"),
    ],
    "triangle": [
        (55, 110, "entering: Corner C"),
        (55, 75, "entering: Side b"),
        (55, 32, "entering: Corner A"),
        (107, 71, "entering: Side c"),
        (159, 110, "entering: Corner B"),
        (110, 110, "entering: Side a"),
        (85, 90, "entering: Inside of the triangle"),
    ],
}
# A place where key 1 changes what is felt, what it says, and what is there before and after it.
CHANGES = {
    "route": (190, 70, "Streets: hidden", "High Street", None),
    "prices": (55, 50, "Year: 2025", None, "Bread in 2025, 4 euros"),
    "triangle": (80, 76, "Height: shown", "Inside of the triangle", "Height on side c"),
}


@pytest.mark.parametrize("name", WAYS)
def test_a_finger_is_told_of_the_parts_and_feels_what_a_key_changes(name):
    felt = Felt(SCENES / f"{name}.scene", entering=True)
    for x_mm, y_mm, said in WAYS[name]:
        felt.be_at(5.0, 5.0)  # beside all of them
        assert felt.be_at(x_mm, y_mm)[0] in (said, said.replace("entering", "edge")), said
        felt.bench.run(0.5)
        assert np.ptp(felt.bench.sent[-400:]) > 0.3, said
    x_mm, y_mm, told, before, after = CHANGES[name]
    felt.be_at(x_mm, y_mm)
    felt.bench.run(0.5)
    shown = felt.engine.output.copy()
    assert before is None or felt.press("i")[0] == f"here: {before}"
    assert felt.press("1")[0] == told
    felt.bench.run(0.3)
    assert after is None or felt.press("i")[0] == f"here: {after}"
    assert np.abs(felt.engine.output - shown).max() > 0.3


def test_start_and_goal_pulse_and_the_wave_goes_on_under_a_hand_at_rest():
    felt = Felt(SCENES / "route.scene")
    for place, period_s in (((30, 120), 2.0), ((160, 25), 0.5), ((80, 95), 0.5)):
        felt.at = place
        felt.bench.run(0.3)
        middle = felt.bench.run(4.0)["frame"][:, 3, 3].reshape(80, 50)  # ms
        strength = middle.mean(axis=1) if place == (80, 95) else np.ptp(middle, axis=1)
        cycles = np.abs(np.fft.rfft(strength - strength.mean())).argmax()
        assert cycles == pytest.approx(4.0 / period_s), place
