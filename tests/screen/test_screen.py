"""``vbraille screen`` with a real BRLTTY: what a program writes is under the hand."""

import socket
import stat
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.screen.brltty import Brltty, decoded, shown
from tests.tiers import by_tier
from vbraille.errors import InputError
from vbraille.reading.brltty import Port, Talk
from vbraille.reading.commands import bindings
from vbraille.reading.screen import Screen
from vbraille.render import STRESS2

pytestmark = pytest.mark.new_processes
WORDS = "hello"
MASKS = [19, 17, 7, 7, 21]
FLAT = {"texture": 0.0}  # so that a raised dot is one deflection


def model(rows=0):
    """A display of one axis, or with room for lines."""
    style = STRESS2.style.replace(**FLAT)
    height_mm = (rows + 0.5) * style.geometry.line_pitch_mm if rows else 0.0
    return replace(STRESS2, style=style, display=replace(STRESS2.display, height_mm=height_mm))


def test_lines_of_brltty_are_cells_and_print():
    said = []
    talk = Talk(2, 3, said.append)
    assert talk.hello == "Cells 3 2"
    talk.feed(b'Visual "a\\"')
    talk.feed('é\\\\ef"\r\nBraille "1|12| |12345678| |14"\nCSRROW 5\n'.encode())
    assert talk.masks.tolist() == [[1, 3, 0], [255, 0, 9]]
    assert talk.text == 'a"é\\ef'
    assert not said


def test_lines_that_are_not_as_they_should_be_are_said_once_and_survived():
    said = []
    talk = Talk(1, 4, said.append)
    for line in (b"\xff\xfe\n", b'Braille "9"\n', b'Braille "1', b"x" * 3_000_000, b"\n", b"\n\n"):
        talk.feed(line)
        talk.feed(line)
    assert said
    assert len(set(said)) == len(said)
    before = len(said)
    talk.feed(b'Braille "1|2"\n' * 2 + b'Braille "1|2|3|4|5|6"\n')
    assert talk.masks.tolist() == [[1, 2, 4, 8]]
    assert len(said) == before + 1
    talk.feed(b'Braille "1|2|3"\nBraille "9"\n')
    assert talk.masks.tolist() == [[1, 2, 4, 8]]  # the last one counts


def test_a_line_is_felt_as_a_program_writes_it_and_keys_reach_the_program(tmp_path):
    here = model()
    with shown(tmp_path, here) as screen, Brltty(tmp_path, tmp_path / "socket") as brltty:
        client = screen.written_by(brltty)
        assert client.displaySize == (26, 1)
        client.writeText(WORDS)
        screen.until(lambda: screen.screen.text == WORDS)
        assert decoded(screen.felt(here), here, len(MASKS)) == MASKS
        screen.until(lambda: (WORDS, [*MASKS, *[0] * 21]) in screen.heard.shown)

        asked = []  # by the hand, too, that is back from the end

        def arguments():
            asked.append(client.readKeyWithTimeout(0))
            return [client.expandKeyCode(key)["argument"] for key in asked if key]

        screen.screen.route(3)
        screen.until(lambda: 3 in arguments())
        # A hand that was at the end and is back goes on to the right.
        sent = []
        screen.screen.send = sent.append
        screen.screen.steer()
        screen.until(lambda: sent)
        assert sent[0] == "FWINRT"
        client.leaveTtyMode()


def test_rows_of_brltty_are_lines_of_the_page(tmp_path):
    here = model(rows=3)
    with shown(tmp_path, here) as screen, Brltty(tmp_path, tmp_path / "socket") as brltty:
        client = screen.written_by(brltty)
        assert client.displaySize == (26, 3)
        client.writeText("hello".ljust(26) + "leh".ljust(26) + "oe")
        screen.until(lambda: screen.screen.talk.text.startswith("hello"))
        ticks = screen.felt(here, rows=3)
        for row, masks in enumerate((MASKS, [7, 17, 19, 0], [21, 17, 0])):
            assert decoded(ticks, here, len(masks), row) == masks
        client.leaveTtyMode()


def test_brltty_is_killed_and_comes_again(tmp_path):
    with shown(tmp_path, model(), hand="sweep:60") as screen:
        for time_ in range(by_tier(2, 20, 20)):
            with Brltty(tmp_path, tmp_path / "socket") as brltty:
                client = screen.written_by(brltty)
                client.writeText(f"time {time_}")
                screen.until(lambda time_=time_: screen.screen.text == f"time {time_}")
            screen.until(lambda: not screen.port.connected)
            screen.until(lambda: not screen.screen.line_masks.any())
            screen.until(lambda: not screen.device.engine.newest["frame"].any())  # at rest
        assert screen.heard.said.count("BRLTTY: connected") >= by_tier(2, 20, 20)


class Still:
    """A device of which only what is put is known, with the finger on the second cell."""

    x_mm = 12.0

    def __init__(self, model):
        self.display, self.paused, self.put_so_far = model.display, False, []

    def put(self, program, number):
        self.put_so_far.append((program, number))

    def give(self, order):
        pass


