"""The simulated Latero, held against a client that was written from the protocol's table alone."""

import socket
import struct
import time

import numpy as np
import pytest

from tests.devices.latero.peers import simulated, until
from tests.tiers import by_tier
from vbraille.carriers import latero as arms
from vbraille.errors import InputError
from vbraille.simulation.controls import parse_moves
from vbraille.simulation.laterosim import OFFSETS, LateroCarriage, LateroSimulator
from vbraille.simulation.specs import parse_hand

PATIENCE_S = 20.0


class TableClient:
    """A client as the table of the protocol has it: it numbers nothing, and waits for answers."""

    def __init__(self, port):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.settimeout(PATIENCE_S)
        self.server = "127.0.0.1", port

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def exchange(self, body, kind, sequence=0):
        request = struct.pack(">BBBH", 0xCA, 0x11, kind, sequence) + body
        self.socket.sendto(request.ljust(100, b"\xff"), self.server)
        return self.socket.recvfrom(100)[0]

    def full(self, blades, dio_out=0x1000, sequence=0):
        body = struct.pack(">5H", dio_out, 0, 0, 0, 0) + bytes(blades)
        return struct.unpack(">BBBHHHH4I4H", self.exchange(body, 0x01, sequence))

    def raw(self, command, address, value=0):
        body = struct.pack(">BHH", command, address, value)
        return struct.unpack(">BBBHBHH", self.exchange(body, 0x03))


@pytest.fixture
def latero():
    with simulated() as latero:
        yield latero


@pytest.fixture
def client(latero):
    with TableClient(latero._socket.getsockname()[1]) as client:
        yield client


def test_every_frame_of_a_known_ramp_is_answered_and_shown(latero, client):
    for k in range(by_tier(200, 20_000, 20_000)):
        ramp = [(i + k) % 151 for i in range(64)]
        magic, version, kind, sequence, *_ = client.full(ramp, sequence=k & 0xFFFF)
        assert (magic, version, sequence) == (0xCA, 0x11, k & 0xFFFF)
        assert kind in (0x81, 0x82)
        assert latero.board.levels.tolist() == ramp
    assert latero.board.beyond == latero.board.foreign == 0


def test_what_the_authors_client_starts_with_is_answered(latero, client):
    answer = client.full([0x80] * 64)
    dio_in, controller, interface, *encoders = answer[4:11]
    assert dio_in == 0x0060
    assert controller & 0x0006 == 0x0004
    assert interface != 0
    assert latero.board.levels.tolist() == [0x80] * 64
    assert arms.pose_at(*arms.joints_of(encoders, OFFSETS)) == pytest.approx(arms.RESET, abs=0.5)


def test_the_authors_reset_finds_the_same_offsets():
    carriage = LateroCarriage(parse_hand("sweep:60"))
    for found, offset in zip(arms.offsets_at(carriage.encoders(0)), OFFSETS, strict=True):
        assert (found - offset + 1) % 2**32 <= 2


def test_motor_power_is_switched_by_a_register(latero, client):
    status = client.full([150] * 64)[5]
    assert client.raw(0x11, 0x00)[6] & ~1 == status & ~1
    client.raw(0x12, 0x00, 0x0002)
    assert not latero.board.powered
    assert client.full([150] * 64)[5] & 0x0006 == 0x0002
    client.raw(0x12, 0x00, 0x0004)
    assert latero.board.powered


def test_io_sets_no_blades(latero, client):
    client.full([0] * 64)
    answer = client.exchange(struct.pack(">5H", 0x2000, 0, 0, 0, 0), 0x02)
    assert len(answer) == 35
    assert latero.board.levels.tolist() == [0] * 64


def test_it_has_no_watchdog(latero, client):
    client.full([0] * 64)
    time.sleep(0.12)
    assert latero.board.levels.tolist() == [0] * 64
    assert latero.board.powered


def test_it_answers_whoever_asks(latero, client):
    with TableClient(latero._socket.getsockname()[1]) as other:
        client.full([0] * 64)
        other.full([150] * 64)
        assert latero.board.at_rest
        client.full([0] * 64)
        assert not latero.board.at_rest


def test_what_is_no_request_is_not_answered(latero, client):
    for nonsense in (b"", b"hello", b"\xca" * 100, struct.pack(">BBB", 0xCA, 0x12, 1) + bytes(97)):
        client.socket.sendto(nonsense, client.server)
    until(lambda: latero.board.foreign == 4)
    assert client.full([150] * 64)[0] == 0xCA


def test_its_buttons_are_low_while_they_are_pressed():
    with (
        simulated(script=parse_moves("1@0s-60s")) as latero,
        TableClient(latero._socket.getsockname()[1]) as client,
    ):
        until(lambda: client.full([150] * 64)[4] == 0x0020)


def test_a_script_and_keys_press_its_buttons():
    keys = iter([["2"], ["3"]])
    said = []
    with (
        simulated(
            script=parse_moves("1@0s-60s,2@0s-60s"),
            keys=lambda: next(keys, []),
            say=said.append,
        ) as latero,
        TableClient(latero._socket.getsockname()[1]) as client,
    ):
        until(lambda: client.full([150] * 64)[4] == 0x0000)
        until(lambda: said[-1:] == ["button 2: pressed"])
    assert [line for line in said if line.startswith("button")] == ["button 2: pressed"]


def test_the_hand_reads_along_each_line_and_then_down():
    carriage = LateroCarriage(parse_hand("sweep:200"), lines=3)
    assert carriage.at(0) == pytest.approx((0, 217.5, 0))
    assert carriage.at(5_000_000_000) == pytest.approx((0, 217.5, 0))  # it has not set out
    carriage.set_out()
    poses = np.array([carriage.at(1_000_000 * ms) for ms in range(5000, 17_000, 10)])
    x_mm, y_mm, _ = poses.T
    assert x_mm.min() == 0
    assert x_mm.max() == pytest.approx(281, abs=2)
    reading = y_mm[(x_mm > 100) & (x_mm < 200)]
    assert set(np.round(reading)) == {5, 15, 25}
    assert np.abs(np.diff(x_mm)).max() < 3
    carriage.go_back(17_000_000_000)
    assert carriage.at(19_000_000_000) == pytest.approx((0, 217.5, 0))


def test_a_port_that_is_taken_is_said_in_a_sentence(latero):
    port = latero._socket.getsockname()[1]
    with pytest.raises(InputError, match="choose another port"):
        LateroSimulator(LateroCarriage(parse_hand("slow")), say=print, port=port)
