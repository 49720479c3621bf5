"""The published tables, made again from what they follow from."""

from itertools import combinations

import numpy as np
import pytest

from tests.analysis.making import analysed, row_of, scored
from tests.analysis.published import (
    F_TESTS,
    METHODS,
    PRINTED_6_3,
    PRINTED_6_4,
    SIZES,
    T_TESTS,
    TABLE_6_2,
    TABLE_6_3,
    TABLE_6_4,
    TOLD,
    TOTALS_6_2,
)
from vbraille.analysis import stats

READ, CHARACTERS, PAIRS = TOLD["table_3_1"], TOLD["table_3_4"], TOLD["table_3_5"]
CONDITIONS = ("nominal", "textured", "control")
GLYPHS = "⠁⠀⠉⠈"  # of rows 1 to 4 of table 3.4; that of 1 and 4 is a guess
STRINGS = [one + other for one in GLYPHS for other in GLYPHS]


def half_up(value, digits=1):
    return f"{np.floor(value * 10**digits + 0.5 + 1e-9) / 10**digits:.{digits}f}"


def printed(values, digits=1):
    return ["" if value is None else f"{value:.{digits}f}" for value in values]


def series(mean, sd, n):
    """Durations with that mean and standard deviation."""
    off = sd * np.sqrt((n - 1) / n)
    return [mean + (off if k % 2 else -off) for k in range(n)]


@pytest.fixture(scope="module")
def chapter_3(tmp_path_factory):
    """A trial for each that table 3.1 counts; of the wrong ones one character is wrong."""
    rows = []
    for condition in CONDITIONS:
        numbers, rights = READ["n_trials"][condition], READ["correct_strings"][condition]
        timed = READ["duration_mean_sd_s"][condition]
        for person, n, right, times in zip(READ["subjects"], numbers, rights, timed, strict=True):
            for k in range(n):
                shown = STRINGS[k % 16]
                answered = shown if k < right else "?" + shown[1]
                row = {"participant": person, "condition": condition, "presented": shown}
                rows.append(row | {"answered": answered, "duration_s": series(*times, n)[k]})
    return analysed(rows, tmp_path_factory.mktemp("3")).tables


@pytest.fixture(scope="module")
def table_3_4(tmp_path_factory):
    rows = [
        {"participant": "all", "presented": shown, "answered": answered}
        for shown, counts in zip(GLYPHS, CHARACTERS["counts"], strict=True)
        for answered, n in zip(GLYPHS, counts, strict=True)
        for _ in range(n)
    ]
    return analysed(rows, tmp_path_factory.mktemp("34")).tables


@pytest.mark.parametrize("condition", CONDITIONS)
def test_table_3_1(condition, chapter_3):
    table = chapter_3["legibility"]
    own = table[table["condition"] == condition].set_index("participant")
    own = own.reindex([name for name in READ["subjects"] if name in own.index])
    assert own["trials"].to_list() == [n for n in READ["n_trials"][condition] if n]
    told = [value for value in READ["legibility_pct"][condition] if value is not None]
    assert [half_up(100 * value) for value in own["legibility"]] == printed(told)
    means, sds = zip(*filter(None, READ["duration_mean_sd_s"][condition]), strict=True)
    assert [half_up(value) for value in own["duration_mean_s"]] == printed(means)
    assert [half_up(value) for value in own["duration_sd_s"]] == printed(sds)
    row, average = row_of(chapter_3["averages"], condition=condition), READ["average_row"]
    assert row["trials"] == average["n"][condition]
    assert half_up(100 * row["legibility"]) == f"{average['legibility'][condition]:.1f}"
    assert half_up(row["duration_mean_s"]) == f"{average['duration'][condition]:.1f}"


def test_tables_3_2_and_3_4(table_3_4):
    characters = table_3_4["characters"].set_index("level")
    pooled = 100 * characters["correct"] / characters["presented"]
    told = TOLD["table_3_2"]["pooled_from_3_4_pct"]
    assert sorted(half_up(value) for value in pooled) == printed(told)
    assert characters.loc[list(GLYPHS), "presented"].to_list() == CHARACTERS["row_sums"]
    counts = table_3_4["confusion_characters"]
    names = ["a", "blank", "c", "dot 4"]
    assert counts.loc[names, names].to_numpy().tolist() == CHARACTERS["counts"]
    (row,) = table_3_4["information"].to_dict("records")
    assert row["accuracy"] == pytest.approx(CHARACTERS["derived"]["accuracy"], abs=1e-12)
    assert row["kappa"] == pytest.approx(0.8666858, abs=5e-8)
    assert half_up(row["transmitted_bits"], 5) == "1.42014"


def test_errors_and_dots_of_table_3_4(table_3_4):
    errors = table_3_4["errors"].set_index(["added", "removed", "moved"])["count"]
    assert errors.to_dict() == {(1, 0, 0): 60, (0, 0, 1): 42, (0, 1, 0): 33, (0, 2, 0): 1}
    dots = table_3_4["dots"].set_index("level")
    shares = dots["correct"] / dots["presented"]
    assert shares[1] < min(shares[0], shares[2])  # "characters having one dot were harder to read"


