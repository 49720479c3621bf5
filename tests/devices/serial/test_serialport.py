"""Ports: what is said of those that cannot be opened; bytes in and out; gone and back."""

import errno
import os
import socket
import threading
import tty
from pathlib import Path

import pytest
import serial
from serial.tools.list_ports_common import ListPortInfo

from tests.engine.test_loop import info
from vbraille.devices.serial.openserial import open_serial
from vbraille.devices.serial.ports import (
    Address,
    explain,
    find_again,
    identify,
    open_serial_port,
    parse_address,
)
from vbraille.devices.serial.seriallines import DescriptorLine, ThreadedLine, open_line
from vbraille.devices.serial.serialport import SerialPort
from vbraille.errors import DeviceError, InputError, VbrailleError

FRAME = b"\x07" + b"frame" * 16 + b"\0"


@pytest.fixture
def ends():
    """Both ends of a pseudo-terminal: the peer's, and the name of ours."""
    peer, ours = os.openpty()
    tty.setraw(ours)
    os.set_blocking(peer, False)
    yield peer, os.ttyname(ours)
    os.close(ours)
    os.close(peer)


@pytest.mark.parametrize(
    ("text", "address"),
    [
        ("/dev/ttyACM0", Address("/dev/ttyACM0")),
        ("./vb0?baud=115200", Address("./vb0", 115200)),
        ("socket://host:1?baud=300", Address("socket://host:1", 300)),
        ("spy:///dev/x?file=log&baud=300&all", Address("spy:///dev/x?file=log&all", 300)),
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
        ("foo://bar", "for there is no kind of port foo://; give a path such as /dev/ttyACM0, or"),
        ("../x://y", "for there is no kind of port ../x://; give a path"),
        ("socket://127.0.0.1", "for it needs the number of a port from 1 to 65535; an example is"),
        (
            "socket://[::1]:99999",
            "for it needs a host and the number of a port from 1 to 65535; an",
        ),
        ("socket://[::1", "for it needs a host and the number of a port"),
        ("socket://localhost:abc", "for it needs a host and the number of a port"),
        ("socket://localhost:-1", "for it needs a host and the number of a port"),
        ("socket://localhost:0", "for it needs the number of a port from 1"),
        ("socket://:7000", "for it names no host; an example is socket://192.168.1.5:7000"),
        ("socket://h:1/x", "for nothing can follow the number of the port, as '/x' does"),
        ("socket://h:1?x=1", "for socket:// has no option 'x' (there is logging)"),
        ("socket://h:1?logging=loud", "for logging is 'loud' and must be one of debug, info"),
        ("rfc2217://127.0.0.1", "for it needs the number of a port from 1 to 65535"),
        ("rfc2217://[::1]:99999", "for it needs a host and the number of a port"),
        ("rfc2217://h:1?timeout=x", "for timeout is 'x' and must be a number of seconds"),
        ("loop://?logging=loud", "for logging is 'loud' and must be one of"),
        ("spy://", "for it names no port; an example is spy:///dev/ttyACM0?file=bytes.txt"),
        ("spy:///dev/x?foo=1", "for spy:// has no option 'foo' (there is file, color, raw, all)"),
        ("spy:///dev/x?file=/none/x", "for there is no folder for the file '/none/x'"),
        ("alt:///dev/x?class=time", "for class is 'time' and must be one of Serial, PosixPoll"),
        ("hwgrep://", "for it has nothing to look for; an example is hwgrep://Arduino"),
        ("hwgrep://[", "for '[' is no regular expression"),
        ("hwgrep://x&n=0", "for n is '0' and must be 1 for the first port found, 2 for the next"),
        ("hwgrep://x&foo=1", "for hwgrep:// has no option 'foo' (there is n, skip_busy)"),
        ("cp2110://x", "for the Python package hidapi is not installed, which it needs"),
    ],
)
def test_a_url_that_cannot_be_one_says_what_is_wrong_in_it(url, sentence):
    with pytest.raises(InputError) as raised:
        open_serial(url, info())
    assert str(raised.value).startswith(f"{url} cannot be opened, {sentence}")


@pytest.mark.parametrize(
    ("url", "sentence"),
    [
        ("socket://127.0.0.1:1", "127.0.0.1 is there, but nothing answers at its port 1; start"),
        ("rfc2217://127.0.0.1:1", "127.0.0.1 is there, but nothing answers at its port 1; start"),
        ("socket://no.such.invalid:1", "there is no computer no.such.invalid; see that"),
        ("spy:///dev/none", "there is no port spy:///dev/none; "),
        ("alt:///dev/none", "there is no port alt:///dev/none; "),
        ("spy:///dev/null", "spy:///dev/null is no serial port; choose another"),
        ("hwgrep://nothing_fits_this", "no port fits hwgrep://nothing_fits_this; 'vbraille device"),
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
        (errno.EPROTO, "socket://host:1 cannot be opened, for what answers there does not do what"),
    ],
)
def test_what_pyserial_put_its_own_words_around_is_still_told(number, sentence):
    fault = serial.SerialException("Could not open port socket://host:1: [Errno 110]")
    fault.__context__ = OSError(number, "whatever")
    assert str(explain(fault, "socket://host:1")).startswith(sentence)


