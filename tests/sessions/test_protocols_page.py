"""The page of protocols: each example is a protocol that is planned, and all keys are there."""

import re
import tomllib

import pytest
from msgspec import inspect

from tests.documents import DOCS
from tests.sessions.sittings import HEAD
from vbraille.sessions.planning.loading import FOLDER, OWN_FILE, parse_protocol
from vbraille.sessions.planning.plan import make_plan
from vbraille.sessions.planning.protocol import ProtocolFile

PAGE = (DOCS / "protocols.md").read_text(encoding="utf-8")
DESIGN = '[design]\nkind = "list"\nstrings = ["ac", "ca"]\n'


def examples():
    """Protocols of the page; those that are a part of a file with what they lack."""
    for text in re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL):
        given = tomllib.loads(text)
        head = "" if "name" in given else HEAD
        yield head + text + ("" if "design" in given else DESIGN)


@pytest.mark.parametrize("text", list(examples()))
def test_an_example_is_planned(text):
    beside = {path.name: path.read_bytes() for path in FOLDER.glob("*.scene")}
    protocol = parse_protocol({OWN_FILE: text.encode(), **beside}, "page.toml")
    assert make_plan(protocol, "P01", 1).trials


def tables(kind, found):
    """All tables that a type may have in it."""
    if isinstance(kind, inspect.StructType) and kind.cls not in found:
        found[kind.cls] = kind
        for field in kind.fields:
            tables(field.type, found)
    for inner in (getattr(kind, "item_type", None), *getattr(kind, "types", ())):
        if inner is not None:
            tables(inner, found)
    return found


def test_every_key_and_every_kind_is_on_the_page():
    for kind in tables(inspect.type_info(ProtocolFile), {}).values():
        for field in kind.fields:
            assert re.search(rf"\b{field.encode_name}\b", PAGE), (kind.cls, field.encode_name)
        if kind.tag_field:
            assert f'"{kind.tag}"' in PAGE
