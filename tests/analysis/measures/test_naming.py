"""Names of pictures: the published counts of Lévesque 2009, 6.4, are found again."""

import csv
from decimal import ROUND_HALF_UP, Decimal
from itertools import product

import pytest
from scipy.stats import f as fisher
from scipy.stats import t as student

from vbraille.analysis import analyse
from vbraille.analysis.statistics.anova import anova

SHAPES = ["right-triangle", "inverted-triangle", "circle", "square", "diamond", "plus"]
METHODS = ["grating", "dots", "vibration"]
SIZES = ["2-cm", "3-cm"]
# Table 6.2: right of 36, by shape: 2 cm G D V, 3 cm G D V.
RIGHT = [
    (27, 33, 34, 29, 30, 31), (31, 23, 31, 30, 32, 28), (21, 35, 31, 17, 32, 32),
    (16, 28, 25, 31, 30, 34), (27, 21, 26, 25, 23, 32), (7, 23, 29, 19, 27, 35),
]  # fmt: skip
# Table 6.3: presented by answered, of 216.
ANSWERS = [
    (184, 6, 5, 5, 11, 5), (5, 175, 2, 4, 18, 12), (9, 7, 168, 14, 13, 5),
    (13, 8, 16, 164, 12, 3), (5, 12, 37, 4, 154, 4), (8, 17, 5, 14, 32, 140),
]  # fmt: skip
# Table 6.2 as printed, per cent: 2 cm G D V all, 3 cm G D V all, both G D V all.
PRINTED = [
    (75, 92, 94, 87, 81, 83, 86, 83, 78, 88, 90, 85),
    (86, 64, 86, 79, 83, 89, 78, 83, 85, 76, 82, 81),
    (58, 97, 86, 81, 47, 89, 89, 75, 53, 93, 88, 78),
    (44, 78, 69, 64, 86, 83, 94, 88, 65, 81, 82, 76),
    (75, 58, 72, 69, 69, 64, 89, 74, 72, 61, 81, 71),
    (19, 64, 81, 55, 53, 75, 97, 75, 36, 69, 89, 65),
    (60, 76, 82, 72, 70, 81, 89, 80, 65, 78, 85, 76),
]
ORIENTATIONS = ["at-0", "plus-45", "at-90", "minus-45"]
# Table 6.4: presented by answered, of 90.
COARSE = [(82, 6, 1, 1), (1, 77, 9, 3), (0, 6, 78, 6), (2, 4, 8, 76)]


def records(results, name):
    return results.table(name).to_dict("records")


def table(path, rows):
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    return path


def shapes_of_the_source(path):
    """Trials with the counts of tables 6.2 and 6.3; which of nine people gave which is made up."""
    rows = []
    for number, shape in enumerate(SHAPES):
        wrong = [name for name, times in zip(SHAPES, ANSWERS[number], strict=True)
                 for _ in range(times * (name != shape))]  # fmt: skip
        for (size, method), right in zip(product(SIZES, METHODS), RIGHT[number], strict=True):
            given = [shape] * right + [wrong.pop() for _ in range(36 - right)]
            rows += [
                {
                    "participant": f"A{at % 9 + 2}", "condition": method, "question": "name",
                    "method": method, "size": size, "shape": shape,
                    "presented": shape, "answered": answer,
                }
                for at, answer in enumerate(given)
            ]  # fmt: skip
        assert not wrong
    return table(path, rows)


def percent(share):
    """Per cent as the source prints it: it rounded tenths, which were rounded before."""
    tenths = Decimal(100 * share).quantize(Decimal("0.1"), ROUND_HALF_UP)
    return int(tenths.quantize(Decimal(1), ROUND_HALF_UP))


def test_table_6_2_is_found_again(tmp_path):
    path = shapes_of_the_source(tmp_path / "shapes.csv")
    results = analyse([path], factors=["size", "method", "shape"])
    cells = {row["cell"]: row for row in records(results, "names")}
    assert len(cells) == 84
    differing = []
    for shape, printed in zip([*SHAPES, "all"], PRINTED, strict=True):
        for (size, method), published in zip(
            product([*SIZES, "all"], [*METHODS, "all"]), printed, strict=True
        ):
            row = cells[f"{size}, {method}, {shape}"]
            if percent(row["share"]) != published:
                differing.append((size, method, shape, row["right"], row["trials"], published))
    assert not differing
    assert (cells["all, all, all"]["right"], cells["all, all, all"]["trials"]) == (985, 1296)
    for cell, published in (
        ("all, vibration, all", 85.2), ("all, dots, all", 78.0), ("all, grating, all", 64.8),
        ("3-cm, all, all", 79.8), ("2-cm, all, all", 72.2), ("3-cm, vibration, all", 88.9),
        ("2-cm, vibration, all", 81.5), ("3-cm, dots, all", 80.6),
    ):  # fmt: skip
        assert round(100 * cells[cell]["share"], 1) == published


def test_table_6_3_is_found_again(tmp_path):
    results = analyse([shapes_of_the_source(tmp_path / "shapes.csv")], factors=["method"])
    found = {(r["presented"], r["answered"]): r for r in records(results, "names_confusion")}
    for presented, counts in zip(SHAPES, ANSWERS, strict=True):
        assert tuple(found[presented, name]["trials"] for name in SHAPES) == counts
    assert round(100 * found["diamond", "circle"]["share"], 1) == 17.1
    everybody = records(results, "names_participants")[-1]
    assert (everybody["participant"], everybody["right"]) == ("all", 985)


