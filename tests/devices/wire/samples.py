"""Messages of the protocol: one of each kind, and any that can be."""

import pytest
from hypothesis import strategies as st

from vbraille.devices.serial.wire import (
    MESSAGES,
    PLACED,
    VERSION,
    BodyCodec,
    CountSign,
    Encoder,
    Error,
    Frame,
    Hello,
    Info,
    Number,
    OneOf,
    Packed,
    PerActuator,
    Rest,
    RestSide,
    ShortText,
    State,
    TurnSign,
    Watchdog,
    YCountSign,
    fields_of,
)

CODES = {message: code for code, message in MESSAGES.items()}
EVERY_MESSAGE = pytest.mark.parametrize("kind", CODES, ids=lambda k: k.__name__)
CODECS = {message: BodyCodec(code, message) for message, code in CODES.items()}
PRINTABLE = st.characters(exclude_categories=("C", "Z")) | st.just(" ")
INFO = Info(
    version=VERSION,
    rows=2,
    columns=3,
    column_pitch_nm=1_200_000,
    row_pitch_nm=1_800_000,
    rest_side=RestSide.RIGHT,
    top_level=150,
    rate_hz=1000,
    largest_slew_per_s=0,
    travel_um=300_000,
    encoder=Encoder.INDEX,
    counts_per_m=200_000,
    count_sign=CountSign.LEFTWARD,
    count_bits=24,
    left_stop_count=100,
    name="STReSS²",
    firmware="1.0",
    inverted=bytes(6),
    gain=bytes([255] * 6),
    enabled=bytes([1] * 6),
    buttons=2,
    knobs=1,
    contactor_width_nm=500_000,
    contactor_height_nm=1_400_000,
    height_um=200_000,
    y_counts_per_m=100_000,
    y_count_sign=YCountSign.AWAY,
    far_stop_count=5,
    counts_per_turn=4096,
    turn_sign=TurnSign.CLOCKWISE,
    straight_count=7,
)
STATE = State(1, 2_000_000, 3, 4, PLACED, 0, -5, 6, 7, 0x010203FF)
SAMPLES = [
    Hello(),
    Frame(1, b"\x00\xff\x80"),
    Rest(),
    INFO,
    STATE,
    Watchdog(0, 0),
    Error(255, "It rattles."),
]


def values(field, actuators):
    match field:
        case Number():
            numbers = st.integers(field.low, field.high)
            return numbers if field.none is None else st.none() | numbers
        case OneOf():
            return st.sampled_from(field.of)
        case ShortText():
            texts = st.text(PRINTABLE, min_size=field.fewest, max_size=20)
            return texts.filter(lambda text: text.strip() or not field.fewest)
        case PerActuator():
            size = {"min_size": actuators, "max_size": actuators}
            return st.lists(st.integers(0, field.high), **size).map(bytes)
        case Packed():
            return st.binary(min_size=1, max_size=300)


@st.composite
def messages_of(draw, kind):
    known = {}
    if issubclass(kind, Info):
        known = {"rows": draw(st.integers(1, 4)), "columns": draw(st.integers(1, 6))}
    actuators = known.get("rows", 0) * known.get("columns", 0)
    for name, field in fields_of(kind):
        if name not in known:
            known[name] = draw(values(field, actuators))
    return kind(**known)


def body_of(message):
    return CODECS[type(message)].encode(message)
