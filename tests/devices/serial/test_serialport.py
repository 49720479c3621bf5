"""Ports: those that cannot be opened; bytes in and out; gone and back."""

import errno
import os
import socket
import termios
import threading
import tty
from contextlib import suppress
from pathlib import Path

import pytest
import serial

from tests.engine.test_loop import info
from vbraille.devices.serial.device import open_serial
from vbraille.devices.serial.port import (
    Address,
    SerialLine,
    SerialPort,
    explain,
    open_line,
    open_serial_port,
)
from vbraille.errors import DeviceError

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

    def fileno(self):
        return self.ours.fileno()

    def close(self):
        self.ours.close()


def test_a_frame_is_dropped_where_only_the_rest_of_the_one_before_fits():
    port = Sockets()
    line = SerialLine(port)
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


def test_what_echoes_is_no_device(ends):
    peer, name = ends
    now_ns = 0

    def pause(_seconds):
        nonlocal now_ns
        now_ns += 1_000_000
        with suppress(BlockingIOError):
            os.write(peer, os.read(peer, 65536))

    with pytest.raises(DeviceError, match="makes no sense: it is no vbraille device"):
        open_serial(name, info(), now_ns=lambda: now_ns, pause=pause)


@pytest.mark.parametrize("queued", [0, 7])
def test_what_could_not_be_sent_is_dropped_for_closing_a_uart_would_wait_for_it(
    ends, monkeypatch, queued
):
    line, flushed = open_line(Address(ends[1])), []

    def ioctl(_descriptor, request, room):
        assert request == termios.TIOCOUTQ
        room[0] = queued

    monkeypatch.setattr("fcntl.ioctl", ioctl)
    monkeypatch.setattr("termios.tcflush", lambda _descriptor, queue: flushed.append(queue))
    line.close()
    assert flushed == [termios.TCOFLUSH] * bool(queued)
