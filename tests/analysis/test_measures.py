"""Measure of each kind of question, people left out of a comparison, and the reasons said."""

import numpy as np
import pytest

from tests.analysis.making import CASES, analysed, row_of, scored, trials_of
from vbraille.analysis import analyse, analyse_scores
from vbraille.errors import InputError


def test_one_person_without_noises_is_left_out_and_named():
    analysis = analyse([CASES / "F25-left-out-dprime.csv"])
    means = analysis.result.means
    assert means["mean"].round(2).to_list() == [0.84, 0.37]
    assert means["participants"].to_list() == [5, 5]
    (left,) = analysis.left_out
    assert left.startswith("P6: ")
    assert "d′" in left


def test_n_of_an_effect_is_that_of_the_test():
    analysis = analyse_scores(CASES / "F23-effect-n-scores.csv")
    (effect,) = analysis.result.effects.to_dict("records")
    assert effect["participants"] == 7
    assert effect["df2_uncorrected"] == 2 * 6
    assert [left[:3] for left in analysis.left_out] == ["P01", "P02", "P10"]


@pytest.mark.parametrize(("file", "chance"), [("name.csv", "17 %"), ("odd.csv", "33 %")])
def test_chance(file, chance):
    analysis = analyse([CASES / file])
    assert any(f"Guessing alone would give {chance}" in text for text in analysis.sentences)


def test_strings_and_one_name_have_no_chance(tmp_path):
    assert "Guessing" not in str(analyse([CASES / "thesis31.csv"]).sentences)
    rows = [{"participant": "P1", "question": "name", "presented": "a", "answered": "b"}]
    assert "Guessing" not in str(analysed(rows, tmp_path).sentences)


def test_a_threshold_beyond_the_levels_is_a_limit():
    analysis = analyse([CASES / "threshold_edge.csv"])
    table = analysis.tables["thresholds"]
    assert table["threshold"].isna().all()
    assert len(analysis.left_out) == 3
    assert all("above 0.4" in left for left in analysis.left_out)
    assert "nan" not in str(analysis.sentences)


def detection(people, threshold, spread=0.1, alarms=0.1, rng=None):
    """Answers of detection at seven levels, and to blank trials."""
    rows = []
    levels = np.linspace(0.1, 0.7, 7)
    for person in range(people):
        for level in levels:
            share = alarms + (1 - alarms) / (1 + np.exp(-(level - threshold) / spread))
            for yes in rng.random(20) < share:
                row = {"participant": f"P{person}", "question": "detect", "presented": "yes"}
                rows.append(row | {"answered": "yes" if yes else "no", "contrast": f"{level:.1f}"})
        for yes in rng.random(20) < alarms:
            row = {"participant": f"P{person}", "question": "detect", "presented": "no"}
            rows.append(row | {"answered": "yes" if yes else "no", "contrast": "0"})
    return rows


def test_thresholds_of_detection(rng, tmp_path):
    analysis = analysed(detection(6, 0.4, rng=rng), tmp_path)
    assert analysis.title.startswith("Threshold")
    (mean,) = analysis.result.means.to_dict("records")
    assert mean["participants"] == 6
    assert mean["mean"] == pytest.approx(0.4, abs=0.06)
    table = analysis.tables["thresholds"]
    assert (table["low"] < table["threshold"]).all()
    assert (table["threshold"] < table["high"]).all()
    assert table["blanks"].to_list() == [20] * 6


def test_thresholds_of_differences(rng, tmp_path):
    rows = []
    for person in range(4):
        for step in (0.5, 1.0, 1.5, 2.0, 3.0):
            share = 0.5 + 0.5 * (1 - np.exp(-np.log(2) * (step / 1.5) ** 2))
            for right in rng.random(30) < share:
                row = {
                    "participant": f"P{person}",
                    "question": "which",
                    "presented": f"2 {2 + step}",
                }
                row |= {"answered": "2" if right else f"{2 + step}", "outcome": "right"}
                rows.append(row if right else row | {"outcome": "wrong"})
    (mean,) = analysed(rows, tmp_path).result.means.to_dict("records")
    assert mean["mean"] == pytest.approx(1.5, abs=0.3)


