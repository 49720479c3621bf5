"""The recipes of docs/analysis.md, on files that other programs wrote, against our own table."""

import re
from pathlib import Path

import pandas as pd
import pytest

from vbraille.analysis.input.parsing import parse
from vbraille.analysis.input.sheets import read_csv

SAMPLES = Path(__file__).parent / "samples"
PAGE = Path(__file__).parents[3] / "docs/analysis.md"
RECIPES = re.compile(r"^```python\n(import pandas.*?)^pd\.concat", re.DOTALL | re.MULTILINE)
COLUMNS = ["participant", "trial", "condition", "presented", "answered", "duration_s"]


@pytest.mark.parametrize(
    ("program", "trials"), [("psychopy", 15), ("opensesame", 15), ("jspsych", 8)]
)
def test_what_a_recipe_makes_is_our_own_table(program, trials, tmp_path):
    (block,) = RECIPES.findall(PAGE.read_text(encoding="utf-8"))
    recipes = {}
    exec(block, recipes)  # as a reader of the page runs it
    made = pd.concat(map(recipes[f"of_{program}"], sorted(SAMPLES.glob(f"{program}-letters-*"))))
    made.to_csv(tmp_path / "trials.csv", index=False)
    theirs = parse([read_csv(tmp_path / "trials.csv")]).trials
    assert len(theirs) == trials
    own = parse([read_csv(SAMPLES / "trials.csv")]).trials
    own = own[own["participant"].isin(made["participant"])].reset_index(drop=True)
    pd.testing.assert_frame_equal(theirs[COLUMNS], own[COLUMNS], check_categorical=False)
