"""The sentences at the head of a report: true to the tables' rows."""

import re
from dataclasses import replace

import numpy as np
import pytest

from tests.analysis.making import COLUMNS, from_rows, sheet
from vbraille.analysis.chapters import Options, analyse_study, compare_scores
from vbraille.analysis.findings import findings, interval_words
from vbraille.analysis.input.parsing import parse
from vbraille.analysis.input.scoretable import Scores
from vbraille.analysis.input.study import Study
from vbraille.analysis.results import Kind, to_print


def study(*lines, columns=COLUMNS):
    parsed = parse([sheet(*lines, columns=columns)])
    return Study(parsed.trials, parsed.comparisons, (), (), (), (), ())


def lines(rng, people=6, conditions=("T0", "T25", "T100"), shares=(0.2, 0.5, 0.95), trials=20):
    for who in range(people):
        for condition, share in zip(conditions, shares, strict=True):
            for _ in range(trials):
                text = "".join(rng.choice(list("abcde"), 2))
                answer = text if rng.random() < share else text[0] + rng.choice(list("abxyz"))
                yield f"P{who} {condition} {text} {answer} {rng.uniform(5, 20):.2f}"


@pytest.fixture(scope="module")
def results():
    return analyse_study(study(*lines(np.random.default_rng(7))), Options())


def rows(results, name):
    (table,) = [table for table in results.result_tables() if table.name == name]
    return table.records()


def one(results, pattern):
    (found,) = [finding for finding in results.findings if re.search(pattern, finding)]
    return found


def test_the_averages_and_their_intervals(results):
    said = one(results, "^On average participants read right")
    for row in rows(results, "averages"):
        numbers = (to_print(row[name], Kind.PERCENT) for name in ("legibility", "low", "high"))
        mean, low, high = numbers
        assert (
            f"{mean} % of strings in {row['condition']} (6 participants, 95 % interval {low} to "
            f"{high} %)"
        ) in said
    least = min(rows(results, "legibility"), key=lambda row: row["legibility"])
    share = to_print(least["legibility"], Kind.PERCENT)
    assert f"The least was {share} % by {least['participant']} in {least['condition']}" in one(
        results, "^The least"
    )


def test_differences_say_what_the_tests_say(results):
    for row in rows(results, "t_tests"):
        if row["measure"] == "legibility of characters":
            continue
        pair = (row["first"], row["second"])
        name = row["measure"].removesuffix(" (s)").capitalize()
        found = [
            finding
            for finding in results.findings
            if name.lower() in finding.lower()
            and (
                f"in {pair[0]} than in {pair[1]} (" in finding
                or f"between {pair[0]} and {pair[1]} is not shown" in finding
            )
        ]
        (said,) = found
        assert f"t({row['df']}) = {to_print(row['t'], Kind.NUMBER)}" in said
        assert ("is not shown" in said) == (row["p_corrected"] >= 0.05)
        if row["p_corrected"] < 0.05:
            assert ("higher" in said) == (row["mean_difference"] > 0)
        assert ("corrected p" in said) == (row["p_corrected"] != row["p"])
        assert f"d_z {to_print(row['d_z'], Kind.NUMBER)}, " in said
    legible = [f for f in results.findings if f.startswith("Legibility of strings was")]
    assert any("lower in T0 than in T100" in finding for finding in legible)


def test_an_effect_is_told_with_its_tests(results):
    row = next(r for r in rows(results, "anova") if r["measure"] == "legibility of strings")
    said = one(results, r"^Legibility of strings changed with condition \(F\(2, 10\) = ")
    assert f"F(2, 10) = {to_print(row['f'], Kind.NUMBER)}" in said
    assert "by Greenhouse and Geisser p" in said
    low, high = (to_print(row[name], Kind.NUMBER) for name in ("partial_low", "partial_high"))
    assert f"95 % interval {low} to {high}" in said


def test_characters_errors_and_runs(results):
    characters = rows(results, "characters")
    best, worst = (end(characters, key=lambda row: row["legibility"]) for end in (max, min))
    said = one(results, "^Of 5 characters")
    assert f"{best['name']} ({to_print(best['legibility'], Kind.PERCENT)} %)" in said
    assert f"{worst['name']} ({to_print(worst['legibility'], Kind.PERCENT)} %)" in said
    errors = rows(results, "errors")
    assert f"Of {sum(row['count'] for row in errors)} places" in one(results, "most frequent kind")
    assert errors[0]["error"] in one(results, "most frequent kind")
    confusions = rows(results, "confusion_characters")
    most = max(
        (count, row["presented"], name.removeprefix("answered "))
        for row in confusions
        for name, count in row.items()
        if name not in ("presented", f"answered {row['presented']}")
    )
    assert f"{most[1]} was taken for {most[2]}" in one(results, "^Most often")
    known = [row for row in rows(results, "slopes") if row["p"] is not None]
    assert f"Of {len(known)} series" in one(results, "legibility rose in")