class Unattached:
    also = ()


@pytest.fixture
def alone(tmp_path):
    """A screen without an engine, and the end of a socket that is BRLTTY's."""
    port = Port(str(tmp_path / "socket"))
    device, heard = Still(model()), []
    screen = Screen(port, device, [], model().style, Unattached())
    screen.say = lambda sentence, cue=None: heard.append(sentence)  # noqa: ARG005
    with socket.socket(socket.AF_UNIX) as brltty:
        brltty.connect(str(tmp_path / "socket"))
        screen.idle(1.0)
        assert brltty.recv(100) == b"Cells 26 1\n"
        yield screen, device, brltty, heard
    port.close()


def test_a_flood_costs_one_change_and_the_last_one_counts(alone):
    screen, device, brltty, _ = alone
    before = len(device.put_so_far)
    brltty.sendall(b"".join(f'Braille "{n % 8 + 1}|1"\n'.encode() for n in range(1000)))
    begun_s = time.process_time()
    screen.idle(2.0)
    assert time.process_time() - begun_s < 0.5
    assert screen.line_masks[:2].tolist() == [128, 1]
    assert len(device.put_so_far) == before + 1
    brltty.send(b'Braille "2"\n')
    screen.idle(2.001)  # too soon: it waits, and is not lost
    assert len(device.put_so_far) == before + 1
    screen.idle(2.1)
    assert screen.line_masks[0] == 2


def test_cells_that_stay_are_felt_as_before(alone):
    screen, device, brltty, _ = alone
    x_mm = np.arange(-5.0, 60.0, 0.1)
    felt = []
    for n, cells in enumerate((b"125|15|123", b"125|15|123456")):
        brltty.send(b'Braille "' + cells + b'"\n')
        screen.idle(3.0 + n)
        felt.append(device.put_so_far[-1][0].path(x_mm))
    changed = x_mm[(felt[0] != felt[1]).any((1, 2))]
    pitch_mm, half_mm = STRESS2.style.geometry.cell_pitch_mm, STRESS2.display.span_mm / 2
    assert changed.min() > 2 * pitch_mm - half_mm - 1  # the third cell alone


def test_what_six_dots_cannot_show_is_said_once(alone):
    screen, _, brltty, heard = alone
    for n in range(3):
        brltty.send(f'Braille "78|{n + 1}"\n'.encode())
        screen.idle(4.0 + n)
    assert sum("dots 7 and 8" in sentence for sentence in heard) == 1


def test_each_key_asks_for_what_brltty_knows_and_finger_routes(alone):
    screen, device, brltty, heard = alone
    keys = bindings("usual", screen.where)
    keys["n"].run(screen)
    assert brltty.recv(100) == b"LNDN\n"
    keys["i"].run(screen)
    assert brltty.recv(100) == b"INFO\n"
    keys["enter"].run(screen)
    assert brltty.recv(100) == b"ROUTE 1\n"
    device.x_mm = None
    keys["enter"].run(screen)
    assert "no cell" in heard[-1]
    screen.route(0)
    assert "first" in heard[-1]


def test_keys_change_how_the_screen_feels(alone):
    screen, device, brltty, heard = alone
    brltty.send(b'Braille "125|15|123"\n')
    screen.idle(5.0)
    x_mm = np.arange(0.0, 30.0, 0.1)
    flat = device.put_so_far[-1][0].path(x_mm)
    for _ in range(5):
        bindings("usual", screen.where)["t"].run(screen)
    assert "texture" in heard[-1]
    textured = device.put_so_far[-1][0].path(x_mm)
    assert np.abs(np.diff(textured, axis=0)).sum() > 1.05 * np.abs(np.diff(flat, axis=0)).sum()


def test_a_socket_is_its_users_own_and_one_that_is_left_over_is_taken(tmp_path):
    place = str(tmp_path / "socket")
    port = Port(place)
    assert stat.S_IMODE(Path(place).stat().st_mode) == 0o600
    with pytest.raises(InputError, match="cannot be listened at"):
        Port(place)
    port._listening.close()  # as a killed program leaves it
    Port(place).close()
    assert not Path(place).exists()
    for wrong in ("nowhere", "host:port", str(tmp_path / "none" / "socket"), "127.0.0.1:70000"):
        with pytest.raises(InputError):
            Port(wrong)


def test_a_brltty_that_listens_is_connected_to():
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = Port(f"127.0.0.1:{server.getsockname()[1]}", connects=True)
        assert port.meet()
        accepted, _ = server.accept()
        with accepted:
            port.send("Cells 2 1")
            assert accepted.recv(100) == b"Cells 2 1\n"
            accepted.send(b'Braille "1"\n')
            time.sleep(0.05)
            assert port.take() == b'Braille "1"\n'
        time.sleep(0.05)
        port.take()
        assert not port.connected
        port.close()
