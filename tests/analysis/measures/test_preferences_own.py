"""Preferred values of participants, by the model of the nearer of two."""

import numpy as np
import pytest

from tests.analysis.measures.test_preferences import WIDTHS_MM, comparisons, nearest
from vbraille.analysis.measures.preferences import own_values
from vbraille.sessions.planning.protocolfiles import load_protocol

W = "dot_width_mm"


def test_each_participant_has_an_own_value_and_interval():
    told = nearest(WIDTHS_MM, 1.4) + [("P9", *rest) for _, *rest in nearest(WIDTHS_MM, 2.6)]
    frame = own_values(comparisons(*told), []).frame
    assert frame["participant"].tolist() == ["P0", "P9"]
    assert frame["comparisons"].tolist() == [90, 90]
    assert frame["preferred"].tolist() == pytest.approx([1.4, 2.6], abs=0.15)
    assert (frame["low"] < frame["preferred"]).all()
    assert (frame["preferred"] < frame["high"]).all()


def test_the_model_is_that_of_the_procedure_that_asked():
    told = [("P1", 1.5, 1.0, 1.5, W), ("P1", 2.0, 1.5, 1.5, W), ("P1", 1.8, 1.4, 1.8, W)]
    protocol = load_protocol("tuning-width-adaptive")
    frame = own_values(comparisons(*told), [load_protocol("letters"), protocol]).frame
    quest = protocol.procedure.quest(protocol.design)
    history = [((1.0, 1.5), 0), ((1.5, 2.0), 1), ((1.4, 1.8), 0)]
    known = quest.estimate(history, "preferred")
    row = frame.iloc[0]
    assert tuple(row[["preferred", "low", "high", "sd"]]) == pytest.approx(
        (known.mean, known.low, known.high, known.sd)
    )
    usual = own_values(comparisons(*told), []).frame.iloc[0]
    assert usual["high"] <= 2.0 < row["high"]


def test_of_one_value_there_is_nothing_to_say_and_of_guesses_not_much():
    random = np.random.default_rng(1)
    guesses = [("P1", a, b, (a, b)[random.integers(2)], *rest)
               for _, a, b, _, *rest in nearest(WIDTHS_MM, 1.4, repeats=1)]  # fmt: skip
    row = own_values(comparisons(*guesses), []).frame.iloc[0]
    assert row["high"] - row["low"] > 0.5
