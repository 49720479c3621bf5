"""The form of scene files as a JSON Schema, by which editors check and complete what is written."""

from __future__ import annotations

import inspect
import json
import re
from typing import Any, get_args, get_type_hints

import msgspec

from vbraille.scene.reading import SceneFile
from vbraille.toml import Table

_DIALECT = "https://json-schema.org/draft/2020-12/schema"
_SECTION = re.compile(r"^Parameters\n-+\n(.*?)(?=^\S[^\n]*\n-{3,}|\Z)", re.MULTILINE | re.DOTALL)
_NAMES = re.compile(r"^(\w+(?:, \w+)*)\n((?:^ +.*\n?|^\n)+)", re.MULTILINE)


def scene_schema() -> dict[str, Any]:
    """JSON Schema of scene files, made from the values: keys, types, limits, defaults, docstrings.

    What cannot go together is not in it; the values check that.
    """
    (made,), tables = msgspec.json.schema_components([SceneFile])
    for table in tables_of(SceneFile):
        schema, texts = tables[table.__name__], told(table)
        schema["description"] = summary(table)
        for name, field in schema["properties"].items():
            if name in texts:  # the kind of a pattern has none
                field["description"] = texts[name]
    return {
        "$schema": _DIALECT,
        "title": "Scene of vbraille",
        "description": "A tactile picture, or a bank of textures for others, as a TOML file.",
        **made,
        "$defs": tables,
    }


def schema_text() -> str:
    """Text of the schema as it is published."""
    return json.dumps(scene_schema(), ensure_ascii=False, indent=1) + "\n"


def tables_of(kind: type[Table]) -> list[type[Table]]:
    """Kinds of tables that a table may have in it, at any depth, itself first."""
    found: list[type[Table]] = []
    left: list[Any] = [kind]
    while left:
        hint = left.pop()
        inner = get_args(hint)
        if isinstance(hint, type) and issubclass(hint, Table) and hint not in found:
            found.append(hint)
            inner = tuple(get_type_hints(hint).values())
        left += reversed(inner)
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


def _plain(text: str) -> str:
    """Text of a docstring without its marks of code."""
    text = text.replace("``", "").replace("`", "")
    text = text.replace(". None for", ". Left out for").replace("None for", "left out for")
    return text.replace("None if", "left out if")