def test_table_6_4_is_found_again(tmp_path):
    rows = [
        {"participant": f"C{at % 9 + 2}", "condition": "all", "question": "name",
         "presented": presented, "answered": answered}
        for presented, counts in zip(ORIENTATIONS, COARSE, strict=True)
        for at, answered in enumerate(
            [name for name, times in zip(ORIENTATIONS, counts, strict=True) for _ in range(times)]
        )
    ]  # fmt: skip
    results = analyse([table(tmp_path / "coarse.csv", rows)])
    found = {(r["presented"], r["answered"]): r for r in records(results, "names_confusion")}
    for presented, counts in zip(ORIENTATIONS, COARSE, strict=True):
        assert tuple(found[presented, name]["trials"] for name in ORIENTATIONS) == counts
        assert sum(found[presented, name]["share"] for name in ORIENTATIONS) == pytest.approx(1)
    printed = [round(100 * found[name, name]["share"], 1) for name in ORIENTATIONS]
    assert printed == [91.1, 85.6, 86.7, 84.4]


def test_several_names_are_told_one_by_one_and_together(tmp_path):
    """Table of 6.4.5: counts of the sighted group, 480 icons."""
    right = {"shape": 425, "orientation": 460, "frequency": 426, "all": 377}
    rows = []
    for at in range(480):
        parts = ["circle", "upright", "2-mm"]
        if at >= right["all"]:  # which are wrong together is made up
            late = at - right["all"]
            parts[0] = "square" if late < 480 - right["shape"] else parts[0]
            parts[1] = "level" if late < 480 - right["orientation"] else parts[1]
            parts[2] = "6-mm" if 480 - at <= 480 - right["frequency"] else parts[2]
        rows.append(
            {"participant": f"C{at % 10 + 1}", "condition": "all", "question": "name",
             "presented": "circle upright 2-mm", "answered": " ".join(parts),
             "response_s": "24.5", "ended_by": "exposure" if at < 56 else "answer"}
        )  # fmt: skip
    results = analyse([table(tmp_path / "icons.csv", rows)])
    everybody = [r for r in records(results, "names_participants") if r["participant"] == "all"]
    assert [row["of"] for row in everybody] == ["name 1", "name 2", "name 3", "all"]
    assert [row["right"] for row in everybody] == [425, 460, 426, 377]
    assert [round(100 * row["share"], 1) for row in everybody] == [88.5, 95.8, 88.8, 78.5]
    assert everybody[-1]["response_s"] == 24.5
    assert round(100 * everybody[-1]["over"], 1) == 11.7


def test_the_design_of_the_source_has_its_degrees_of_freedom(tmp_path):
    """Three-way analysis of nine people's own shares: those that the source prints."""
    shares = {}
    text = shapes_of_the_source(tmp_path / "shapes.csv").read_text()
    for row in csv.DictReader(text.splitlines()):
        cell = tuple(row[name] for name in ("participant", "method", "size", "shape"))
        shares.setdefault(cell, []).append(row["presented"] == row["answered"])
    factors = ("method", "size", "shape")
    found = anova(
        [cell[0] for cell in shares],
        {name: [cell[at] for cell in shares] for at, name in enumerate(factors, 1)},
        [sum(right) / len(right) for right in shares.values()],
    )
    assert {effect.name: (effect.df1, effect.df2) for effect in found.effects} == {
        "method": (2, 16), "size": (1, 8), "shape": (5, 40), "method × size": (2, 16),
        "method × shape": (10, 80), "size × shape": (5, 40), "method × size × shape": (10, 80),
    }  # fmt: skip
    method = next(effect for effect in found.effects if effect.name == "method")
    assert method.p == pytest.approx(fisher.sf(method.f, 2, 16))


# Section 5h of the source, as it prints F or t and p; those whose p it has wrong have ours.
@pytest.mark.parametrize(
    ("value", "df1", "df2", "p"),
    [
        (2.364, 10, 80, 0.017), (4.420, 5, 40, 0.003), (0.698, 2, 16, 0.512),
        (7.955, 2, 16, 0.004), (8.884, 1, 8, 0.018), (4.862, 5, 40, 0.001), (28.47, 1, 8, 0.001),
        (2.75, 10, 90, 0.005), (3.92, 2, 18, 0.039), (7.042, 2, 18, 0.006), (13.00, 2, 16, 0.0004),
        (2.489, None, 8, 0.038), (5.335, None, 8, 0.001), (1.167, None, 8, 0.277),
        (2.981, None, 8, 0.018), (3.279, None, 9, 0.010), (1.111, None, 9, 0.295),
        (1.495, None, 9, 0.169), (1.831, None, 14, 0.088), (0.870, None, 14, 0.399),
    ],
)  # fmt: skip
def test_p_of_the_source_follows_from_its_statistics(value, df1, df2, p):
    found = 2 * student.sf(value, df2) if df1 is None else fisher.sf(value, df1, df2)
    assert found == pytest.approx(p, abs=0.0006)