def test_preferred_values_at_an_end_are_limits(tmp_path):
    rows = [
        {"participant": "P1", "question": "which", "presented": f"{one} {other}",
         "answered": f"{max(one, other)}"}
        for one in (1, 2, 3) for other in (1, 2, 3) if one != other for _ in range(10)
    ]  # fmt: skip
    analysis = analysed(rows, tmp_path)
    assert "an end of the range" in analysis.left_out[0]


def test_comparisons_of_words_prefer_nothing(tmp_path):
    rows = [{"participant": "P1", "question": "which", "presented": "ab cd", "answered": "ab"}] * 3
    analysis = analysed(rows, tmp_path)
    assert "no two values" in analysis.left_out[0]


def test_identical_conditions_have_no_test():
    analysis = analyse([CASES / "F39-noise-F.csv"])
    assert analysis.result.pairs["p"].isna().all()
    assert "F(" not in str(analysis.sentences)


def test_an_f_of_the_noise_of_rounding_is_none(tmp_path):
    rows = [
        {"participant": f"P{n}", "texture": level, "score": 0.1 * n + 0.1 + 0.2 + shift}
        for n in range(6)
        for level, shift in (("a", 0.0), ("b", 1e-16), ("c", -1e-16))
    ]
    result = scored(rows, tmp_path).result
    assert result.effects["F"].isna().all()
    assert result.effects["note"].all()
    assert result.pairs["p"].isna().all()


def test_reading_without_pauses():
    analysis = analyse([CASES / "F38-read-crash.csv"])
    assert analysis.result.means["mean"].round(1).to_list() == [38.6, 41.6]


def test_differences_are_those_of_the_means_beside_them():
    analysis = analyse([CASES / "F40-difference.csv"])
    (row,) = analysis.result.pairs.to_dict("records")
    assert row["value"] == pytest.approx(0.5)


def test_magnitudes_are_compared_by_ratios():
    analysis = analyse([CASES / "magnitude.csv"])
    means = analysis.result.means["mean"]
    (row,) = analysis.result.pairs.to_dict("records")
    assert np.exp(row["value"]) == pytest.approx(means[0] / means[1])
    assert row["low"] <= row["value"] <= row["high"]
    assert analysis.tables["ratings"]["ratings"].to_list() == [4, 4]


@pytest.mark.parametrize(
    ("question", "answers", "mean"), [("rating", "357", 5), ("adjust", ("1.5", "2", "2.5"), 2)]
)
def test_ratings_and_adjusted_values(question, answers, mean, tmp_path):
    rows = [
        {"participant": f"P{n}", "question": question, "presented": "x", "answered": answer}
        for n, answer in enumerate(answers)
    ]
    assert analysed(rows, tmp_path).result.means["mean"].to_list() == [mean]


def test_answers_in_words_are_not_compared(tmp_path):
    rows = [{"participant": "P1", "question": "free", "presented": "x", "answered": "soft"}]
    analysis = analysed(rows, tmp_path)
    assert analysis.result is None
    analysis.write(tmp_path / "report")
    assert (tmp_path / "report/tables/trials.csv").exists()


def test_a_person_is_in_no_test_for_a_missing_cell(tmp_path):
    analysis = analysed(trials_of({"A": [20, 22, 25, 9], "B": [17, 21, 22, None]}), tmp_path)
    assert analysis.result.pairs["participants"].to_list() == [3]
    assert analysis.left_out == ["P04: no trial in B"]


def test_a_person_without_an_answer_is_named(tmp_path):
    rows = trials_of({"A": [20, 22, 25, 9], "B": [17, 21, 22, 8]})
    rows = [row | ({"answered": "NA"} if row["participant"] == "P03" else {}) for row in rows]
    analysis = analysed(rows, tmp_path)
    assert analysis.left_out == ["P03: no trial that counts"]
    assert analysis.result.pairs["participants"].to_list() == [3]


@pytest.mark.parametrize("people", [1, 2])
def test_one_and_two_people_have_means_alone(people, tmp_path):
    analysis = analysed(trials_of({"A": [20, 22][:people], "B": [17, 23][:people]}), tmp_path)
    assert analysis.result.pairs["p"].isna().all()
    assert analysis.result.means["low"].isna().all()
    assert analysis.result.means["mean"].notna().all()


def test_a_group_of_two_is_not_tested(tmp_path):
    rows = [{"participant": f"P{n}", "group": "xy"[n < 2], "score": n**1.5} for n in range(7)]
    result = scored(rows, tmp_path).result
    assert result.pairs["p"].isna().all()
    assert result.pairs["value"].notna().all()


