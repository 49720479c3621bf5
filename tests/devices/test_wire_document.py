"""The protocol's page against the code: firmware is written from the one, a host runs the other."""

import ast
import math
import re
from dataclasses import replace
from pathlib import Path
from zlib import crc32

import pytest
from cobs import cobs

from tests.packing import packed as packed_levels
from vbraille.devices.serial import wire
from vbraille.devices.serial.conversation import TRANSITIONS, Stage
from vbraille.devices.serial.device import LOWEST_RATE_HZ
from vbraille.devices.serial.hardware import CarriagePlace
from vbraille.devices.serial.wire import (
    CRC_RESIDUE,
    FAULTY,
    FIRST_STEP,
    KNOB_STEP,
    KNOB_TOP,
    MESSAGES,
    MOST_FRAME_BYTES,
    OUT_OF_REST,
    PACE,
    PLACED,
    RAMP_MS,
    RESTING,
    TRIPPED,
    WATCHDOG_MS,
    BodyCodec,
    Decoder,
    ErrorCode,
    Fixed,
    Frame,
    Info,
    Levels,
    Number,
    OneOf,
    PerActuator,
    ShortText,
    State,
    Watchdog,
    encode,
    fields_of,
    line_bytes,
)
from vbraille.engine.checkup import _PLACE_SLACK_MM
from vbraille.engine.constants import CATCH_UP, GAP_PERIODS

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
                return getattr(wire, enum)[name]
            case ast.Call(ast.Attribute(ast.Name("bytes"), "fromhex"), [ast.Constant(text)]):
                return bytes.fromhex(text)
        return ast.literal_eval(node)

    node = ast.parse(call, mode="eval").body
    assert isinstance(node, ast.Call)
    return getattr(wire, node.func.id)(**{k.arg: value(k.value) for k in node.keywords})


def example_of(message):
    """Message, body, CRC and line of a message's example."""
    pattern = r"```text\n(.+?)\nbody (.+?)\ncrc (.+?)\nline (.+?)\n```"
    (found,) = re.findall(pattern, SECTIONS[message.__name__.upper()], re.S)
    return (built(found[0]), *(bytes.fromhex(part) for part in found[1:]))


@EVERY_MESSAGE
def test_examples(code, message):
    example, body, crc, line = example_of(message)
    assert type(example) is message
    assert BodyCodec(code, message).encode(example) == body
    assert BodyCodec(code, message).decode(body) == example
    assert crc32(body).to_bytes(4, "little") == crc
    assert cobs.encode(body + crc) + b"\0" == line == encode(example)
    assert Decoder().feed(line) == [example]


def type_and_values(field):
    match field:
        case Number():
            values = f"{field.low} … {field.high} {field.unit}".strip()
            none = "" if field.none is None else f", {field.none} none"
            return TYPES[field.code], values + none
        case OneOf():
            choices = [f"{int(choice)} {choice.name.lower()}" for choice in field.of]
            return TYPES[field.code], ", ".join(choices)
        case ShortText():
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
    assert wire.NOTICES == 128


def test_flags():
    flags = next(row for row in rows_of("STATE") if row[2] == "`flags`")
    assert flags[4] == "bit 0 placed, bit 1 resting, bit 2 faulty, bit 3 tripped; the others 0"
    assert (PLACED, RESTING, FAULTY, TRIPPED) == (1 << 0, 1 << 1, 1 << 2, 1 << 3)
    named = re.findall(r"^- \*(\w+)\*:", SECTIONS["STATE"], re.M)
    assert named == ["placed", "resting", "faulty", "tripped"]


def test_knobs():
    text = " ".join(SECTIONS["STATE"].split())
    assert f"once it has gone {KNOB_STEP} or further, or has come to 0 or {KNOB_TOP}" in text
    assert f"may jitter by {KNOB_STEP - 1}." in text


def test_a_device_of_one_axis():
    info = example_of(Info)[0]
    signs = {"y_count_sign", "turn_sign"}
    names = [name for name, _ in fields_of(Info)]
    less = dict.fromkeys(names[names.index("buttons") :], 0) | dict.fromkeys(signs, 1)
    body = BodyCodec(0x81, Info).encode(replace(info, **less))
    told = int(re.search(r"ends in `enabled` and (\d+) bytes that are 0", SECTIONS["INFO"])[1])
    assert body[-told - 6 : -told] == info.enabled
    assert len([byte for byte in body[-told:] if byte]) == len(signs)