def test_tables_3_3_and_3_5(tmp_path):
    rows = [
        {"participant": "all", "presented": shown, "answered": answered}
        for shown, row in zip(STRINGS, PAIRS["rows"], strict=True)
        for answered, n in ((shown, row["diagonal"]), ("??", row["row_sum"] - row["diagonal"]))
        for _ in range(n)
    ]
    tables = analysed(rows, tmp_path).tables
    strings = tables["strings"].set_index("level")
    pooled = 100 * strings["correct"] / strings["presented"]
    told = TOLD["table_3_3"]["pooled_pct_by_pair"].values()
    assert [half_up(pooled[shown]) for shown in STRINGS] == printed(told)
    counts = tables["confusion_pairs"]
    assert counts.to_numpy().sum() == PAIRS["checks"]["total"]
    right = sum(counts.loc[name, name] for name in counts.index if name in counts)
    assert right == PAIRS["checks"]["trace"]


def test_table_3_3_averages_within_people_first(tmp_path):
    """AB's 3 of 4 nominal and 4 of 5 textured trials weigh as one person's, whatever each reads."""
    rows = []
    for person, condition, right, n in (("AB", "nominal", 3, 4), ("AB", "textured", 4, 5),
                                        ("CN", "textured", 10, 10)):  # fmt: skip
        rows += [
            {"participant": person, "condition": condition, "presented": "a",
             "answered": "a" if k < right else "c"} for k in range(n)
        ]  # fmt: skip
    (row,) = analysed(rows, tmp_path).tables["strings"].to_dict("records")
    assert row["legibility"] == pytest.approx(((3 / 4 + 4 / 5) / 2 + 1) / 2)


@pytest.mark.parametrize(("t", "df", "p"), T_TESTS)
def test_every_published_t(t, df, p):
    gaps = np.linspace(-1, 1, df + 1)
    gaps = gaps / gaps.std(ddof=1) + t / np.sqrt(df + 1)
    test = stats.paired(gaps)
    assert (float(test.t), float(test.df)) == (pytest.approx(t), df)
    assert half_up(test.p, 3) == f"{p:.3f}"