def test_factors_of_the_trials(tmp_path):
    rows = []
    for texture in ("0", "0.5", "1"):
        for size in ("s", "l"):
            shares = {f"{texture}{size}": [14 + n + len(size + texture) for n in range(5)]}
            rows += trials_of(shares, texture=texture, size=size)
    for n, row in enumerate(rows):
        row["answered"] = "ab" if n % 7 else "zz"
    analysis = analysed(rows, tmp_path, factors=["texture", "size"])
    assert analysis.result.effects["effect"].to_list() == ["texture", "size", "texture × size"]
    assert analysis.result.means["cell"].iloc[0] == "0, l"
    assert len(analysis.result.simple) == 5
    with pytest.raises(InputError, match="colour"):
        analysed(rows, tmp_path, factors=["colour"])


def test_another_measure(tmp_path):
    rows = trials_of({"A": [20, 22, 25], "B": [17, 21, 22]})
    rows = [row | {"duration_s": f"{2 + n % 5}"} for n, row in enumerate(rows)]
    analysis = analysed(rows, tmp_path, measure="duration")
    assert analysis.title.startswith("Duration")
    with pytest.raises(InputError, match="threshold"):
        analysed(rows, tmp_path, measure="rating")


def test_people_without_a_duration_are_named(tmp_path):
    rows = trials_of({"A": [20, 22, 25, 9], "B": [17, 21, 22, 8]})
    rows = [row | {"duration_s": f"{2 + n % 5}", "early": "0"} for n, row in enumerate(rows)]
    rows = [row | ({"early": "1"} if row["participant"] == "P02" else {}) for row in rows]
    analysis = analysed(rows, tmp_path, measure="duration")
    assert [left[:4] for left in analysis.left_out] == ["P02:"]
    assert analysis.result.pairs["participants"].to_list() == [3]


def test_unequal_trials_near_an_end_are_warned_of(tmp_path):
    shares = {"A": [(8, 8), (8, 8), (7, 8)], "B": [(39, 40), (38, 40), (40, 40)]}
    assert any("too often" in text for text in analysed(trials_of(shares), tmp_path).warnings)
    shares = {"A": [(4, 8), (5, 8), (3, 8)], "B": [(20, 40), (22, 40), (19, 40)]}
    assert not analysed(trials_of(shares), tmp_path).warnings


def test_a_small_group_beside_a_large_one_is_warned_of(tmp_path):
    rows = [
        {"participant": f"P{n}", "group": "x" if n < 3 else "y", "presented": "a",
         "answered": "ab"[(n * k) % 3 == 1]} for n in range(15) for k in range(10)
    ]  # fmt: skip
    warnings = analysed(rows, tmp_path, factors=["group"]).warnings
    assert any("3 and 12 people" in text for text in warnings)


def test_uncorrected_p_are_no_findings(tmp_path):
    result = analysed(trials_of({"A": [20, 22, 25, 18, 24, 23], "B": [17, 21, 22, 18, 19, 22],
                                 "C": [15, 20, 21, 12, 20, 16]}), tmp_path).result  # fmt: skip
    row = row_of(result.pairs, first="A", second="B")
    assert row["p"] < 0.05 < row["p_holm"]
    (said,) = [text for text in result.sentences if text.startswith("A less B")]
    assert "no difference is shown" in said


def test_a_p_that_rounds_to_a_twentieth_has_more_digits(tmp_path):
    gaps = np.linspace(-1, 1, 6)
    gaps = gaps / gaps.std(ddof=1) + 2.5708 / np.sqrt(6)
    rows = [
        {"participant": f"P{n}", "texture": level, "score": float(gap * (level == "x"))}
        for n, gap in enumerate(gaps)
        for level in "xy"
    ]
    (said,) = scored(rows, tmp_path).result.sentences[2:]
    assert "p = 0.050," not in said


def test_numbers_are_printed_without_exponents(tmp_path):
    rows = [
        {
            "participant": f"P{n}",
            "texture": level,
            "score": 1e6 * (n + 1) + 1e5 * n * (level == "x"),
        }
        for n in range(4)
        for level in "xy"
    ]
    assert "e+0" not in str(scored(rows, tmp_path).result.sentences)