def test_a_busy_port(ends):
    _, name = ends
    line = open_line(Address(name))
    with pytest.raises(DeviceError, match=f"{name} is busy; end the other program"):
        open_serial(name, info())
    line.close()


def test_the_right_to_open_a_port():
    for number in (errno.EACCES, errno.EPERM):
        sentence = explain(serial.SerialException(number, "could not open"), "/dev/ttyACM0")
        assert isinstance(sentence, DeviceError)
        assert str(sentence).startswith("you may not open /dev/ttyACM0; add yourself to the group")
        assert "dialout" in str(sentence)


@pytest.mark.parametrize("baud", [9600, 921600, 250000])
def test_a_port_is_opened_at_its_baud_rate(ends, baud):
    port = open_serial_port(Address(ends[1], baud))
    assert port.baudrate == baud
    port.close()


def test_limits():
    assert Address("/dev/ttyUSB0").limits
    assert not Address("/dev/ttyACM0").limits
    assert not Address("/dev/pts/3").limits
    assert not Address("socket://host:1").limits
    assert Address("/dev/pts/3", 9600).limits


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


def read_all(peer: int) -> bytes:
    chunks = []
    try:
        while chunk := os.read(peer, 65536):
            chunks.append(chunk)
    except BlockingIOError:
        pass
    return b"".join(chunks)


def wait_for(line, wanted: int) -> bytes:
    """Bytes of a line that others bring, in their own time."""
    got = b""
    for _ in range(2_000_000):
        got += line.read()
        if len(got) >= wanted:
            return got
        os.sched_yield()
    raise AssertionError(f"{len(got)} bytes of {wanted} came")


def test_a_terminal_is_read_and_written_without_waiting(ends):
    peer, name = ends
    line = open_line(Address(name))
    assert isinstance(line, DescriptorLine)
    assert line.read() == b""
    os.write(peer, FRAME)
    assert wait_for(line, len(FRAME)) == FRAME
    assert line.write(FRAME)
    assert read_all(peer) == FRAME
    assert line.drained()
    line.close()


def test_a_frame_sent_in_part_is_ended_before_the_next_begins(ends):
    peer, name = ends
    line = open_line(Address(name))
    frames = [bytes([1 + i % 255]) * 81 + b"\0" for i in range(1000)]
    taken = [frame for frame in frames if line.write(frame)]
    assert 100 < len(taken) < 900
    stuck = read_all(peer)
    assert not stuck.endswith(b"\0")  # the line was full in the midst of a frame
    taken += [frame for frame in (b"first\0", b"second\0") if line.write(frame)]
    assert stuck + read_all(peer) == b"".join(taken)
    assert taken[-2:] == [b"first\0", b"second\0"]
    line.close()


class Sockets(serial.SerialBase):
    """A line whose room a test can choose; the peer's end is `peer`."""

    def __init__(self):
        super().__init__()
        self.ours, self.peer = socket.socketpair()
        self.ours.setblocking(False)
        self.ours.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 4096)

    def close(self):
        self.ours.close()


def test_a_frame_is_dropped_where_only_the_rest_of_the_one_before_fits():
    port = Sockets()
    line = DescriptorLine(port, port.ours.fileno())
    big = b"x" * 1_000_000 + b"\0"
    assert line.write(big)  # begun
    assert not line.drained()
    got, late = b"", []
    while len(got) < len(big):
        late.append(line.write(b"late\0"))
        got += port.peer.recv(65536)
    assert not any(late[:-2])
    line.close()
    while chunk := port.peer.recv(65536):
        got += chunk
    assert got == big + b"late\0" * sum(late)
    port.peer.close()


def test_a_hung_up_terminal_is_gone_at_once_and_found_at_its_link(tmp_path):
    link = tmp_path / "vb0"
    port = None
    for _ in range(3):
        peer, ours = os.openpty()
        tty.setraw(ours)
        os.set_blocking(peer, False)
        link.symlink_to(os.ttyname(ours))
        if port is None:
            port = SerialPort(Address(str(link)), look_s=0.001)
        else:
            join_finder()
            assert port.gone
            assert port.read() == b""
        assert not port.gone
        assert port.write(FRAME)
        assert read_all(peer) == FRAME
        link.unlink()
        os.close(peer)
        os.close(ours)
        losses = port.losses
        assert port.read() == b""
        assert port.gone
        assert port.losses == losses + 1
        assert not port.write(FRAME)
    port.close()
    assert not finders()


def test_a_hang_up_is_seen_by_write_too():
    peer, ours = os.openpty()
    tty.setraw(ours)
    port = SerialPort(Address(os.ttyname(ours)), look_s=0.001)
    os.close(peer)
    os.close(ours)
    assert not port.write(FRAME)
    assert port.gone
    port.close()


