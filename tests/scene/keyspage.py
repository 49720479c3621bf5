"""The list of all keys in docs/scenes.md, made from the values' own docstrings and defaults.

``python -m tests.scene.keyspage`` writes it anew.
"""

import textwrap
from pathlib import Path

from vbraille.scene.patterns import Pattern
from vbraille.scene.reading import SceneFile
from vbraille.scene.schema import scene_schema, summary, tables_of, told

PAGE = Path(__file__).parents[2] / "docs" / "scenes.md"
BEGIN, END = "<!-- keys: made by tests/scene/keyspage.py -->\n", "<!-- end of keys -->\n"
COMMON = tuple(Pattern.__struct_fields__)
WORDS = {"number": "number", "integer": "whole number", "boolean": "true or false"}


def keys_text():
    """All tables, each with its keys, what they take, what is usual, and what they mean."""
    schemas = scene_schema()["$defs"]
    kinds = {table.__name__: _name(table) for table in tables_of(SceneFile)}
    lines = ["### Keys that every pattern has", ""]
    lines += _keys(schemas["Uniform"], told(Pattern), COMMON, kinds)
    for table in tables_of(SceneFile):
        schema, texts = schemas[table.__name__], told(table)
        own = [key for key in schema["properties"] if key not in (*COMMON, "kind")]
        if not issubclass(table, Pattern):
            own = [key for key in schema["properties"] if key != "kind"]
        lines += ["", f"### {kinds[table.__name__]}", ""]
        lines += [_filled(summary(table)), "", *_keys(schema, texts, own, kinds)]
    return "\n".join(lines) + "\n"


def _name(table):
    """How the page calls a table."""
    tag = table.__struct_config__.tag
    if tag is not None:
        return f'kind = "{tag}"'
    named = {"SceneFile": "The file as a whole", "Canvas": "[canvas]", "DotStyle": "table dot"}
    named |= {
        "ClassLook": "table [classes.NAME]",
        "VertexMarkers": "table markers",
        "MovingCue": "table cue",
    }
    named |= {"Dotting": "table dots, of shapes", "TurnPeak": "table distortion, of axial gratings"}
    return named.get(table.__name__, f"table {table.__name__.lower()}")


def _keys(schema, texts, keys, kinds):
    """A line for each key, or for several that the same sentence tells of."""
    said = {}
    for key in keys:
        takes = f"`{key}`, {_takes(schema['properties'][key], kinds)}{_usual(schema, key)}"
        said.setdefault(texts[key], []).append(takes)
    return [_filled(f"- {'; '.join(takes)}: {text}") for text, takes in said.items()]


def _filled(text):
    """A paragraph, or an item of a list, in lines of 118 characters."""
    indent = "  " if text.startswith("- ") else ""
    return textwrap.fill(
        text, 118, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )


def _takes(field, kinds):
    """What a key takes, in words."""
    if "enum" in field:
        words = ", ".join(f'"{value}"' for value in field["enum"])
        return words if len(field["enum"]) == 1 else f"one of {words}"
    if "$ref" in field:
        return kinds[field["$ref"].rpartition("/")[2]]
    if "anyOf" in field:
        every = [_takes(one, kinds) for one in field["anyOf"] if one != {"type": "null"}]
        return "a pattern" if len(every) > 3 else " or ".join(every)
    kind = field.get("type")
    if kind == "string":
        return "text"
    if kind == "object":
        of = field.get("additionalProperties", {})
        return (
            f"a table by name, of {kinds[of['$ref'].rpartition('/')[2]]}"
            if "$ref" in of
            else f"a table of {'signals' if 'Switch' in str(of) else 'patterns'} by name"
        )
    if kind == "array" and "prefixItems" in field:
        return "two numbers" if len(field["prefixItems"]) == 2 else "numbers"
    if kind == "array":
        what = _takes(field["items"], kinds)
        return {"text": "texts", "two numbers": "places", "a pattern": "patterns"}.get(
            what, "lists of places" if what == "places" else f"list of {what}s"
        )
    return WORDS[kind]


def _usual(schema, key):
    if key in schema.get("required", ()):
        return ", needed"
    usual = schema["properties"][key].get("default")
    if usual in (None, "", (), [], {}) or isinstance(usual, dict):
        return ""
    said = {True: "true", False: "false"}.get(usual) if isinstance(usual, bool) else None
    if isinstance(usual, float | int) and said is None:
        said = f"{usual:g}"
    if isinstance(usual, tuple | list):
        said = "[" + ", ".join(f"{one:g}" for one in usual) + "]"
    return f", usually {said or f'{chr(34)}{usual}{chr(34)}'}"


if __name__ == "__main__":
    before, _, rest = PAGE.read_text("utf-8").partition(BEGIN)
    _, _, after = rest.partition(END)
    PAGE.write_text(f"{before}{BEGIN}\n{keys_text()}\n{END}{after}", encoding="utf-8")
