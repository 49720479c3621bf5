"""The published schema is the one that the values make, and scenes are right by it."""

import tomllib
from pathlib import Path

import pytest

from tests.scene.test_reading import REFUSED
from vbraille.scene.reading import SceneFile
from vbraille.scene.schema import scene_schema, schema_text, summary, tables_of, told
from vbraille.scene.stock import stock_text

ROOT = Path(__file__).parents[2]
PUBLISHED = ROOT / "docs" / "scene.schema.json"
SCENES = sorted((ROOT / "texts" / "scenes").glob("**/*.scene"))
# Faults that only the values themselves see: ranges, what cannot go together, and names.
FORM = (
    "a misspelt kind",
    "no kind",
    "a misspelt key",
    "a place of three numbers",
    "a texture that is none",
)


def test_the_published_schema_is_that_of_the_values():
    assert PUBLISHED.read_text("utf-8") == schema_text(), (
        "docs/scene.schema.json is old; write it anew: vbraille scene schema > that file"
    )


def test_every_key_of_every_table_has_a_sentence():
    tables = tables_of(SceneFile)
    assert len(tables) > 25
    for table in tables:
        missing = set(table.__struct_fields__) - set(told(table))
        assert not missing, (table, missing)
        assert summary(table).endswith(".")


def test_no_table_may_have_other_keys():
    tables = scene_schema()["$defs"].values()
    assert all(table["additionalProperties"] is False for table in tables)


@pytest.fixture(scope="module")
def validator():
    jsonschema = pytest.importorskip("jsonschema", reason="needs jsonschema, of the test extra")
    jsonschema.Draft202012Validator.check_schema(scene_schema())
    return jsonschema.Draft202012Validator(scene_schema())


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_sample_scenes_are_right_by_an_independent_validator(validator, path):
    validator.validate(tomllib.loads(path.read_text("utf-8")))


def test_the_bank_is_right_by_an_independent_validator(validator):
    validator.validate(tomllib.loads(stock_text()))


@pytest.mark.parametrize("case", FORM)
def test_faults_of_form_are_found_by_an_independent_validator(validator, case):
    text, _ = REFUSED[case]
    assert list(validator.iter_errors(tomllib.loads(text)))
