"""Tables of what was detected, told apart, rated, estimated and said, against values by hand."""

import math

import pytest
from scipy.stats import norm, t

from tests.analysis.making import from_rows, record, sheet
from vbraille.analysis.chapters import Options, analyse_study
from vbraille.analysis.figures import rises
from vbraille.analysis.input.parsing import parse
from vbraille.analysis.input.sheets import read_csv
from vbraille.analysis.input.study import Study
from vbraille.analysis.measures import rated
from vbraille.analysis.measures.discrimination import sensitivity, thresholds
from vbraille.analysis.statistics.psychometric import fit_psychometric
from vbraille.errors import InputError

COLUMNS = "participant condition contrast presented answered question outcome confidence"


def judgements(*lines, columns=COLUMNS):
    """Judgements of such lines."""
    return parse([sheet(*lines, columns=columns)]).judgements


def detected(participant, condition, contrast, yes, no):
    """Lines of trials of one condition: so many yes and so many no; 0 is nothing."""
    there = contrast > 0
    said = (("yes", "hit" if there else "false_alarm"), ("no", "miss" if there else "rejected"))
    names = {"false_alarm": "false alarm", "rejected": "correct rejection"}
    return [
        {
            "participant": participant, "condition": condition, "contrast": contrast,
            "presented": "⠉", "answered": answer, "question": "detect",
            "outcome": names.get(outcome, outcome), "confidence": "",
        }
        for times, (answer, outcome) in zip((yes, no), said, strict=True)
        for _ in range(times)
    ]  # fmt: skip


def found(rows):
    """Judgements of rows."""
    return parse([from_rows("made", rows)]).judgements


def test_detection_by_hand():
    rows = detected("P1", "blank", 0.0, 3, 17) + detected("P1", "full", 0.5, 15, 5)
    table = sensitivity(found(rows))
    row = record(table, participant="P1")
    assert (row["condition"], row["hits"], row["signals"]) == ("full", 15, 20)
    assert (row["false_alarms"], row["noises"]) == (3, 20)
    hit, alarm = norm.ppf(15.5 / 21), norm.ppf(3.5 / 21)
    assert row["d_prime"] == pytest.approx(hit - alarm)
    assert row["criterion"] == pytest.approx(-(hit + alarm) / 2)
    error = math.sqrt(sum(
        p * (1 - p) / 20 / norm.pdf(norm.ppf(p)) ** 2 for p in (15.5 / 21, 3.5 / 21)
    ))  # fmt: skip
    assert row["d_high"] - row["d_prime"] == pytest.approx(norm.ppf(0.975) * error)
    assert row["criterion_high"] - row["criterion"] == pytest.approx(norm.ppf(0.975) * error / 2)


def test_blank_trials_of_one_participant_are_not_those_of_another():
    rows = detected("P1", "blank", 0.0, 0, 8) + detected("P1", "full", 0.5, 6, 2)
    rows += detected("P2", "blank", 0.0, 5, 3) + detected("P2", "full", 0.5, 6, 2)
    table = sensitivity(found(rows))
    assert record(table, participant="P1")["d_prime"] > record(table, participant="P2")["d_prime"]
    assert record(table, participant="P2")["false_alarms"] == 5


def test_without_blank_trials_there_is_no_sensitivity():
    row = record(sensitivity(found(detected("P1", "full", 0.5, 6, 2))), hits=6)
    assert row["d_prime"] is None
    assert row["note"] == "no d′: no trials with nothing"


