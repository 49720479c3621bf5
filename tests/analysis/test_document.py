"""docs/tables.md says what every table has, in the tables' own words."""

import importlib
import pkgutil
from pathlib import Path

import pytest

import vbraille.analysis
from vbraille.analysis.results import Schema

DOCUMENT = Path("docs/tables.md").read_text(encoding="utf-8")


def schemas():
    """All there are, by name."""
    found = {}
    for module in pkgutil.walk_packages(vbraille.analysis.__path__, "vbraille.analysis."):
        for value in vars(importlib.import_module(module.name)).values():
            if isinstance(value, Schema):
                found[value.name] = value
    return found


SCHEMAS = schemas()


def test_no_table_is_told_of_that_is_not_there():
    told = [line.split("`")[1] for line in DOCUMENT.splitlines() if line.startswith("### `")]
    assert sorted(told) == sorted(SCHEMAS)


@pytest.mark.parametrize("name", SCHEMAS)
def test_a_table_and_its_columns(name):
    schema = SCHEMAS[name]
    part = DOCUMENT.split(f"### `{name}`: ")[1].split("\n### ")[0]
    title, about, table = part.split("\n\n")[:3]
    assert (title, " ".join(about.split())) == (schema.title, schema.about)
    rows = [f"| `{column.name}` | {column.meaning} |" for column in schema.columns]
    assert table.strip().splitlines()[2:] == rows
    assert (f"Then {schema.grows}." in " ".join(part.split())) == bool(schema.grows)
