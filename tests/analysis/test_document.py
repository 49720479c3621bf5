"""The code of docs/analysis.md, as a reader of the page runs it."""

import re
from pathlib import Path

import pandas as pd
import pytest

from tests.analysis.making import analysed, row_of, trials_of
from vbraille.analysis import analyse

SAMPLES = Path(__file__).parent / "samples"
PAGE = Path(__file__).parents[2] / "docs/analysis.md"
SHARES, RECIPES = re.findall(
    r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL
)
COLUMNS = ["participant", "trial", "condition", "presented", "answered", "duration_s", "right"]


def recipes():
    found = {}
    exec(RECIPES.partition("pd.concat")[0], found)
    return found


@pytest.mark.parametrize(
    ("program", "trials"), [("psychopy", 15), ("opensesame", 15), ("jspsych", 8)]
)
def test_what_a_recipe_makes_is_our_own_table(program, trials, tmp_path):
    files = sorted(SAMPLES.glob(f"{program}-letters-*"))
    made = pd.concat(map(recipes()[f"of_{program}"], files))
    made.to_csv(tmp_path / "trials.csv", index=False)
    theirs = analyse([tmp_path / "trials.csv"]).tables["trials"][COLUMNS]
    own = analyse([SAMPLES / "trials.csv"]).tables["trials"][COLUMNS]
    own = own[own["participant"].isin(made["participant"])].reset_index(drop=True)
    assert len(theirs) == trials
    pd.testing.assert_frame_equal(theirs, own, check_dtype=False, check_categorical=False)


def test_words_that_look_like_nothing_come_through_a_recipe(tmp_path):
    words = ["null", "nan", "none", "true", "inf", "1e5"]
    lines = ["string,texture,trials.thisN,key_done.rt,answer_box.text,participant,"]
    lines += [f"{word},0,{n},1.5,{word},001," for n, word in enumerate(words)]
    (tmp_path / "psy.csv").write_text("\n".join(lines), encoding="utf-8-sig")
    recipes()["of_psychopy"](tmp_path / "psy.csv").to_csv(tmp_path / "trials.csv", index=False)
    (row,) = analyse([tmp_path / "trials.csv"]).tables["legibility"].to_dict("records")
    assert (row["trials"], row["correct"]) == (6, 6)


def test_pandas_gives_the_primary_test(tmp_path, monkeypatch, capsys):
    shares = {"T0": [20, 22, 25, 18, 24, None], "T100": [17, 21, 22, 18, 19, 22]}
    analysis = analysed(trials_of(shares), tmp_path)
    analysis.write(tmp_path / "report")
    monkeypatch.chdir(tmp_path)
    exec(SHARES, {})
    row = row_of(analysis.result.pairs, first="T0", second="T100")
    said = capsys.readouterr().out
    numbers = [float(number) for number in re.findall(r"=(?:np\.\w+\()?(-?[\d.]+)", said)]
    assert numbers[:3] == pytest.approx([row["t"], row["p"], row["df"]])
    assert numbers[3:] == pytest.approx([row["low"], row["high"]])
