"""The live view's own process, as the program that reads has it: never waited for, never missed."""

import json
import os
import select
import signal
import socket
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from tests.live.canned import canned_state
from tests.live.pages import get, page, parts_of
from tests.live.rings import TestRing, frame_of
from tests.tiers import by_tier
from vbraille.engine.mailbox import Extent
from vbraille.live.channel import MOST_MESSAGE_BYTES, Shares, Tells, encode, open_line, to_server
from vbraille.live.messages import PagePress, Turn
from vbraille.live.monitor import Monitor, has_desktop
from vbraille.simulation.steering import BeAt, Pointer

_MOST_S = 30.0


def until(there):
    """Ask again and again until there is something; for other processes there is no other clock."""
    end_s = time.monotonic() + _MOST_S
    while time.monotonic() < end_s:
        if found := there():
            return found
        select.select([], [], [], 0.002)
    raise AssertionError("it did not come")


def address_of(monitor):
    (said,) = until(monitor.notes)
    assert said.startswith("live view: http://127.0.0.1:"), said
    return said.removeprefix("live view: ")


@pytest.fixture(scope="module")
def pointer():
    return Pointer()


@pytest.fixture(scope="module")
def monitor(pointer):
    with Monitor(pointer=pointer) as running:
        yield running


@pytest.fixture(scope="module")
def address(monitor):
    return address_of(monitor)


def lives(process):
    """Whether a process runs: one that has ended may wait to be asked for its exit code."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def process_of(monitor):
    return monitor._process.pid


def test_frames_of_shared_memory_come_to_two_pages_and_the_descriptor_is_free(monitor, address):
    ring = TestRing()
    descriptor = os.dup(ring.descriptor)
    monitor.share(descriptor, ring.extent)
    os.close(descriptor)
    ring.append(1)
    with page(address) as one, page(address) as other:
        until(lambda: one.frame().header["rows"] and other.frame().header["rows"])
        ring.append(20)
        for opened in (one, other):
            read = opened.frame(row=1, column=0)
            assert read.header["tick"] == 20
            np.testing.assert_array_equal(read.deflections, frame_of(20, (2, 3)))
            np.testing.assert_array_equal(read.samples[:, 1], np.float32(np.arange(1, 21) / 8))
        after = TestRing()  # the host has died, and was started again
        monitor.share(after.descriptor, after.extent)
        after.append(3)
        until(lambda: one.frame().header["tick"] == 2)


def test_the_newest_state_arrives_and_what_pages_ask_for_comes_back(monitor, address):
    with page(address) as opened:
        for number in range(1, 500):
            monitor.tell(canned_state(number))
        until(lambda: monitor.take() or opened.frame().header["state"] == 499)
        assert opened.state["title"] == "a canned text"
        opened.say("press", command="next line")
        opened.say("turn", knob="contrast", value=0.5)
        asked = until(monitor.take)
        asked += [] if len(asked) == 2 else until(monitor.take)
        assert asked == [PagePress("next line"), Turn("contrast", 0.5)]
        assert monitor.take() == []


def test_a_page_is_the_hand_until_it_is_gone(address, pointer):
    with page(address) as opened:
        opened.say("point", x_mm=12.5)
        assert until(pointer.at) == BeAt(12.5)
        opened.connection.socket.shutdown(socket.SHUT_RDWR)
    until(lambda: pointer.at() is None)


def test_the_page_is_served(address):
    assert get(address)[0] in (200, 404)  # without the page's files


@pytest.mark.new_processes
def test_the_process_hears_no_keys_and_is_less_urgent_than_all_else(monitor, address):
    process = process_of(monitor)
    assert os.getpriority(os.PRIO_PROCESS, process) == min(
        os.getpriority(os.PRIO_PROCESS, 0) + 5, 19
    )
    for number in (signal.SIGINT, signal.SIGHUP, signal.SIGTSTP):
        os.kill(process, number)
    assert os.getsid(process) == process
    with page(address) as opened:
        opened.frame()
    assert monitor.notes() == []


def test_nobody_waits_for_a_process_that_stands_still(monitor, address):
    process = process_of(monitor)
    os.kill(process, signal.SIGSTOP)
    try:
        begun_s = time.thread_time()
        for number in range(1000, 1500):
            monitor.tell(canned_state(number, said=["x" * 2000]))
        ring = TestRing()
        monitor.share(ring.descriptor, ring.extent)
        assert (monitor.take(), monitor.notes()) == ([], [])
        assert time.thread_time() - begun_s < 5.0
    finally:
        os.kill(process, signal.SIGCONT)
    with page(address) as opened:
        until(lambda: monitor.take() or opened.frame().header["state"] == 1499)
        ring.append(1)
        until(lambda: opened.frame().header["rows"] == 2)


def test_a_state_too_large_is_told_without_what_is_too_much(monitor, address):
    room = monitor._line.getsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF)
    above, under = canned_state().lines[:2]
    count = room // len(encode(under)) + 1
    with page(address) as opened:

        def told(state):
            monitor.tell(state)
            until(lambda: monitor.take() or opened.frame().header["state"] == state.number)
            return opened.state

        assert told(canned_state(5000, lines=[above] * count + [under]))["lines"] == [
            json.loads(encode(under))
        ]
        for too_much in (
            canned_state(5001, lines=[under] * count),
            canned_state(5002, said=["x" * room]),
        ):
            state = told(too_much)
            assert (state["title"], state["device"]) == (
                "",
                "the page is too large to be shown here",
            )
        assert told(canned_state(5003))["title"] == "a canned text"


def test_what_is_shared_before_the_launch_is_there_and_a_death_is_one_sentence():
    ring = TestRing()
    dying = Monitor()
    dying.share(ring.descriptor, ring.extent)
    dying.tell(canned_state(2))
    ring.append(1)
    with dying:
        with page(address_of(dying)) as opened:
            until(lambda: opened.frame().header["rows"] == 2)
            assert opened.state["number"] == 2
        os.kill(process_of(dying), signal.SIGKILL)
        assert until(dying.notes) == ["live view: ended by a fault; reading goes on"]
        dying.share(ring.descriptor, ring.extent)
        dying.tell(canned_state())
        assert (dying.take(), dying.notes()) == ([], [])


def test_a_port_in_use_is_one_sentence(address):
    port = parts_of(address)[1]
    with Monitor(port=port) as second:
        said = until(second.notes)
        assert said == [f"live view: port {port} is in use; give --port another, or leave it out"]
        until(lambda: not lives(process_of(second)))
        second.tell(canned_state())
        assert (second.take(), second.notes()) == ([], [])


def test_blind_is_a_matter_of_the_server():
    ring = TestRing()
    with Monitor(blind=True, steers=False) as blind:
        address = address_of(blind)
        assert "#" not in address
        blind.share(ring.descriptor, ring.extent)
        blind.tell(canned_state(3))
        ring.append(2)
        with page(address) as opened:
            read = until(lambda: (one := opened.frame()).header["state"] == 3 and one)
            until(lambda: opened.frame().header["tick"] == 1)
            assert read.deflections.size == 0
            assert (opened.state["lines"], opened.state["blind"]) == ([], True)
            opened.say("map")
            assert "stimuli are hidden" in opened.hear()["why"]


_PARENT = """
import sys, time
from vbraille.live.monitor import has_desktop
from vbraille.live.monitor import Monitor
monitor = Monitor()
monitor.launch()
while not (said := monitor.notes()):
    time.sleep(0.01)
