"""Devices on real pseudo-terminals and sockets."""

import os
import socket
import threading
import time
from itertools import pairwise

import numpy as np
import pytest

from vbraille.devices import open_device
from vbraille.devices.events import Back, Button, Knob, Unplugged
from vbraille.devices.line import Line, parse_address
from vbraille.engine.checkup import taking_parts
from vbraille.errors import DeviceError, InputError
from vbraille.render import MODELS
from vbraille.simulation.controller import Controller, info_of
from vbraille.simulation.pty import Port
from vbraille.simulation.simulator import Faults, Simulator
from vbraille.simulation.specs import parse_hand
from vbraille.testing import simulated_controller

VBD = MODELS["vbd"].display


def drive(device, seconds, until=lambda: False):
    """Read and write as a loop does; give the poses."""
    poses, frame = [], np.full(device.display.shape, 0.5)
    end_s = time.monotonic() + seconds
    while time.monotonic() < end_s and not until():
        if (pose := device.read()) is not None:
            poses.append(pose)
        device.write(frame)
        time.sleep(0.001)
    return poses


def test_a_controller_is_found_and_read_and_takes_frames():
    with simulated_controller(VBD) as spec, open_device(spec, None) as device:
        assert device.display.shape == VBD.shape
        assert device.display.rest_side == VBD.rest_side
        poses = drive(device, 0.2)
        poses += drive(device, 8, lambda: device.taking and device.acknowledged_ns is not None)
        assert device.acknowledged_ns is not None
        assert poses[0].x_mm == pytest.approx(
            -VBD.span_mm / 2, abs=0.5
        )  # it sets out from the stop
        assert all(after.time_ns > before.time_ns for before, after in pairwise(poses))


def test_buttons_and_knobs_of_a_controller_move_when_they_are_to():
    moved = []
    with (
        simulated_controller(VBD, press="2@0.5s-60s, knob 1 1@0.5s") as spec,
        open_device(spec, None) as device,
    ):

        def both():
            moved.extend(device.take_events())
            pressed = any(isinstance(each, Button) and each.number == 2 for each in moved)
            return pressed and any(isinstance(each, Knob) and each.value == 1 for each in moved)

        drive(device, 8, both)
        assert both()


def test_a_board_that_starts_when_its_port_is_opened_is_waited_for():
    with simulated_controller(VBD, faults=Faults(boot_s=1.5)) as spec:
        with open_device(spec, None) as device:
            assert device.display.name == VBD.name
        time.sleep(0.3)  # the board is to find that its port was closed
        begun_s = time.monotonic()
        with pytest.raises(DeviceError, match="boot=SECONDS"):
            open_device(f"{spec}?boot=0.6", None)
        assert time.monotonic() - begun_s < 1.4


def test_a_device_that_is_unplugged_is_found_again(tmp_path):
    port = Port(str(tmp_path / "port"))
    simulator = Simulator(
        VBD, parse_hand("sweep:60"), port, say=lambda _: None, faults=Faults(unplug_every_s=0.6)
    )
    stopped = threading.Event()
    thread = threading.Thread(target=simulator.run, args=(stopped.is_set,), daemon=True)
    thread.start()
    try:
        with open_device(f"serial:{tmp_path / 'port'}", None) as device:
            events = []

            def is_back():
                events.extend(device.take_events())
                return any(isinstance(event, Back) for event in events)

            drive(device, 5, is_back)
            assert any(isinstance(event, Unplugged) for event in events)
            assert is_back()
            drive(device, 2, lambda: device.taking)
            assert device.taking
            assert device.rested >= 1
    finally:
        stopped.set()
        thread.join()
        port.unplug()


class SilentThenWell(threading.Thread):
    """A device on a socket whose first connection falls silent."""

    def __init__(self):
        super().__init__(daemon=True)
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.connections = 0
        self.silent = threading.Event()

    def run(self):
        while True:
            try:
                link, _ = self.listener.accept()
            except OSError:
                return
            self.connections += 1
            threading.Thread(target=self.serve, args=(link, self.connections), daemon=True).start()

    def serve(self, link, number):
        with link:
            self.talk(link, number)

    def talk(self, link, number):
        controller = Controller(info_of(VBD))
        link.settimeout(0.001)
        begun = time.monotonic()
        while True:
            try:
                chunk = link.recv(4096)
                if not chunk:
                    return
                controller.receive(chunk)
            except TimeoutError:
                pass
            except OSError:
                return
            line = controller.tick(round((time.monotonic() - begun) * 1e6))
            if line and not (number == 1 and self.silent.is_set()):
                link.sendall(line)


def test_a_socket_that_falls_silent_is_opened_again():
    server = SilentThenWell()
    server.start()
    with open_device(f"serial:socket://127.0.0.1:{server.port}", None) as device:
        drive(device, 2, lambda: device.taking)
        server.silent.set()
        drive(device, 5, lambda: server.connections > 1 and device.taking)
        assert server.connections == 2
        assert device.taking
    server.listener.close()


def test_a_port_that_may_not_be_opened_names_its_own_group(monkeypatch):
    import grp

    master, slave = os.openpty()
    path = os.ttyname(slave)

    def refused(*_, **__):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("serial.Serial", refused)
    monkeypatch.setattr("grp.getgrgid", lambda _: grp.struct_group(("uucp", "x", 14, [])))
    with pytest.raises(DeviceError, match=r"group uucp .*usermod -aG uucp"):
        Line(parse_address(path))
    os.close(master)
    os.close(slave)


@pytest.mark.parametrize(
    "address",
    [
        "", "/dev/no-such-port", "/tmp", "socket://", "socket://a", "http://a:1",
        "/dev/null?baud=x",
        "/dev/null?baud=1",
        "/dev/null?boot=-1", "/dev/null?bauds=9600", "socket://no.invalid:1",
    ],
)  # fmt: skip
def test_an_address_that_cannot_be_is_refused_by_one_sentence(address):
    with pytest.raises((InputError, DeviceError)) as caught:
        open_device(f"serial:{address}", None)
    assert "\n" not in str(caught.value)


def test_a_port_has_one_user():
    with (
        simulated_controller(VBD) as spec,
        open_device(spec, None),
        pytest.raises(DeviceError, match="busy"),
    ):
        open_device(spec, None)


def test_a_message_that_the_line_cuts_is_finished_first():
    here, there = socket.socketpair()
    listener = socket.create_server(("127.0.0.1", 0))
    line = Line(parse_address(f"socket://127.0.0.1:{listener.getsockname()[1]}"))
    link, _ = listener.accept()
    messages = [bytes([65 + n]) * 20 + b"\0" for n in range(6)]
    with taking_parts():
        taken = [line.write(message) for message in messages]
    line.write(b"")
    line.close()
    link.settimeout(1)
    got = b""
    while chunk := link.recv(4096):
        got += chunk
    assert got == b"".join(message for message, sent in zip(messages, taken, strict=True) if sent)
    for each in (here, there, listener, link):
        each.close()