def test_same_or_different_by_hand():
    columns = COLUMNS
    lines = ["P1 all - 1,2 different same-different hit -"] * 12
    lines += ["P1 all - 1,2 same same-different miss -"] * 4
    lines += ["P1 all - 1,1 different same-different false_alarm -"] * 2
    lines += ["P1 all - 1,1 same same-different correct_rejection -"] * 14
    rows = [dict(zip(columns.split(), line.replace("-d", "~d").split(), strict=True))
            for line in lines]  # fmt: skip
    for row in rows:
        row |= {"contrast": "", "confidence": "", "presented": row["presented"].replace(",", " ")}
        row |= {"question": "same-different", "outcome": row["outcome"].replace("_", " ")}
    row = record(sensitivity(found(rows)), question="same-different")
    assert (row["hits"], row["signals"], row["false_alarms"], row["noises"]) == (12, 16, 2, 16)
    # By the difference felt: F = 2 Φ(-k / √2) and H = Φ((d - k) / √2) + Φ((-d - k) / √2).
    hits, alarms, d = 12.5 / 17, 2.5 / 17, row["d_prime"]
    k = -math.sqrt(2) * norm.ppf(alarms / 2)
    assert norm.cdf((d - k) / math.sqrt(2)) + norm.cdf((-d - k) / math.sqrt(2)) == pytest.approx(
        hits
    )


def test_which_of_two_by_hand():
    rows = []
    for presented, answered, outcome, times in (
        ("1 2", "2", "right", 9), ("1 2", "1", "wrong", 1),
        ("2 1", "2", "right", 6), ("2 1", "1", "wrong", 4),
    ):  # fmt: skip
        rows += [{
            "participant": "P1", "condition": "all", "presented": presented, "answered": answered,
            "question": "which", "outcome": outcome, "parameter": "dot_width_mm",
        }] * times  # fmt: skip
    parsed = parse([from_rows("made", rows)])
    assert len(parsed.comparisons) == 20
    row = record(sensitivity(parsed.judgements), question="which")
    assert (row["hits"], row["signals"], row["false_alarms"], row["noises"]) == (6, 10, 1, 10)
    z = norm.ppf(6.5 / 11) - norm.ppf(1.5 / 11)
    assert row["d_prime"] == pytest.approx(z / math.sqrt(2))


def test_a_threshold_where_a_level_varies():
    shares = {0.0: 1, 0.1: 2, 0.2: 10, 0.3: 18, 0.4: 19}
    rows = [
        row for level, yes in shares.items()
        for row in detected("P1", f"c{level}", level, yes, 20 - yes)
    ]  # fmt: skip
    row = record(thresholds(found(rows))[0], participant="P1")
    assert (row["level"], row["trials"]) == ("contrast", 100)
    assert row["threshold"] == pytest.approx(0.2, abs=0.02)
    assert row["low"] < row["threshold"] < row["high"]


def test_blank_trials_tell_of_guesses_and_are_at_no_level():
    """Whatever width their dots would have had: they have no contrast, or no dots."""
    yes = {1.0: 4, 1.2: 8, 1.4: 13, 1.6: 18, 1.8: 19}
    rows = [row | {"dot_width_mm": width} for width, of in yes.items()
            for row in detected("P1", "seen", 0.5, of, 20 - of)]  # fmt: skip
    rows += [row | {"dot_width_mm": 1.6} for row in detected("P1", "blank", 0.0, 4, 16)]
    table, levels = thresholds(found(rows))
    row = record(table, level="dot_width_mm")
    assert (row["trials"], row["blanks"], row["note"]) == (120, 20, "")
    fit = fit_psychometric(list(yes), list(yes.values()), [20] * 5, guess=None, blanks=(4, 20))
    assert (row["threshold"], row["guesses"]) == pytest.approx((fit.threshold, fit.guess), rel=1e-4)
    *seen, blank = [of for of in levels.records() if of["level"] == "dot_width_mm"]
    assert [(of["value"], of["positive"]) for of in seen] == list(yes.items())
    assert (blank["value"], blank["positive"], blank["trials"]) == (None, 4, 20)
    assert blank["fitted"] == row["guesses"]
    (figure,) = rises(table, levels)
    assert [panel.levels for panel in figure.chart.rises if "width" in panel.name] == [tuple(yes)]


def test_without_blank_trials_that_is_said_beside_the_threshold():
    rows = [row for level, yes in {0.1: 6, 0.2: 12, 0.3: 18, 0.4: 20}.items()
            for row in detected("P1", f"c{level}", level, yes, 20 - yes)]  # fmt: skip
    row = record(thresholds(found(rows))[0], participant="P1")
    assert row["blanks"] == 0
    assert "no blank trials: the levels alone tell of guesses" in row["note"]