def test_a_port_that_was_found_and_not_taken_is_closed_with_the_rest(tmp_path):
    before = len(list(Path("/proc/self/fd").iterdir()))
    link = tmp_path / "vb0"
    peer, ours = os.openpty()
    link.symlink_to(os.ttyname(ours))
    port = SerialPort(Address(str(link)), look_s=0.001)
    os.close(peer)
    os.close(ours)
    port.read()
    link.unlink()
    peer, ours = os.openpty()
    link.symlink_to(os.ttyname(ours))
    join_finder()
    port.close()
    os.close(peer)
    os.close(ours)
    assert len(list(Path("/proc/self/fd").iterdir())) == before


def finders() -> list[threading.Thread]:
    return [thread for thread in threading.enumerate() if "finder" in thread.name]


def join_finder() -> None:
    for thread in finders():
        thread.join(10)


def test_a_socket_is_a_descriptor_too():
    server = socket.create_server(("127.0.0.1", 0))
    address = Address(f"socket://127.0.0.1:{server.getsockname()[1]}")
    port = SerialPort(address, look_s=0.001)
    peer, _ = server.accept()
    assert port.write(FRAME)
    assert peer.recv(100) == FRAME
    assert port.read() == b""
    peer.sendall(FRAME)
    assert wait_for(port, len(FRAME)) == FRAME
    peer.close()
    while not port.gone:
        port.read()
    again, _ = server.accept()
    join_finder()
    port.read()
    assert not port.gone
    assert port.write(FRAME)
    assert again.recv(100) == FRAME
    port.close()
    again.close()
    server.close()


def test_a_loop_has_threads_which_end():
    line = open_line(Address("loop://"))
    assert isinstance(line, ThreadedLine)
    assert line.write(FRAME)
    assert wait_for(line, len(FRAME)) == FRAME
    assert line.drained()
    line.close()
    assert not [thread for thread in threading.enumerate() if thread.name == "vbraille port"]


def test_a_loop_is_no_device():
    now_ns = 0

    def pause(_seconds):
        nonlocal now_ns
        now_ns += 1_000_000
        for _ in range(20):
            os.sched_yield()  # the threads of the loop have a time of their own

    with pytest.raises(DeviceError, match="makes no sense: it is no vbraille device"):
        open_serial("loop://", info(), now_ns=lambda: now_ns, pause=pause)


def test_a_spy_sees_what_is_sent_and_read(ends, tmp_path):
    peer, name = ends
    log = tmp_path / "log"
    port = open_serial_port(Address(f"spy://{name}?file={log}"))
    line = ThreadedLine(port)
    assert line.write(b"to the device\0")
    os.write(peer, b"to the host\0")
    assert wait_for(line, 12) == b"to the host\0"
    while not line.drained():
        os.sched_yield()
    line.close()
    port.formatter.output.close()
    text = log.read_text()
    assert "TX   0000  74 6F 20 74 68 65 20 64" in text
    assert sum(line.split()[1] == "RX" for line in text.splitlines()) >= 1


class Stuck(serial.SerialBase):
    """A handler whose writes wait until they are let go, and which then fails."""

    def __init__(self):
        super().__init__()
        self.begun, self.go_on = threading.Event(), threading.Event()
        self.written, self.fault = [], None
        self.closed_ = False

    def _reconfigure_port(self):
        pass

    def read(self, _size=1):
        self.go_on.wait(0.01)
        return b""

    def write(self, frame):
        self.written.append(bytes(frame))
        self.begun.set()
        self.go_on.wait(10)
        if self.fault:
            raise self.fault

    def close(self):
        self.closed_ = True


def test_a_handler_that_waits_keeps_nobody_waiting_and_the_newest_frame_wins():
    stuck = Stuck()
    line = ThreadedLine(stuck)
    assert line.write(b"first")
    stuck.begun.wait(10)
    for i in range(100):
        assert line.write(b"%d" % i)
        assert line.read() == b""
    assert not line.drained()
    assert line.lost == 99
    stuck.go_on.set()
    while not line.drained():
        os.sched_yield()
    assert stuck.written == [b"first", b"99"]
    line.close()
    assert stuck.closed_


def test_a_frame_that_a_handler_gave_up_is_counted_and_ended():
    stuck = Stuck()
    line = ThreadedLine(stuck)
    stuck.fault = serial.SerialTimeoutException("Write timeout")
    line.write(b"first")
    stuck.begun.wait(10)
    line.write(b"second")
    stuck.go_on.set()
    while len(stuck.written) < 2:
        os.sched_yield()
    assert stuck.written == [b"first", b"\0second"]
    line.close()
    assert line.lost == 2


@pytest.mark.parametrize("fault", [AttributeError("no socket"), OSError("gone")])
def test_whatever_a_handler_raises_its_line_is_gone(fault):
    stuck = Stuck()
    line = ThreadedLine(stuck)
    stuck.fault = fault
    line.write(b"first")
    stuck.go_on.set()
    with pytest.raises(OSError, match=str(fault)):
        wait_for(line, 1)
    with pytest.raises(OSError, match=str(fault)):
        line.write(b"second")
    line.close()
