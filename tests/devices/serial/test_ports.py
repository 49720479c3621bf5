"""Which port is meant: by an address, by one that cannot be, and wherever it is plugged in."""

import errno

import pytest
import serial
from serial.tools.list_ports_common import ListPortInfo

from tests.engine.test_loop import info
from vbraille.devices.serial.device import open_serial
from vbraille.devices.serial.port import Address, explain, find_again, identify, parse_address
from vbraille.errors import InputError, VbrailleError


@pytest.mark.parametrize(
    ("text", "address"),
    [
        ("/dev/ttyACM0", Address("/dev/ttyACM0")),
        ("./vb0?baud=115200", Address("./vb0", 115200)),
        ("socket://host:1?baud=300", Address("socket://host:1", 300)),
    ],
)
def test_addresses(text, address):
    assert parse_address(text) == address


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "serial: needs a port, as in serial:/dev/ttyACM0; "),
        ("?baud=300", "serial: needs a port"),
        ("/dev/x?parity=even", "there is no option 'parity' of a serial port; there is baud"),
        ("/dev/x?baud=fast", "baud rate is 'fast'; it must be a whole number from 300 to 12000000"),
        ("/dev/x?baud=", "baud rate is ''"),
        ("/dev/x?baud=-9600", "baud rate is '-9600'"),
        ("/dev/x?baud=299", "baud rate is '299'"),
    ],
)
def test_bad_addresses(text, sentence):
    with pytest.raises(InputError, match=sentence):
        parse_address(text)


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("none", "there is no port .*none; (there is /dev|plug the device in)"),
        ("", "is no serial port; (there is /dev|plug the device in)"),
        ("file", "file is no serial port"),
        ("file/below", "there is no port"),
        ("dangling", "there is no port"),
        ("null", "null is no serial port"),
    ],
)
def test_what_is_no_port(tmp_path, name, sentence):
    (tmp_path / "file").write_text("text")
    (tmp_path / "dangling").symlink_to(tmp_path / "none")
    (tmp_path / "null").symlink_to("/dev/null")
    with pytest.raises(InputError, match=sentence):
        open_serial(str(tmp_path / name), info())


@pytest.mark.parametrize(
    ("url", "sentence"),
    [
        ("foo://bar", "is no port; give a path, such as /dev/ttyACM0"),
        ("../x://y", "is no port; give a path"),
        ("spy:///dev/ttyACM0", "is no port; give a path"),
        ("hwgrep://Arduino", "or one of /dev/serial/by-id/, or socket://192.168.1.5:7000"),
        ("rfc2217://127.0.0.1:7000", "or socket://192.168.1.5:7000"),
        ("socket://127.0.0.1", "needs a host and the number of a port, as in socket://192"),
        ("socket://[::1]:99999", "needs a host and the number of a port"),
        ("socket://[::1", "needs a host and the number of a port"),
        ("socket://localhost:abc", "needs a host and the number of a port"),
        ("socket://localhost:-1", "needs a host and the number of a port"),
        ("socket://localhost:0", "needs a host and the number of a port"),
        ("socket://:7000", "needs a host and the number of a port"),
        ("socket://h:1/x", "needs a host and the number of a port"),
        ("socket://h:1?x=1", "there is no option 'x' of a serial port; there is baud"),
    ],
)
def test_a_url_that_is_no_socket_says_what_to_give(url, sentence):
    with pytest.raises(InputError) as raised:
        open_serial(url, info())
    assert sentence in str(raised.value)


@pytest.mark.parametrize(
    ("url", "sentence"),
    [
        ("socket://127.0.0.1:1", "127.0.0.1 is there, but nothing answers at its port 1; start"),
        ("socket://no.such.invalid:1", "there is no computer no.such.invalid; see that"),
    ],
)
def test_a_url_that_was_not_opened_says_why_in_our_own_words(url, sentence):
    with pytest.raises(VbrailleError) as raised:
        open_serial(url, info())
    assert str(raised.value).startswith(sentence)
    assert "rrno" not in str(raised.value)


@pytest.mark.parametrize(
    ("number", "sentence"),
    [
        (errno.ETIMEDOUT, "host does not answer; see that it is on and in this network"),
        (errno.EHOSTUNREACH, "there is no way to host; see that it is on and in this network"),
        (errno.EPROTO, "socket://host:1 cannot be opened; see that host and port are right"),
    ],
)
def test_what_pyserial_put_its_own_words_around_is_still_told(number, sentence):
    fault = serial.SerialException("Could not open port socket://host:1: [Errno 110]")
    fault.__context__ = OSError(number, "whatever")
    assert str(explain(fault, "socket://host:1")).startswith(sentence)


def usb(device, serial_number="A1", vid=0x2341, pid=0x43, location="1-4"):
    port = ListPortInfo(device)
    port.vid, port.pid, port.serial_number, port.location = vid, pid, serial_number, location
    return port


def test_a_device_is_found_by_its_number_wherever_it_is_plugged_in(tmp_path):
    address = Address("/dev/ttyACM0")
    identity = identify(address, lambda: [usb("/dev/ttyACM9", "B2"), usb("/dev/ttyACM0")])
    assert identity is not None
    assert find_again(address, identity, lambda: [usb("/dev/ttyACM3")]) == "/dev/ttyACM3"
    others = [
        usb("/dev/ttyACM0", "B2"),
        usb("/dev/ttyACM1", vid=1),
        usb("/dev/ttyACM2", pid=1),
        usb("/dev/ttyACM4", location="1-4:1.2"),
    ]
    assert find_again(address, identity, lambda: others) is None
    assert find_again(address, identity, lambda: [*others, usb("/dev/x")]) == "/dev/x"
    link = tmp_path / "link"
    link.symlink_to("/dev/ttyACM0")
    assert identify(Address(str(link)), lambda: [usb("/dev/ttyACM0")]) == identity


def test_one_of_several_ports_of_a_device_is_told_from_the_others():
    ports = [usb("/dev/ttyUSB0", location="1-4:1.0"), usb("/dev/ttyUSB1", location="1-4:1.1")]
    identity = identify(Address("/dev/ttyUSB1"), lambda: ports)
    moved = [usb("/dev/ttyUSB2", location="2-1:1.0"), usb("/dev/ttyUSB3", location="2-1:1.1")]
    assert find_again(Address("/dev/ttyUSB1"), identity, lambda: moved) == "/dev/ttyUSB3"


@pytest.mark.parametrize(
    ("url", "ports"),
    [
        ("/dev/ttyUSB0", [usb("/dev/ttyUSB0", None)]),
        ("/dev/ttyUSB0", [usb("/dev/ttyUSB0", vid=None)]),
        ("/dev/ttyS0", []),
        ("socket://host:1", [usb("socket://host:1")]),
    ],
)
def test_what_has_no_number_is_expected_where_it_was(url, ports):
    identity = identify(Address(url), lambda: ports)
    assert identity is None
    assert find_again(Address(url), identity, list) == url
