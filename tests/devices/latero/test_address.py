"""The address of a Latero."""

import pytest

from vbraille.devices.latero.device import LateroAddress, parse_latero_address
from vbraille.errors import InputError


@pytest.mark.parametrize(
    ("text", "address"),
    [
        ("lab-7", LateroAddress("lab-7", 8900, None, 0, False)),
        ("10.0.0.2:9000", LateroAddress("10.0.0.2", 9000, None, 0, False)),
        ("a?offsets=1,-2,3", LateroAddress("a", 8900, (1, 0xFFFF_FFFE, 3), 0, False)),
        ("a?power=none", LateroAddress("a", 8900, None, None, True)),
        ("a?power=0x1F", LateroAddress("a", 8900, None, 31, True)),
        ("a?power=08", LateroAddress("a", 8900, None, 8, True)),
    ],
)
def test_an_address(text, address):
    assert parse_latero_address(text) == address


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "needs the name"),
        ("a b", "needs the name"),
        ("a:", "port is ''"),
        ("a:0", "port is '0'"),
        ("a:65536", "port is '65536'"),
        ("a:000001234567", "port is '000001234567'"),
        ("a?offsets=1,2", "three whole numbers"),
        ("a?power=on", "register"),
        ("a?power=99999", "register"),
        ("a?baud=3", "no option baud=3"),
    ],
)
def test_what_is_no_address_is_refused_in_a_sentence(text, why):
    with pytest.raises(InputError, match=why):
        parse_latero_address(text)