def test_the_place_of_the_example():
    """The equations of the page, executed, give what the host has, and what the page says."""
    info, state = example_of(Info)[0], example_of(State)[0]
    place = CarriagePlace(info).take(state)
    names = {name: getattr(info, name) for name, _ in fields_of(Info)}
    names |= {"π": math.pi, "d0": info.far_stop_count, "e0": info.straight_count}
    names |= {"d": state.y_count, "theta_count": state.theta_count}
    names["h"] = info.counts_per_turn // 2
    found = re.findall(r"^    (y_mm|e|θ) += (.+?)(?: {3}.*)?$", SECTIONS["Place"], re.M)
    for name, equation in found:
        for sign, python in (("·", "*"), ("−", "-"), ("mod", "%"), ("2π", "2 * π")):
            equation = equation.replace(sign, python)
        names[name] = eval(equation, {}, names)
    assert place.y_mm == pytest.approx(names["y_mm"]) == pytest.approx(130)
    assert place.theta_rad == pytest.approx(names["θ"]) == pytest.approx(math.radians(-16.875))
    said = SECTIONS["STATE"]
    said = " ".join(said.split())
    assert "22.12 mm right of where lines begin and 130 mm below the far stop" in said
    assert "turned by 16.9° with the clock" in said
    assert place.x_mm == pytest.approx(22.12)
    assert state.knobs == 128 | 255 << 8
    # What it says is what such a device can say.
    assert state.flags == PLACED
    assert state.buttons.bit_length() <= info.buttons
    assert state.knobs.bit_length() <= 8 * info.knobs
    assert 0 <= place.y_mm <= info.height_um / 1000
    assert 0 <= state.theta_count < info.counts_per_turn


def test_places():
    """Those of the table, by the host and by the page's equations."""
    info, state = example_of(Info)[0], example_of(State)[0]
    rows = [row for row in rows_of("Place") if row[0].isdecimal()]
    assert len(rows) == 5
    right, down = info.column_pitch_nm * (info.columns - 1), info.row_pitch_nm * (info.rows - 1)
    u, v = -right / 2e6, -down / 2e6
    for row in rows:
        counts = dict(zip(("count", "y_count", "theta_count"), map(int, row[:3]), strict=True))
        place = CarriagePlace(info).take(replace(state, **counts))
        sin, cos = math.sin(place.theta_rad), math.cos(place.theta_rad)
        found = [place.x_mm, place.y_mm, math.degrees(place.theta_rad)]
        found += [place.x_mm + u * cos + v * sin, place.y_mm - u * sin + v * cos]
        assert found == pytest.approx(list(map(float, row[3:])), abs=5.1e-4)
    for equation in ("x_mm + u · cos θ + v · sin θ", "y_mm − u · sin θ + v · cos θ"):
        assert equation in SECTIONS["Place"]
    assert f"up to {_PLACE_SLACK_MM:g} mm beyond it" in SECTIONS["Place"]


def test_the_lowest_rate():
    text = " ".join(SECTIONS["FRAME"].split())
    assert f"never fewer than {LOWEST_RATE_HZ}." in text


def test_crc_and_cobs():
    text = SECTIONS["Frames"]
    assert f"0x{crc32(b'123456789'):X}" in text
    assert f"0x{CRC_RESIDUE:X}" in text
    assert crc32(b"any" + crc32(b"any").to_bytes(4, "little")) == CRC_RESIDUE
    (plain, stuffed) = re.search(r"`([0-9a-f ]+)` becomes `([0-9a-f ]+)`", text).groups()
    assert cobs.encode(bytes.fromhex(plain)) == bytes.fromhex(stuffed)
    assert f"takes {MOST_FRAME_BYTES} bytes before the zero" in text


def counted(text):
    """Bytes of the page's ``01 02 … fe 00``: counted up over the dots."""
    given = [None if word == "…" else int(word, 16) for word in text.strip("`").split()]
    found = []
    for word, after in zip(given, [*given[1:], None], strict=True):
        found += [word] if word is not None else range(found[-1] + 1, after)
    return bytes(found)


def test_cobs_of_long_runs():
    vectors = [row for row in rows_of("Frames") if row[0].isdecimal()]
    assert [int(row[0]) for row in vectors] == [254, 255, 255]
    for size, plain, stuffed in vectors:
        assert len(counted(plain)) == int(size)
        assert cobs.encode(counted(plain)) == counted(stuffed)
        assert cobs.decode(counted(stuffed)) == counted(plain)
    # With the 01 of other encoders.
    assert cobs.decode(counted(vectors[0][2]) + b"\1") == counted(vectors[0][1])


def test_frames_of_254_and_255_bytes_without_a_zero():
    vectors = [row for row in rows_of("Frames") if row[0].startswith("`01 …")]
    sizes = []
    for packed, crc, line in vectors:
        body = b"\x02\x01\x01" + counted(packed.replace("01 …", "01 02 …"))
        crc = counted(crc)
        assert crc32(body).to_bytes(4, "little") == crc
        assert 0 not in body + crc
        sizes.append(len(body + crc))
        sent = encode(Frame(257, body[3:]))
        head, tail = line.strip("`").split(" … ")
        assert sent.startswith(bytes.fromhex(head))
        assert sent.endswith(bytes.fromhex(tail))
        assert len(sent) == sizes[-1] + 2 + (sizes[-1] > 254)
        for spelled in (sent, *([sent[:-1] + b"\1\0"] if sizes[-1] == 254 else ())):
            assert Decoder().feed(spelled) == [Frame(257, body[3:])]
    assert sizes == [254, 255]


