"""A Latero as a device: at a real port, with a real watchdog."""

import os
import signal
import socket
import time
from dataclasses import replace

import numpy as np
import pytest

from tests.devices.latero.peers import address_of, simulated, until
from vbraille.devices.events import Back, Button, Placing, Silent
from vbraille.devices.latero.device import DISPLAY, open_latero
from vbraille.devices.registry import open_device
from vbraille.errors import DeviceError, InputError
from vbraille.simulation.controls import parse_moves
from vbraille.simulation.lateroboard import LateroBoard
from vbraille.testing.conformance import CHECKS

FELT = np.full((8, 8), 0.5)


@pytest.fixture
def latero():
    with simulated() as latero:
        yield latero


def pressed(events):
    """Presses of the right button."""
    return [e for e in events if isinstance(e, Button) and e.pressed and e.number == 2]


def ticks(device, frame=FELT, seconds=0.1, found=None):
    """Do ticks for a while, or until something is found; give the poses and the events."""
    poses, events = [], []
    end_s = time.monotonic() + (20 if found else seconds)
    while time.monotonic() < end_s:
        poses.append(device.read())
        device.write(frame)
        events += device.take_events()
        if found is not None and found(poses, events):
            return poses, events
        time.sleep(0.001)
    assert found is None, "it did not happen"
    return poses, events


@pytest.mark.real_time
@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__)
def test_it_conforms(latero, check):
    check(lambda: open_device(latero.spec, None))


def test_it_reads_shows_and_takes_leave(latero):
    with open_latero(address_of(latero), None) as device:
        assert device.display.axes == "xyθ"
        ticks(device, found=lambda poses, _: poses[-1] is not None)
        until(lambda: ticks(device, seconds=0.01) and (latero.board.levels == 75).all())
        assert device.placing is Placing.DONE
        assert device.acknowledges
        assert "offsets=4452,4294960000,120034" in device.particulars.protocol
        watching = device.watchdog._process.pid
    assert latero.board.at_rest
    assert not latero.board.powered
    with pytest.raises(ProcessLookupError):
        os.kill(watching, 0)


def test_the_watchdog_knows_where_the_blades_are_going_before_they_are_told():
    with simulated() as latero, open_latero(address_of(latero), None) as device:
        ticks(device, found=lambda *_: (latero.board.levels == 75).all())
        known, sent = device.watchdog.board, []

        class Line:
            def send(self, request):
                sent.append((bytes(known.levels), bytes(request[15:79])))

            def recv_into(self, _room):
                raise BlockingIOError

        line, device._line = device._line, Line()
        device.write(np.zeros((8, 8)))
        device.write(FELT)
        device._line = line
        assert sent
        assert all(told == shown for told, shown in sent)


def test_at_the_lower_left_x_is_half_the_span_before_the_line():
    with (
        simulated(wait_s=60.0) as latero,
        open_latero(f"127.0.0.1:{latero._socket.getsockname()[1]}", None) as device,
    ):
        assert device.placing is Placing.STOP
        device.set_zero()
        poses, _ = ticks(device, found=lambda poses, _: poses[-1] is not None)
        assert poses[-1].x_mm == pytest.approx(-4.2, abs=0.08)
        assert poses[-1].y_mm == pytest.approx(217.5, abs=0.08)
        assert poses[-1].theta_rad == pytest.approx(0, abs=1e-3)


def test_buttons_reach_the_reader():
    with (
        simulated(script=parse_moves("2@0s-60s")) as latero,
        open_latero(address_of(latero), None) as device,
    ):
        _, events = ticks(device, found=lambda _, events: pressed(events))
        assert len(pressed(events)) == 1


def test_a_client_whose_watchdog_was_killed_stops(latero):
    with open_latero(address_of(latero), None) as device:
        ticks(device)
        os.kill(device.watchdog._process.pid, signal.SIGKILL)
        with pytest.raises(DeviceError, match="watchdog"):
            ticks(device, found=lambda *_: False)
        device.write(FELT)  # a loop fades by frames
    assert latero.board.at_rest
    assert not latero.board.powered


def test_a_latero_that_is_away_comes_back():
    with simulated() as latero:
        port = latero._socket.getsockname()[1]
        device = open_latero(address_of(latero), None)
        ticks(device)
    with device:
        ticks(device, found=lambda _, events: any(isinstance(one, Silent) for one in events))
        assert device.read() is None
        with simulated(port=port):
            ticks(device, found=lambda _, events: Back() in events)
            until(lambda: ticks(device, seconds=0.01) and device.taking)
            assert device.counts()["reconnections"] >= 1


def test_two_programs_on_one_latero(latero):
    with (
        open_latero(address_of(latero), None),
        pytest.raises(DeviceError, match="another program on this computer"),
    ):
        open_latero(address_of(latero), None, pause=lambda _: None)
    open_latero(address_of(latero), None).close()


class Peer:
    """A peer at a port that answers with what a function makes of a request."""

    def __init__(self, make):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.setblocking(False)
        self._make = make

    @property
    def address(self):
        return "127.0.0.1:{1}".format(*self.socket.getsockname())

    def pause(self, _seconds):
        """What a client does while it waits: here the peer answers."""
        try:
            while True:
                request, client = self.socket.recvfrom(2048)
                answer = self._make(request)
                if answer is not None:
                    self.socket.sendto(answer, client)
        except BlockingIOError:
            pass


def without_interface(request):
    board = LateroBoard()
    board.interface = False
    return board.receive(request)


def of_another_version(request):
    answer = LateroBoard().receive(request)
    return answer[:1] + b"\x21" + answer[2:]


def without_numbers(request):
    answer = LateroBoard().receive(request)
    return answer[:3] + b"\x80\x00" + answer[5:]


@pytest.mark.parametrize(
    ("make", "why"),
    [
        (lambda _: None, "no Latero answers at 127.0.0.1"),
        (lambda request: request, "is no Latero"),
        (lambda _: b"SSH-2.0-OpenSSH_9.2", "is no Latero"),
        (of_another_version, "another version of its protocol than 1.1"),
        (without_numbers, "does not repeat the numbers"),
        (without_interface, "I/O interface .* is unplugged or has no power"),
    ],
    ids=["nobody", "an echo", "another service", "another version", "no numbers", "no interface"],
)
def test_who_else_may_answer_is_said_in_a_sentence(make, why):
    peer = Peer(make)
    now_ns = [0]

    def pause(seconds):
        now_ns[0] += round(seconds * 1e9)
        peer.pause(seconds)

    with pytest.raises(DeviceError, match=why):
        open_latero(peer.address, None, now_ns=lambda: now_ns[0], pause=pause)
    peer.socket.close()


def test_a_host_that_is_none():
    with pytest.raises(InputError, match=r"there is no host nowhere\.invalid"):
        open_latero("nowhere.invalid", None)


def test_a_rate_at_which_the_watchdog_would_act_is_refused(latero):
    with pytest.raises(InputError, match="40 or more"):
        open_latero(address_of(latero), replace(DISPLAY, rate_hz=30.0))
