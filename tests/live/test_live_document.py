"""The page of the live view's protocol against the code: clients are written from the one."""

import re
import typing
from pathlib import Path

import msgspec
import numpy as np
import pytest

from tests.live import headers
from tests.live.canned import canned_frame
from tests.live.pages import read_frame
from vbraille.engine.record import Flag
from vbraille.live import connection, messages, server
from vbraille.live.server import HEADERS

PAGE = (Path(__file__).parents[2] / "docs/live-view.md").read_text()
SECTIONS = dict(re.findall(r"^#{2,3} (.+?)\n(.*?)(?=^#{2,3} |\Z)", PAGE, re.M | re.S))
REQUESTS = typing.get_args(messages.AnyRequest)
ANSWERS = (messages.Welcome, messages.ViewState, messages.Refused)
PARTS = (
    messages.ArrayShown,
    messages.LineShown,
    messages.SceneShown,
    messages.BesideShown,
    messages.SignalShown,
    messages.CommandShown,
    messages.CardShown,
    messages.KnobShown,
    messages.PlayedEvent,
)
_PLAIN = {str: "text", int: "integer", float: "number", bool: "true or false"}
_NUMBERS = {"u1": "u8", "u2": "u16", "u4": "u32", "f4": "f32", "f8": "f64"}


def rows_of(section):
    """Cells of the table rows of a section, without heads and rules."""
    lines = [line for line in SECTIONS[section].splitlines() if line.startswith("|")]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    return [
        row
        for row, below in zip(rows, [*rows, [""]][1:], strict=True)
        if not (row[0].startswith("---") or below[0].startswith("---"))
    ]


def spelled_type(kind):
    """Words of the page for a type of JSON."""
    if kind in _PLAIN:
        return _PLAIN[kind]
    arguments = typing.get_args(kind)
    if type(None) in arguments:
        return f"{spelled_type(arguments[0])} or null"
    if typing.get_origin(kind) is list:
        return f"list of {spelled_type(arguments[0])}"
    if typing.get_origin(kind) is tuple:
        return f"[{', '.join(map(spelled_type, arguments))}]"
    if typing.get_origin(kind) is dict:
        return f"object of {spelled_type(arguments[1])}"
    return f"`{kind.__name__}`"


def rows_wanted(kind):
    """Name, type and value that may be left out of each field of a message."""
    hints = typing.get_type_hints(kind)
    for field in msgspec.structs.fields(kind):
        usual = ""
        if field.default is not msgspec.NODEFAULT:
            usual = msgspec.json.encode(field.default).decode()
        elif field.default_factory is not msgspec.NODEFAULT:
            usual = msgspec.json.encode(field.default_factory()).decode()
        yield [f"`{field.name}`", spelled_type(hints[field.name]), usual]


@pytest.mark.parametrize("kind", [*REQUESTS, *ANSWERS, *PARTS], ids=lambda kind: kind.__name__)
def test_the_table_of_each_message(kind):
    table = [row[:3] for row in rows_of(kind.__name__)]
    assert table == list(rows_wanted(kind))
    assert all(len(row) == 4 for row in rows_of(kind.__name__))


def test_there_is_a_section_for_each_message_and_no_other():
    named = {title for title in SECTIONS if re.fullmatch(r"(?:[A-Z][a-z]+)+", title)}
    others = {
        "Addresses", "Rights", "Frames", "Maps", "Limits", "Blind", "Playback", "Safety",
        "Requests", "Answers",
    }  # fmt: skip
    assert named - others == {kind.__name__ for kind in (*REQUESTS, *ANSWERS, *PARTS)}


@pytest.mark.parametrize("kind", [*REQUESTS, *ANSWERS], ids=lambda kind: kind.__name__)
def test_the_example_of_each_message(kind):
    (example,) = re.findall(r"```json\n(.+?)\n```", SECTIONS[kind.__name__], re.S)
    field, tag = kind.__struct_config__.tag_field, kind.__struct_config__.tag
    assert f'"{field}": "{tag}"' in example
    assert type(msgspec.json.decode(example, type=kind)) is kind


def table_of(section, dtype):
    """Rows of a header as the page has them, against those of a dtype."""
    wanted = []
    for name in dtype.names:
        kind, offset = dtype.fields[name][:2]
        wanted.append([str(offset), _NUMBERS[kind.str[1:]], f"`{name}`"])
    assert [row[:3] for row in rows_of(section) if len(row) == 4] == wanted
    assert f"{dtype.itemsize} bytes" in SECTIONS[section]


def test_headers():
    table_of("Frames", headers.FRAME)
    table_of("Maps", headers.MAP)
    assert np.dtype(headers.FRAME).isalignedstruct is False


def test_flags():
    told = [row[:2] for row in rows_of("Frames") if len(row) == 3]
    assert told == [[str(flag.value), flag.name.lower()] for flag in Flag]


def test_the_numbers_of_the_first_frame_of_the_example():
    text = SECTIONS["Frames"]
    sizes = re.search(r"(\d+) × (\d+) actuators and (\d+) samples takes (\d+) bytes", text)
    frame = canned_frame(0)
    read = read_frame(frame)
    assert [int(n) for n in sizes.groups()] == [
        *read.deflections.shape, len(read.samples), len(frame),
    ]  # fmt: skip


def test_limits():
    told = {row[0]: row[1] for row in rows_of("Limits")}
    assert told == {
        "pages at a time": f"{server.MOST_PAGES}",
        "connections at a time": f"{server.MOST_CONNECTIONS}",
        "bytes of a request": f"{messages.MOST_BYTES}",
        "samples of a frame": f"{messages.MOST_SAMPLES}",
        "frames asked for ahead that are looked at": f"{connection.MOST_QUEUED}",
        "seconds until hello": f"{connection._HELLO_S:g}",
        "seconds until a frame comes that is not new": f"{connection._MOST_WAIT_S:g}",
        "seconds from one ping to the next, and until it must be answered": f"{server._PING_S:g}",
    }


def test_headers_of_safety():
    for name, value in HEADERS:
        assert f"{name}: {value}" in " ".join(SECTIONS["Safety"].split())


def test_version_and_path():
    assert PAGE.startswith(f"# The live view, version {messages.VERSION}\n")
    assert f"`{server.SOCKET_PATH}`" in PAGE
