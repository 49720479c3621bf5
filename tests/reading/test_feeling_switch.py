"""Switches of a picture under keys: what is felt, found and said changes with them."""

import numpy as np
import pytest

from tests.reading.felt import Felt

MAP = """
title = "Two views"
canvas = { width_mm = 100, height_mm = 100 }

[signals.land]
kind = "switch"
title = "View"
levels = [1, 0]
states = ["land", "sea"]

[signals.sea]
kind = "inverse"
of = "land"

[[elements]]
kind = "circle"
title = "Island"
center_mm = [50, 50]
radius_mm = 20
fill = { texture = { kind = "uniform", level = 0.5 } }
factor = "land"

[[elements]]
kind = "circle"
title = "Bay"
center_mm = [50, 50]
radius_mm = 20
fill = { texture = { kind = "uniform" } }
factor = "sea"
"""


@pytest.fixture
def felt(tmp_path):
    path = tmp_path / "map.scene"
    path.write_text(MAP)
    return Felt(path)


def test_a_key_changes_what_is_felt_and_what_is_found(felt):
    felt.at = (50.0, 50.0)
    felt.bench.run(0.5)
    assert felt.press("i")[0] == "here: Island"
    np.testing.assert_allclose(felt.engine.output, 0.5)
    assert felt.press("1") == ["View: sea"]
    felt.bench.run(0.005)
    assert (felt.engine.output > 0.5).all()
    felt.bench.run(0.2)
    np.testing.assert_allclose(felt.engine.output, 1.0)
    assert felt.press("i")[0] == "here: Bay"
    assert felt.press("1") == ["View: land"]


def test_a_switch_that_a_picture_has_not_is_said(felt):
    assert felt.press("2") == ["switch 2: this picture has none"]


def test_a_picture_that_is_read_again_begins_as_at_first(felt):
    felt.press("1")
    assert felt.engine.switches
    felt.feeler.reload()
    assert not felt.engine.switches
