"""What a message cannot say is neither made nor sent."""

from dataclasses import replace

import pytest

from tests.devices.wire.samples import INFO, SAMPLES, STATE
from vbraille.devices.serial.wire import Fixed, Number, encode, fields_of

NUMBERS = [
    pytest.param(message, name, field, id=f"{type(message).__name__}-{name}")
    for message in SAMPLES
    for name, field in fields_of(type(message))
    if isinstance(field, Number)
]


@pytest.mark.parametrize(("message", "name", "field"), NUMBERS)
def test_numbers_have_bounds(message, name, field):
    for value in (field.low - 1, field.high + 1):
        with pytest.raises(ValueError, match=f"{name} is {value}; it must be {field.low} to"):
            replace(message, **{name: value})
    # Within what its bytes can hold, or struct would refuse what the table allows.
    for value in (field.low, field.high):
        assert isinstance(field, Fixed)
        assert field.unpack(field.pack(value), 0, {}) == (value, len(field.pack(0)))


@pytest.mark.parametrize(
    ("message", "change", "match"),
    [
        (INFO, {"encoder": 3}, r"encoder is 3; .* 2 \(INCREMENTAL\)"),
        (INFO, {"count_sign": 0}, "count_sign is 0"),
        (INFO, {"name": " "}, "name is ' '; .* not blank"),
        (INFO, {"name": ""}, "name is ''"),
        (INFO, {"firmware": "1\n"}, "firmware is .* printable"),
        (INFO, {"firmware": "é" * 128}, "0 to 255 bytes"),
        (INFO, {"gain": bytes(5)}, "gain are 5 bytes; there are 6 actuators"),
        (INFO, {"enabled": b"\2" * 6}, "enabled are up to 2; they must be 0 to 1"),
        (SAMPLES[1], {"packed": b""}, "packed are 0 bytes; they must be 1 to 2048"),
        (SAMPLES[1], {"packed": bytes(2049)}, "packed are 2049 bytes"),
    ],
)
def test_other_fields_have_bounds(message, change, match):
    with pytest.raises(ValueError, match=match):
        replace(message, **change)


@pytest.mark.parametrize("value", [1.5, 1.0, float("nan")])
def test_a_number_that_is_no_integer_is_not_sent(value):
    with pytest.raises(ValueError, match=r"cannot be encoded|time_us is nan"):
        encode(replace(STATE, time_us=value))
