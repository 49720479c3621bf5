"""A braille display of HID: the reading end over a pair of sockets that keep reports apart."""

import os
import socket
from pathlib import Path

import pytest

from tests.conventional.hiddescriptors import MOUSE, NUMBERED
from vbraille.conventional.driver import DisplayGoneError
from vbraille.conventional.hid import DESCRIPTOR, NAME, SIZE, HidDisplay, asked, open_hid
from vbraille.conventional.hidbraille import braille_of
from vbraille.conventional.messages import DisplayStands, KeyPressed

PATH = "/dev/hidraw0"
GONE = f"the braille display at {PATH} is gone; plug it in again"


@pytest.fixture
def ends():
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    ours.setblocking(False)
    display = HidDisplay(ours.detach(), braille_of(NUMBERED), "Made of values", PATH)
    with theirs:
        yield display, theirs
    display.close()


def test_cells_go_to_it_and_a_key_is_told_once_when_it_is_pressed(ends):
    display, device = ends
    assert display.check() == DisplayStands("HID", "Made of values", 40, 1)
    display.write(b"\x01\x02")
    assert device.recv(100) == b"\x03\x01\x02" + bytes(38)
    assert display.pressed() == []
    device.send(bytes.fromhex("010002"))
    device.send(bytes.fromhex("020400000000"))
    device.send(bytes.fromhex("010003"))  # the first is still down
    display.check()  # which loses none
    assert display.pressed() == [KeyPressed("FWINRT"), KeyPressed("ROUTE", 2), KeyPressed("FWINLT")]
    device.send(bytes.fromhex("010000"))
    device.send(bytes.fromhex("010002"))
    assert display.pressed() == [KeyPressed("FWINRT")]


def test_one_that_is_unplugged_says_so_whatever_is_done_next(ends):
    display, device = ends
    device.close()
    for does in (display.pressed, display.check, lambda: display.write(b"")):
        with pytest.raises(DisplayGoneError) as raised:
            does()
        assert str(raised.value) == GONE


def test_the_file_is_closed_once(ends):
    display, _ = ends
    display.close()
    other = os.open(os.devnull, os.O_RDONLY)  # which takes its number
    display.close()
    os.close(other)


def test_what_is_not_there_or_another_thing(tmp_path):
    with pytest.raises(DisplayGoneError) as raised:
        open_hid(str(tmp_path / "hidraw0"))
    assert str(raised.value) == (
        f"there is no HID device {tmp_path}/hidraw0; plug the display in, or give its path"
    )
    with pytest.raises(DisplayGoneError) as raised:
        open_hid(os.devnull)
    assert str(raised.value) == f"{os.devnull} is no HID device; give the path of the display"


def test_the_kernel_is_asked_with_room_for_any_descriptor():
    with Path(os.devnull).open("rb") as file:
        for question, size in ((SIZE, 4), (DESCRIPTOR, 4100), (NAME, 256)):
            with pytest.raises(OSError, match="Inappropriate ioctl"):
                asked(file.fileno(), question, bytes(size))


def test_the_first_braille_display_that_the_system_describes_is_opened(tmp_path):
    for name, descriptor in (("hidraw2", MOUSE), ("hidraw10", NUMBERED), ("hidraw9", MOUSE)):
        (tmp_path / name / "device").mkdir(parents=True)
        (tmp_path / name / "device" / "report_descriptor").write_bytes(descriptor)
    with pytest.raises(DisplayGoneError, match="/dev/hidraw10"):
        open_hid(devices=tmp_path)
    with pytest.raises(DisplayGoneError) as raised:
        open_hid(devices=tmp_path / "hidraw2")
    assert str(raised.value) == (
        "there is no braille display of HID; plug one in, or give its path, as in hid:/dev/hidraw0"
    )
