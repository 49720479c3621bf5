"""The form of scene files as a JSON Schema, by which editors check and complete what is written."""

from __future__ import annotations

import inspect
import json
import re
from typing import Any

import msgspec

from vbraille.scene.reading import SceneFile
from vbraille.toml import Table

_DIALECT = "https://json-schema.org/draft/2020-12/schema"
_SECTION = re.compile(r"^Parameters\n-+\n(.*?)(?=^\S[^\n]*\n-{3,}|\Z)", re.MULTILINE | re.DOTALL)
_NAMES = re.compile(r"^(\w+(?:, \w+)*)\n((?:^ +.*\n?|^\n)+)", re.MULTILINE)


def scene_schema() -> dict[str, Any]:
    """JSON Schema of scene files, made from the values: their keys, types, defaults and docstrings.

    What cannot go together is not in it; the values check that.
    """
    (made,), tables = msgspec.json.schema_components([SceneFile])
    for table in tables_of(SceneFile):
        _describe(tables[table.__name__], table)
    return {
        "$schema": _DIALECT,
        "title": "Scene of vbraille",
        "description": "A tactile picture, or a bank of textures for others, as a TOML file.",
        **made,
        "$defs": {name: _without_null(table) for name, table in tables.items()},
    }


def schema_text() -> str:
    """Text of the schema as it is published."""
    return json.dumps(scene_schema(), ensure_ascii=False, indent=1) + "\n"


def tables_of(kind: type[Table]) -> list[type[Table]]:
    """Kinds of tables that a table may have in it, at any depth, itself first."""
    found: list[type[Table]] = []
    left: list[Any] = [msgspec.inspect.type_info(kind)]
    while left:
        one = left.pop()
        if isinstance(one, msgspec.inspect.StructType):
            if one.cls in found or not issubclass(one.cls, Table):
                continue
            found.append(one.cls)
            left += [field.type for field in reversed(one.fields)]
        elif isinstance(one, msgspec.inspect.UnionType):
            left += reversed(one.types)
        elif isinstance(one, msgspec.inspect.VarTupleType):
            left.append(one.item_type)
        elif isinstance(one, msgspec.inspect.DictType):
            left.append(one.value_type)
    return found


def told(table: type[Table]) -> dict[str, str]:
    """Tell what the docstrings of a table, and of those that it is made from, say of each field."""
    found: dict[str, str] = {}
    for kind in reversed(table.__mro__):
        section = _SECTION.search(inspect.cleandoc(kind.__doc__ or "") + "\n")
        for names, text in _NAMES.findall(section[1] if section else ""):
            said = _plain(" ".join(text.split()))
            found |= dict.fromkeys(names.split(", "), said)
    return found


def summary(table: type[Table]) -> str:
    """Tell what the docstring of a table says before its fields."""
    return _plain(
        " ".join(inspect.cleandoc(table.__doc__ or "").partition("\n\nParameters")[0].split())
    )


def _describe(schema: dict[str, Any], table: type[Table]) -> None:
    """Put sentences for people into the schema of a table."""
    schema["description"] = summary(table)
    texts = told(table)
    for name, field in schema["properties"].items():
        if name in texts:
            field["description"] = texts[name]


def _plain(text: str) -> str:
    """Text of a docstring without its marks of code."""
    text = text.replace("``", "").replace("`", "")
    text = text.replace(". None for", ". Left out for").replace("None for", "left out for")
    return text.replace("None if", "left out if")


def _without_null(schema: Any) -> Any:
    """Schema without null, which TOML does not have: what may be null is left out there."""
    if isinstance(schema, list):
        return [_without_null(one) for one in schema]
    if not isinstance(schema, dict):
        return schema
    if schema.get("default", 0) is None:
        schema = {key: value for key, value in schema.items() if key != "default"}
    choices = schema.get("anyOf", [])
    kept = [one for one in choices if one != {"type": "null"}]
    if len(kept) == 1 and len(choices) == 2:
        schema = {**{k: v for k, v in schema.items() if k != "anyOf"}, **kept[0]}
    return {key: _without_null(value) for key, value in schema.items()}