def test_a_threshold_of_contrast_ends_where_contrast_does():
    rows = detected("P1", "blank", 0.0, 0, 20)
    rows += [row for level, yes in {0.4: 0, 0.7: 1, 1.0: 4}.items()
             for row in detected("P1", f"c{level}", level, yes, 20 - yes)]  # fmt: skip
    row = record(thresholds(found(rows))[0], participant="P1")
    assert row["low"] < 1 == row["high"]
    rows = detected("P1", "blank", 0.0, 0, 20)
    rows += [row for level, yes in {0.1: 15, 0.4: 17, 0.7: 18}.items()
             for row in detected("P1", f"c{level}", level, yes, 20 - yes)]  # fmt: skip
    row = record(thresholds(found(rows))[0], participant="P1")
    assert 0 <= row["low"] < 0.1
    assert "begins below the lowest level presented, 0.1" in row["note"]


def test_two_levels_make_no_threshold():
    rows = detected("P1", "blank", 0.0, 1, 9) + detected("P1", "full", 0.5, 9, 1)
    row = record(thresholds(found(rows))[0], participant="P1")
    assert row["threshold"] is None
    assert row["note"].startswith("no threshold: ")


def chosen(participant, less, more, times, right, rule="more"):
    """Comparisons of two widths of which the wider is right: so many, and so many right ones."""
    rows = []
    for number in range(times):
        pair = (less, more) if number % 2 else (more, less)
        best = more if rule == "more" else less
        answered = best if number < right else less + more - best
        rows.append({
            "participant": participant, "condition": "all", "parameter": "dot_width_mm",
            "presented": f"{pair[0]:g} {pair[1]:g}", "answered": f"{answered:g}",
            "question": "which", "outcome": "right" if number < right else "wrong",
        })  # fmt: skip
    return rows


@pytest.mark.parametrize("rule", ["more", "less"])
def test_a_threshold_of_which_of_two(rule):
    """By the difference, half of the answers guessed: four standards make the same levels."""
    right = {0.1: 21, 0.2: 24, 0.4: 33, 0.8: 39}
    rows = [row for apart, times in right.items()
            for row in chosen("P1", 1.0, 1.0 + apart, 40, times, rule)]  # fmt: skip
    table, levels = thresholds(found(rows))
    row = record(table, participant="P1")
    assert (row["question"], row["level"], row["trials"]) == ("which", "dot_width_mm", 160)
    fit = fit_psychometric(list(right), list(right.values()), [40] * 4, shape="weibull", guess=0.5)
    assert row["threshold"] == pytest.approx(fit.threshold, rel=1e-4)
    assert row["low"] < 0.3 < row["high"]
    assert row["guesses"] == 0.5
    assert [level["value"] for level in levels.records()] == list(right)
    assert [level["positive"] for level in levels.records()] == list(right.values())
    assert levels.records()[3]["fitted"] == pytest.approx(float(fit.shares(0.8)), rel=1e-4)
    (figure,) = rises(table, levels)
    (panel,) = figure.chart.rises
    assert panel.across == "difference of dot width (mm)"
    assert panel.threshold[1] < panel.threshold[0] < panel.threshold[2]
    assert "P1, dot_width_mm: 0." in figure.text


def test_two_values_are_told_apart_however_they_are_written():
    columns = "participant trial condition first second answered question outcome"
    lines = [f"P1 {trial} all 1.50 2 1.5 which wrong" for trial in range(1, 4)]
    one = sheet(*lines, "P1 4 all 2 1.5 2.0 which right", columns=columns).frame
    one["presented"] = one["first"] + " " + one["second"]
    told = found(one.to_dict("records"))
    row = record(sensitivity(told), participant="P1")
    assert (row["signals"], row["hits"], row["noises"], row["false_alarms"]) == (1, 1, 3, 3)
    note = record(thresholds(told)[0], participant="P1")["note"]
    assert not note.startswith("no threshold: neither")


