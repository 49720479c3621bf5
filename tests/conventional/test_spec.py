"""Specs of conventional displays."""

import pytest

from vbraille.conventional.brlapi import load_library
from vbraille.conventional.spec import opener_of
from vbraille.errors import InputError
from vbraille.wording import spelled


@pytest.mark.parametrize(
    ("spec", "why"),
    [
        ("", "--also is ''; give brlapi, brlapi:HOST:N for BRLTTY on another machine, "),
        ("brltty", "--also is 'brltty'; give brlapi"),
        ("brlapi:localhost", "after brlapi: there must be a host and a number, as in brlapi:127"),
        ("brlapi:a b:1", "after brlapi: there must be a host and a number"),
        ("brlapi:host:x", "after brlapi: there must be a host and a number"),
        ("dotpad", "after dotpad: there must be the path of a serial port, as in dotpad:/dev/tty"),
        ("hid:", "after hid: there must be a path, as in hid:/dev/hidraw0, or give hid for"),
        ("dotpad:/dev/ttyUSB0?baud=9", "after dotpad: there must be the path of a serial port"),
    ],
)
def test_what_is_none_is_one_sentence(spec, why):
    with pytest.raises(InputError) as raised:
        opener_of(spec)
    assert why in spelled(str(raised.value))


def test_without_the_library_it_is_said_what_to_install():
    with pytest.raises(InputError) as raised:
        load_library("libbrlapi-of-nobody.so")
    assert spelled(str(raised.value)) == (
        "--also brlapi needs BRLTTY's library libbrlapi-of-nobody.so; install Debian's packages "
        "brltty and libbrlapi0.8, or leave it out"
    )