@pytest.mark.parametrize(("f", "df1", "df2", "p"), F_TESTS)
def test_every_published_f(f, df1, df2, p, rng):
    residuals = rng.normal(size=(df2 // df1 + 1, df1))
    residuals -= residuals.mean(axis=0)
    means = rng.normal(size=df1)
    means *= np.sqrt(f / stats.effect_within(residuals + means).F)
    test = stats.effect_within(residuals + means)
    assert float(test.F) == pytest.approx(f)
    assert (test.df1_uncorrected, test.df2_uncorrected) == (df1, df2)
    assert half_up(test.p_uncorrected, 3) == f"{p:.3f}"
    assert test.p >= test.p_uncorrected or p > 0.1


def test_scores_with_the_means_and_t_of_chapter_4(tmp_path):
    """Six people with the printed means, and the printed t of each two levels."""
    told = TOLD["chapter_4"]
    means, n = told["mean_legibility_pct"], 6

    def variance(first, second):
        t = told["t_tests_df5"][f"{first}_vs_{second}"]["t"]
        return n * ((means[first] - means[second]) / t) ** 2

    to_25, to_100 = variance("T0", "T25"), variance("T0", "T100")
    both = (to_25 + to_100 - variance("T25", "T100")) / 2
    root = np.linalg.cholesky([[to_25, both], [both, to_100]])
    apart = np.linalg.qr(np.column_stack([np.ones(n), np.arange(n), np.arange(n) ** 2]))[0][:, 1:]
    of_25, of_100 = root @ apart.T * np.sqrt(n - 1)
    levels = {"T0": 0 * of_25, "T25": of_25, "T100": of_100}
    rows = [
        {"participant": f"S{k}", "texture": name, "score": float(means[name] + 9 * k - 22.5 + off)}
        for name, apart in levels.items()
        for k, off in enumerate(apart)
    ]
    result = scored(rows, tmp_path).result
    assert [round(mean, 6) for mean in result.means["mean"]] == [50, 56, 64]
    for first, second in combinations(levels, 2):
        row = row_of(result.pairs, first=first, second=second)
        test = told["t_tests_df5"][f"{first}_vs_{second}"]
        assert (f"{row['t']:.3f}", half_up(row["p"], 3)) == (f"{test['t']:.3f}", f"{test['p']:.3f}")
    (effect,) = result.effects.to_dict("records")
    assert half_up(effect["F"], 2) == "10.66"  # from rounded means; 10.849 is printed
    assert effect["p"] > effect["p_uncorrected"]


def named(counts, folder, people=9, **columns):
    """Trials of names: counts of answers by what was presented, dealt to some people."""
    rows = []
    for presented, answers in counts.items():
        for answered, n in zip(counts, answers, strict=True):
            rows += [{"presented": presented, "answered": answered} | columns for _ in range(n)]
    rows = [
        {"participant": f"A{n % people}", "question": "name"} | row for n, row in enumerate(rows)
    ]
    return analysed(rows, folder).tables


@pytest.mark.parametrize(
    ("counts", "shares"), [(TABLE_6_3, PRINTED_6_3), (TABLE_6_4, PRINTED_6_4)], ids=["6.3", "6.4"]
)
def test_tables_6_3_and_6_4(counts, shares, tmp_path):
    table = named(counts, tmp_path)["answers_names"]
    for presented, told in shares.items():
        assert [half_up(100 * value) for value in table.loc[presented, list(counts)]] == printed(
            told
        )


def test_table_6_2(tmp_path):
    rows = []
    for shape, counts in TABLE_6_2.items():
        for cell, right in enumerate(counts):
            for k in range(36):
                answered = shape if k < right else "none"
                row = {"participant": f"A{k % 9}", "shape": shape, "size": SIZES[cell // 3]}
                row |= {"method": METHODS[cell % 3], "question": "name"}
                rows.append(row | {"presented": shape, "answered": answered})
    factors = ["shape", "size", "method"]
    analysis = analysed(rows, tmp_path, factors=factors)
    table = analysis.tables["names"]
    for shape, counts in TABLE_6_2.items():
        for cell, right in enumerate(counts):
            levels = {"shape": shape, "size": SIZES[cell // 3], "method": METHODS[cell % 3]}
            row = row_of(table, **levels)
            assert (row["right"], row["trials"]) == (right, 36)
            assert row["share"] == pytest.approx(right / 36)
    for size, told in TOTALS_6_2.items():
        for method, percent in zip((*METHODS, "all"), told, strict=True):
            row = row_of(table, shape="all", size=size, method=method)
            assert abs(100 * row["share"] - percent) <= 0.55  # some are rounded twice
    assert len(analysis.result.effects) == 7  # three factors, each two, and all three


def test_figure_3_12(tmp_path):
    """2.0 mm was chosen most often of the six widths, each pair of which was compared."""
    widths = (0.5, 1.0, 1.5, 2.0, 2.5, 3.0)
    rows = []
    for person in ("CN", "RB", "ML"):
        for one in widths:
            for other in widths:
                if one == other:
                    continue
                nearer = min(one, other, key=lambda width: abs(width - 1.9))
                row = {"participant": person, "question": "which", "parameter": "dot_width_mm"}
                rows.append(row | {"presented": f"{one:g} {other:g}", "answered": f"{nearer:g}"})
    analysis = analysed(rows, tmp_path)
    table = analysis.tables["choices"].set_index("value")
    assert table["share"].idxmax() == 2.0
    assert table["presented"].to_list() == [30] * 6
    assert analysis.result.means["mean"].iloc[0] == pytest.approx(1.9, abs=0.1)


def test_figures_6_7_and_3_14(tmp_path):
    rows = []
    for person in range(9):
        for step in range(1, 11):
            for k in range(10):
                row = {
                    "participant": f"B{person}",
                    "question": "which",
                    "response_s": 7 - 0.4 * step,
                }
                row |= {"outcome": "right" if k < 6 + step or k == person else "wrong"}
                rows.append(row | {"presented": f"1 {1 + step / 2:g}", "answered": "1"})
    table = analysed(rows, tmp_path, measure="right").tables["levels"].set_index("level")
    assert table.index.to_list() == [step / 2 for step in range(1, 11)]
    assert table.loc[5.0, "taken_s"] == pytest.approx(3.0)
    assert table.loc[0.5, "share_sd"] > 0 == table.loc[5.0, "share_sd"]


def test_reading_patterns_are_counted_and_drawn_as_figure_3_15(tmp_path):
    seen = {"AB": ["one pass", "one pass", "re-scan"], "CD": ["two passes", "one pass", "in part"]}
    rows = [
        {"participant": person, "presented": "ac", "answered": "ac", "pattern": pattern}
        | {"speed_right_mm_s": 60.0}
        for person, patterns in seen.items()
        for pattern in patterns
    ]
    analysis = analysed(rows, tmp_path)
    table = analysis.tables["patterns"].set_index("participant")
    assert table.loc["AB", ["one pass", "re-scan", "two passes"]].to_list() == [2, 1, 0]
    assert table.loc["CD", "speed_right_mm_s"] == 60
    analysis.write(tmp_path / "report")
    drawn = (tmp_path / "report/figures/patterns.svg").read_text(encoding="utf-8")
    assert all(f"<!-- {text} -->" in drawn for text in ("re-scan", "AB, all", "strings"))


def test_moving_average_of_figure_3_14(tmp_path):
    rows = [
        {"participant": "AB", "presented": "ac", "answered": "ac" if k < 40 else "aa"}
        for k in range(80)
    ]
    tables = analysed(rows, tmp_path).tables
    assert tables["over_time"]["average"].iloc[[8, 9, 44, 79]].fillna(-1).to_list() == [
        -1,
        1,
        0.5,
        0,
    ]
    (row,) = tables["fatigue"].to_dict("records")
    assert (row["first_half"], row["second_half"]) == (1, 0)