def test_levels_of_a_table_with_semicolons_have_decimal_commas(tmp_path):
    path = tmp_path / "judged.csv"
    path.write_text(
        "participant;condition;contrast;presented;answered;question;outcome\n"
        "P1;a;0,5;⠉;yes;detect;hit\nP1;a;0,25;⠉;no;detect;miss\n"
        "P1;b;;1,5 2;1,50;which;wrong\n"
    )
    told = parse([read_csv(path)]).judgements
    assert told["contrast"].tolist()[:2] == [0.5, 0.25]
    assert told[["presented", "answered"]].values.tolist()[2] == ["1.5 2", "1.5"]


def test_which_is_nearest_has_no_threshold():
    rows = chosen("P1", 1.0, 1.5, 10, 8) + chosen("P1", 2.0, 2.5, 10, 8, "less")
    table, levels = thresholds(found(rows))
    (row,) = table.records()
    assert row["note"] == (
        "no threshold: neither the larger of two is always right, nor the smaller"
    )
    assert not len(levels)
    assert not list(rises(table, levels))


RATED = "participant condition presented answered question"


def test_ratings_by_hand():
    lines = [f"P{n} {condition} c {rating} rating"
             for n, smooth, rough in ((1, "12", "56"), (2, "22", "67"), (3, "33", "55"))
             for condition, ratings in (("smooth", smooth), ("rough", rough))
             for rating in ratings]  # fmt: skip
    means, pairs = rated.ratings(judgements(*lines, columns=RATED))
    row = record(means, condition="smooth")
    own = [1.5, 2.0, 3.0]
    mean = sum(own) / 3
    half = t.ppf(0.975, 2) * math.sqrt(sum((x - mean) ** 2 for x in own) / 2 / 3)
    assert (row["participants"], row["ratings"], row["median"]) == (3, 6, 2)
    assert (row["mean"], row["low"]) == pytest.approx((mean, mean - half))
    pair = record(pairs, first="rough")
    assert (pair["second"], pair["higher"], pair["participants"]) == ("smooth", 1.0, 3)


def test_intervals_of_ratings_end_where_the_scale_does():
    """At both ends; without a scale that is known they are Student's as they are."""
    lines = [f"P{n} {condition} c {rating} rating"
             for n, low, high in ((1, 1, 7), (2, 1, 7), (3, 3, 4))
             for condition, rating in (("smooth", low), ("rough", high))]  # fmt: skip
    told = judgements(*lines, columns=RATED)
    for scales, beyond in (({"": (1, 7)}, False), ({}, True)):
        rows = rated.ratings(told, scales)[0].records()
        assert (min(row["low"] for row in rows) < 1, max(row["high"] for row in rows) > 7) == (
            beyond, beyond,
        )  # fmt: skip
    sure = [f"P{n} all 1 c yes detect hit {confidence}" for n, confidence in enumerate((1, 1, 3))]
    row = record(rated.confidence(judgements(*sure), {"": (1, 4)}), outcome="hit")
    assert row["low"] == 1 < row["mean"] < row["high"] <= 4


def test_no_interval_of_d_prime_begins_below_nothing():
    rows = detected("P1", "blank", 0.0, 3, 7) + detected("P1", "full", 0.5, 4, 6)
    rows += detected("P2", "blank", 0.0, 8, 2) + detected("P2", "full", 0.5, 2, 8)
    table = sensitivity(found(rows))
    near, turned = (record(table, participant=name) for name in ("P1", "P2"))
    assert near["d_low"] == 0 < near["d_prime"] < near["d_high"]
    assert turned["d_low"] < turned["d_prime"] < 0  # yes and no were taken for each other