def test_the_crc_of_16_entries():
    text = SECTIONS["Memory"]
    table = [int(word, 16) for word in re.findall(r"\b[0-9a-f]{8}\b", text)]
    assert len(table) == 16
    steps = re.search(r"^crc = 0xFFFFFFFF\n.*?^crc = crc \^ 0xFFFFFFFF$", text, re.M | re.S)[0]
    program = steps.replace("for each byte b:", "for b in text:")
    for given in (b"", b"123456789", bytes(range(256)) * 3):
        names = {"T": table, "text": given}
        exec(program, names)
        assert names["crc"] == crc32(given)


def test_memory():
    text = SECTIONS["Memory"]
    packed = Levels(60, 1023).packed_bytes
    assert f"{line_bytes(3 + packed) - 1} bytes for what is received" in text
    assert f"{4 * 60 * 2} for `levels`, `from`, `goal` and `wanted`" in text
    sizes = {kind: len(encode(example_of(kind)[0])) for kind in (State, Watchdog)}
    firmware = " ".join(SECTIONS["A minimal firmware"].split())
    assert f"STATE ({sizes[State]}), WATCHDOG ({sizes[Watchdog]})" in firmware


def test_from_frame_to_frame():
    text = " ".join(SECTIONS["From FRAME to FRAME"].split())
    assert f"every actuator goes {PACE} / n of the way" in text
    assert f"n falls by {PACE}. Where n is {PACE} or less" in text
    assert f"The FRAME that ends a rest makes it {OUT_OF_REST}." in text
    assert (GAP_PERIODS, CATCH_UP) == (2, 1.5)
    assert "for more than two periods** goes on" in text
    assert "catches up with the hand half as fast again as the hand goes" in text
    firmware = SECTIONS["A minimal firmware"]
    assert f"take(now); behind = {OUT_OF_REST}\n" in firmware
    assert f"(goal - levels) * {PACE} / behind; behind = behind - {PACE}\n" in firmware


def test_rest():
    text = " ".join(SECTIONS["Rest, and the watchdog"].split())
    assert f"**The ramp to rest takes {RAMP_MS} ms:**" in text
    assert f"({FIRST_STEP} · |level − rest| > `top_level`)" in text
    assert f"**{WATCHDOG_MS} ms of the device's own time without a FRAME" in text
    assert f"sent no FRAME for {wire.STALL_MS} ms" in text
    firmware = SECTIONS["A minimal firmware"]
    assert f"now - last_frame >= {WATCHDOG_MS * 1000}:" in firmware
    assert f"now - ramp_began >= {RAMP_MS * 1000}:" in firmware
    assert f"further than top_level / {FIRST_STEP} from rest" in firmware


def test_levels():
    text = SECTIONS["Levels"]
    level, bits, packed = (
        re.search(rf"^    {name} +(.+)$", text, re.M)[1] for name in ("level ", "bits", "bytes")
    )
    levels = [int(word) for word in level.split()[:6]]
    assert [int(word, 2) for word in bits.split()[:6]] == levels
    assert int(bits.replace(" ", ""), 2).to_bytes(8, "big") == bytes.fromhex(packed)
    assert packed_levels(levels, 1023) == bytes.fromhex(packed)
    assert example_of(Frame)[0].packed == bytes.fromhex(packed)


def test_times():
    told = {
        row[0].strip("`"): int(row[1]) for row in rows_of("Silence, and what the host does")[-7:]
    }
    assert told == {name: getattr(wire, name) for name in vars(wire) if name.endswith("_MS")}


def test_bandwidth():
    told = {row[0]: [cell.strip("*") for cell in row[1:]] for row in rows_of("Bandwidth")}
    levels = Levels(60, 1023)
    frame = Frame(0, packed_levels([1023] * 60, 1023))
    state = State(0, 0, 0, 0, 0, 0, None, 0, 0, 0)
    sizes = [len(encode(message)) for message in (frame, state)]
    assert sizes == [line_bytes(3 + levels.packed_bytes), line_bytes(29)]
    assert told["**together**"] == [str(size) for size in sizes]
    assert told["bit/s"] == [str(size * 10 * 1000) for size in sizes]
    assert told["of 921600 baud"] == [f"{size * 1e6 / 921600:.1f} %" for size in sizes]
    parts = ("type and fixed fields", "levels, 60 · 10 / 8", "CRC-32", "COBS", "delimiter")
    for column, size in enumerate(sizes):
        assert sum(int(told[part][column] or 0) for part in parts) == size


def test_the_transitions_are_those_of_the_code():
    stages = [[stage.name, stage.value] for stage in Stage]
    taken = [
        [stage.name, cause.value, after.name]
        for stage, row in TRANSITIONS.items()
        for cause, after in row.items()
    ]
    assert rows_of("The conversation") == [*stages, *taken]