print(monitor._process.pid, said[0].rpartition(" ")[2], flush=True)
sys.stdin.read()
"""


@contextmanager
def parent():
    command = [sys.executable, "-c", _PARENT]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        try:
            yield process
        finally:
            process.kill()


def test_the_process_ends_when_its_parent_is_killed():
    with parent() as process:
        assert process.stdout is not None
        server, address = process.stdout.readline().decode().split()
        with page(address) as opened:
            opened.frame()
            process.kill()
            until(lambda: not lives(int(server)))


def test_elsewhere_there_are_two_addresses_and_closing_is_quick():
    closing = Monitor(host="0.0.0.0")
    closing.launch()
    said = []
    until(lambda: said.extend(closing.notes()) or len(said) == 2)
    steering, watching = (sentence.rpartition(" ")[2] for sentence in said)
    assert said == [f"live view: {steering}", f"live view, to watch only: {watching}"]
    for address, steers in ((steering, True), (watching, False)):
        with page(address, greets=False) as opened:
            assert opened.hello(parts_of(address)[2])["steers"] == steers
    with page(steering, greets=False) as opened:
        opened.say("hello")
        assert "token" in opened.hear()["why"]
    with page(watching) as opened:
        opened.frame()
        process = closing._process
        closing.close()
        assert process.returncode == 0  # it did not have to be killed
    closing.close()
    assert closing.notes() == []


def test_a_monitor_that_was_never_launched_leaves_nothing_open():
    ring = TestRing()
    before = len(list(Path("/proc/self/fd").iterdir()))
    never = Monitor()
    never.share(ring.descriptor, ring.extent)
    never.share(ring.descriptor, ring.extent)
    never.close()
    assert len(list(Path("/proc/self/fd").iterdir())) == before


def test_messages_of_the_line_are_what_they_were():
    one, other = open_line()
    with one, other:
        for message in (Shares(Extent(1, 2, 3, 4)), Tells(canned_state())):
            one.send(encode(message))
            assert to_server(other.recv(MOST_MESSAGE_BYTES)) == message


_LOADED = """
import sys
import vbraille.live.monitor
heavy = {"websockets", "PIL", "numba", "llvmlite", "liblouis", "asyncio", "playwright"}
print(*sorted(heavy & set(sys.modules)), sep=",")
import vbraille.live.serving
print(*sorted(heavy & set(sys.modules)), sep=",")
"""


def test_neither_end_loads_what_it_does_not_need():
    command = [sys.executable, "-c", _LOADED]
    said = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    assert said == "\nasyncio,websockets\n"


def test_a_browser_is_opened_for_somebody_at_a_terminal_only(monkeypatch):
    monkeypatch.setenv("DISPLAY", ":0")
    assert not has_desktop()  # tests have no terminal


def test_memory_is_flat_over_many_frames(monitor, address):
    ring = TestRing()
    monitor.share(ring.descriptor, ring.extent)
    ring.append(1)
    statm = Path(f"/proc/{process_of(monitor)}/statm")

    def resident():
        return int(statm.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    with page(address) as opened:
        until(lambda: opened.frame().header["rows"] == 2)

        def pull(count):
            for _ in range(count):
                ring.append(1)
                opened.bytes_of_frame()

        pull(1000)
        before = resident()
        pull(by_tier(2000, 20_000, 200_000))
        assert resident() - before <= 1_000_000