def test_the_main_figure_has_the_participants_points(results):
    assert results.main == "means_condition"
    figure = next(each for each in results.figures() if each.name == results.main)
    (series,) = figure.chart.panels[0][1]
    own = [r for r in rows(results, "level_scores") if r["measure"] == "legibility of strings"]
    assert len(series.points) == 6
    assert sorted(100 * row["mean"] for row in own) == pytest.approx(
        sorted(value for points in series.points for value in points)
    )
    assert "95 % interval" in figure.text
    for name in ("dots", "errors"):
        chart = next(p.chart for p in results.figures() if p.name == name)
        assert len(chart.panels[0][1][0].points) == 6


@pytest.mark.parametrize("people", [1, 2, 3])
def test_findings_about_people_are_of_three_or_more(people):
    """With fewer than three, the first sentence says so, and none has a test or an interval."""
    results = analyse_study(study(*lines(np.random.default_rng(1), people=people)), Options())
    who = {1: "P0", 2: "P0 and P1", 3: "On average participants"}[people]
    said = one(results, rf"^{who} read right")
    first = results.findings[0].startswith(f"What follows describes {who} alone")
    tests = [finding for finding in results.findings if re.search(r"d_z|p [=<] ", finding)]
    assert (first, bool(tests), "interval" in said) == (
        (True, False, False) if people < 3 else (False, True, True)
    )
    assert not any("nan" in finding or "None" in finding for finding in results.findings)


def test_what_answers_carried_is_of_these_trials(results):
    said = one(results, "bits of a character")
    assert said.startswith("In these trials an answer carried ")
    assert said.endswith(", for the people who answered, and no others).")


def compared(people):
    """Comparisons of three widths, the middle one liked."""
    for who in range(people):
        for one, two, chosen in ((1, 2, 2), (3, 2, 2), (1, 3, 3), (2, 3, 2), (3, 1, 1), (2, 1, 2)):
            for _ in range(4):
                yield {
                    "participant": f"P{who}", "condition": "all", "parameter": "dot_width_mm",
                    "presented": f"{one} {two}", "answered": f"{chosen}",
                }  # fmt: skip


@pytest.mark.parametrize("people", [1, 2, 4])
def test_no_sentence_is_empty_or_ends_before_its_end(people):
    parsed = parse([from_rows("made", [*compared(people)])])
    results = analyse_study(Study(None, parsed.comparisons, (), (), (), (), ()), Options())
    (said,) = [finding for finding in results.findings if "preferred" in finding]
    assert said.startswith("The preferred dot width is" if people > 2 else "The dot width that P0")
    assert "how people differ is seen" not in said
    for finding in results.findings:
        assert not re.search(r"[;:,(]\s*[.;,)]|\(\)|\s\.", finding), finding


def test_reasons_stand_for_numbers_that_are_not_there():
    row = {"low": None, "high": None, "note": "no duration: none; no interval: all are alike"}
    assert interval_words(row, Kind.NUMBER) == "no interval: all are alike"
    assert interval_words(row | {"note": ""}, Kind.NUMBER) == "no interval is known"
    assert interval_words({"low": 1.0, "high": 2.0}, Kind.NUMBER, " s") == (
        "95 % interval 1.000 to 2.000 s"
    )


def test_what_has_no_number_is_not_told_as_one(results):
    tables = []
    for table in results.result_tables():
        if table.name == "information":
            empty = table.frame.assign(corrected_bits=float("nan"), note="too few")
            tables.append(replace(table, frame=empty))
    assert findings(tables) == ("How much information answers carried is not known: too few.",)


def test_choices_are_told_with_the_preferred_value():
    columns = "participant condition parameter presented answered"
    pairs = [
        f"P{who} all dot_width_mm {a}_{b} {b if abs(b - 2) < abs(a - 2) else a}"
        for who in range(4)
        for a in (1.0, 1.5, 2.0, 2.5, 3.0)
        for b in (1.0, 1.5, 2.0, 2.5, 3.0)
        if a != b
    ]
    made = sheet(*pairs, columns=columns)
    made.frame["presented"] = made.frame["presented"].str.replace("_", " ")
    parsed = parse([made])
    results = analyse_study(Study(None, parsed.comparisons, (), (), (), (), ()), Options())
    said = one(results, "^The preferred dot width is")
    (row,) = rows(results, "preferred")
    assert f"is {to_print(row['preferred'], Kind.NUMBER)} mm" in said
    assert "80 comparisons of 4 participants" in said
    assert results.main == "choices_dot_width_mm"
    (series,) = next(each for each in results.figures() if each.name == results.main).chart.panels[
        0
    ][1]
    assert len(series.points) == 4


def test_scores_are_told_too():
    scores = Scores(
        "score", list("AABBCCDD"), {"t": list("01010101")}, [1.0, 3, 2, 5, 1, 2.5, 2, 4]
    )
    results = compare_scores(scores, [("Data", "8 scores")], Options())
    assert one(results, "^Score was [0-9.]+ lower in 0 than in 1 ")
    assert results.main == "means_t"
