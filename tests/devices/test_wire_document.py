"""The protocol's page against the code: firmware is written from the one, a host runs the other."""

import ast
import re
from pathlib import Path
from zlib import crc32

import numpy as np
import pytest
from cobs import cobs

from vbraille.devices import messages
from vbraille.devices.fields import (
    Choice,
    Fixed,
    Number,
    OptionalNumber,
    PerActuator,
    Text,
    fields_of,
)
from vbraille.devices.messages import FAULTY, MESSAGES, PLACED, RESTING, ErrorCode, Frame, State
from vbraille.devices.wire import (
    CRC_RESIDUE,
    MOST_FRAME_BYTES,
    Decoder,
    Layout,
    Levels,
    encode,
    line_bytes,
)

PAGE = (Path(__file__).parents[2] / "docs/wire-protocol.md").read_text()
SECTIONS = dict(re.findall(r"^#{2,3} (.+?)\n(.*?)(?=^#{2,3} |\Z)", PAGE, re.M | re.S))
EVERY_MESSAGE = pytest.mark.parametrize(
    ("code", "message"),
    [pytest.param(code, message, id=message.__name__) for code, message in MESSAGES.items()],
)
TYPES = {"B": "u8", "b": "i8", "H": "u16", "h": "i16", "I": "u32"}
SIZES = {"u8": 1, "i8": 1, "u16": 2, "i16": 2, "u32": 4}


def rows_of(section):
    """Cells of the table rows of a section, without heads and rules."""
    lines = [line for line in SECTIONS[section].splitlines() if line.startswith("|")]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    return [
        row
        for row, below in zip(rows, [*rows[1:], [""]], strict=True)
        if not (row[0].startswith("---") or below[0].startswith("---"))
    ]


def built(call):
    """Message of its Python spelling on the page; only literals, enumerations and hex."""

    def value(node):
        match node:
            case ast.Attribute(ast.Name(enum), name):
                return getattr(messages, enum)[name]
            case ast.Call(ast.Attribute(ast.Name("bytes"), "fromhex"), [ast.Constant(text)]):
                return bytes.fromhex(text)
        return ast.literal_eval(node)

    node = ast.parse(call, mode="eval").body
    assert isinstance(node, ast.Call)
    return getattr(messages, node.func.id)(**{k.arg: value(k.value) for k in node.keywords})


def example_of(message):
    """Message, body, CRC and line of a message's example."""
    pattern = r"```text\n(.+?)\nbody (.+?)\ncrc (.+?)\nline (.+?)\n```"
    (found,) = re.findall(pattern, SECTIONS[message.__name__.upper()], re.S)
    return (built(found[0]), *(bytes.fromhex(part) for part in found[1:]))


@EVERY_MESSAGE
def test_examples(code, message):
    example, body, crc, line = example_of(message)
    assert type(example) is message
    assert Layout(code, message).encode(example) == body
    assert Layout(code, message).decode(body) == example
    assert crc32(body).to_bytes(4, "little") == crc
    assert cobs.encode(body + crc) + b"\0" == line == encode(example)
    assert Decoder().feed(line) == [example]


def type_and_values(field):
    match field:
        case OptionalNumber():
            return TYPES[field.code], f"{field.low} … {field.high} {field.unit}, {field.none} none"
        case Number():
            return TYPES[field.code], f"{field.low} … {field.high} {field.unit}".strip()
        case Choice():
            choices = [f"{int(choice)} {choice.name.lower()}" for choice in field.of]
            return TYPES[field.code], ", ".join(choices)
        case Text():
            return "text", f"{field.fewest} … {field.most} bytes"
        case PerActuator():
            return "u8[rows·columns]", f"0 … {field.high}"
    return "u8[]", f"1 … {field.most} bytes"


@EVERY_MESSAGE
def test_byte_tables(code, message):
    at, wanted = 1, [["0", "u8", "`type`", f"0x{code:02x}"]]
    for name, field in fields_of(message):
        sort, values = type_and_values(field)
        wanted.append([str(at) if at else "", sort, f"`{name}`", values])
        at = at + SIZES[sort] if at and isinstance(field, Fixed) else 0
    table = [row[:4] for row in rows_of(message.__name__.upper()) if len(row) == 5]
    assert table == wanted


def test_there_is_a_section_for_each_message_and_no_other():
    capitals = {title for title in SECTIONS if title.isupper()}
    assert capitals == {message.__name__.upper() for message in MESSAGES.values()}
    assert (min(c for c in MESSAGES if c > 0x7F), max(c for c in MESSAGES if c < 0x80)) == (0x81, 3)


def test_error_codes():
    told = [row[0] for row in rows_of("ERROR") if len(row) == 2]
    assert told == [f"{code.value} {code.name.lower()}" for code in ErrorCode]
    assert messages.NOTICES == 128


def test_flags():
    flags = next(row for row in rows_of("STATE") if row[2] == "`flags`")
    assert flags[4] == "bit 0 placed, bit 1 resting, bit 2 faulty; the others 0"
    assert (PLACED, RESTING, FAULTY) == (1 << 0, 1 << 1, 1 << 2)


def test_crc_and_cobs():
    text = SECTIONS["Frames"]
    assert f"0x{crc32(b'123456789'):X}" in text
    assert f"0x{CRC_RESIDUE:X}" in text
    assert crc32(b"any" + crc32(b"any").to_bytes(4, "little")) == CRC_RESIDUE
    (plain, stuffed) = re.search(r"`([0-9a-f ]+)` becomes `([0-9a-f ]+)`", text).groups()
    assert cobs.encode(bytes.fromhex(plain)) == bytes.fromhex(stuffed)
    assert f"takes {MOST_FRAME_BYTES} bytes before the zero" in text


def test_levels():
    text = SECTIONS["Levels"]
    level, bits, packed = (
        re.search(rf"^    {name} +(.+)$", text, re.M)[1] for name in ("level ", "bits", "bytes")
    )
    levels = [int(word) for word in level.split()[:6]]
    assert [int(word, 2) for word in bits.split()[:6]] == levels
    assert int(bits.replace(" ", ""), 2).to_bytes(8, "big") == bytes.fromhex(packed)
    assert Levels(6, 1023).pack(np.array(levels)) == bytes.fromhex(packed)
    assert example_of(Frame)[0].packed == bytes.fromhex(packed)


def test_times():
    told = {
        row[0].strip("`"): int(row[1]) for row in rows_of("Silence, and what the host does")[-6:]
    }
    assert told == {
        name: getattr(messages, name) for name in vars(messages) if name.endswith("_MS")
    }


def test_bandwidth():
    told = {row[0]: [cell.strip("*") for cell in row[1:]] for row in rows_of("Bandwidth")}
    levels = Levels(60, 1023)
    frame = Frame(0, levels.pack(np.full(60, 1023)))
    sizes = [len(encode(frame)), len(encode(State(0, 0, 0, 0, 0, 0, None)))]
    assert sizes == [line_bytes(3 + levels.packed_bytes), line_bytes(17)]
    assert told["**together**"] == [str(size) for size in sizes]
    assert told["bit/s"] == [str(size * 10 * 1000) for size in sizes]
    assert told["of 921600 baud"] == [f"{size * 1e6 / 921600:.1f} %" for size in sizes]
    parts = ("type and fixed fields", "levels, 60 · 10 / 8", "CRC-32", "COBS", "delimiter")
    for column, size in enumerate(sizes):
        assert sum(int(told[part][column] or 0) for part in parts) == size