def test_magnitudes_by_hand():
    # Numbers are of an own size; the strong one is 2, 3 and 4 times as much as the weak one.
    lines = [f"P{n} {condition} c {size * (n + 1 if condition == 'strong' else 1):g} magnitude"
             for n, size in ((1, 1.0), (2, 10.0), (3, 100.0))
             for condition in ("weak", "strong")]  # fmt: skip
    table = rated.magnitudes(judgements(*lines, columns=RATED))
    row = record(table, condition="strong")
    logs = [math.log(factor) for factor in (2, 3, 4)]
    mean = math.log(10) + sum(logs) / 3
    # Less half of its own ratio, which is the mean of its two conditions, plus that of all.
    own = [math.log(10) + log / 2 + sum(logs) / 6 for log in logs]
    half = t.ppf(0.975, 2) * math.sqrt(sum((x - mean) ** 2 for x in own) / 2 / 3)
    assert row["mean"] == pytest.approx(math.exp(mean))
    assert (row["low"], row["high"]) == pytest.approx(
        (math.exp(mean - half), math.exp(mean + half))
    )
    assert record(table, condition="weak")["mean"] == pytest.approx(10.0)


def test_confidence_by_condition_and_outcome():
    lines = ["P1 all 1 c yes detect hit 4", "P1 all 1 c yes detect hit 2",
             "P2 all 1 c yes detect hit 1", "P2 all 1 c no detect miss 1"]  # fmt: skip
    table = rated.confidence(judgements(*lines))
    row = record(table, outcome="hit")
    assert (row["participants"], row["answers"], row["mean"]) == (2, 3, 2.0)
    assert record(table, outcome="miss")["mean"] == 1.0


def test_confidence_of_strings_that_were_read():
    columns = "participant condition presented answered question outcome confidence"
    parsed = parse([sheet("P1 T0 a a identify right 3", "P1 T0 a c identify wrong 1",
                          columns=columns)])  # fmt: skip
    assert parsed.trials["correct"].tolist() == [True, False]
    assert record(rated.confidence(parsed.judgements), outcome="right")["mean"] == 3


def test_words_are_told_as_they_are():
    rows = [{"participant": "P1", "condition": "all", "presented": "⠉", "trial": 4,
             "answered": "like sand; dry", "question": "free"}]  # fmt: skip
    row = record(rated.words(found(rows)), participant="P1")
    assert (row["answered"], row["trial"]) == ("like sand; dry", 4)


def test_strings_without_confidence_are_no_judgements():
    columns = "participant condition presented answered question outcome confidence"
    assert judgements("P1 T0 a a identify right -", columns=columns) is None
    assert judgements("P1 T0 a a -", columns="participant condition presented answered x") is None


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("P1 all 1 c yes detekt hit -", "question is 'detekt'; it must be one of identify"),
        ("P1 all 1 c yes detect right -", "outcome is 'right'; of the question 'detect'"),
        ("P1 all 1 c rough rating - -", "answered is 'rough'; give a number"),
        ("P1 all 1 c nan rating - -", "answered is 'nan'; give a number"),
        ("P1 all 1 c NA magnitude - -", "answered is 'NA'; give a number"),
        ("P1 all 1 c 1e200 rating - -", "answered is '1e200'; give a number"),
        ("P1 all 1 c 0 magnitude - -", "answered is '0'; a magnitude must be above 0"),
        ("P1 all 1 c yes detect hit sure", "confidence is 'sure'; give a number"),
    ],
)
def test_what_cannot_be_used_is_said_with_its_row(line, said):
    with pytest.raises(InputError, match=r"^made row 1: ") as refused:
        judgements(line)
    assert said in str(refused.value)


def test_the_report_has_a_chapter_for_each():
    lines = ["P1 all 1 c yes detect hit 2", "P1 all 1 c 3 rating - -",
             "P1 all 1 c 3 magnitude - -", "P1 all 1 c soft free - -"]  # fmt: skip
    study = Study(None, None, (), (), (), (), (), judgements(*lines))
    results = analyse_study(study, Options())
    assert [chapter.title for chapter in results.chapters] == [
        "Other measures", "Telling apart", "Ratings", "Magnitudes", "Confidence",
        "Words", "Sources",
    ]  # fmt: skip
    assert set(results.tables) == {  # none without rows
        "exploratory", "sensitivity", "ratings", "magnitudes", "confidence", "words",
        "sources",
    }  # fmt: skip
