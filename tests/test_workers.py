"""Processes of our own beside a program: never waited for, and gone with their parent."""

import os
import select
import signal
import subprocess
import sys
import time

import pytest

from vbraille.workers import Incoming, Outgoing, Worker

PATIENCE_S = 30.0


@pytest.fixture
def worker():
    with Worker("tests.echoing", tells=str) as worker:
        yield worker


def heard(worker, number):
    """So many messages of a worker."""
    told, end_s = [], time.monotonic() + PATIENCE_S
    while len(told) < number:
        select.select([worker.descriptor], [], [], 0.01)  # what is to be sent may wait, too
        told += worker.receive()
        assert not worker.ended
        assert time.monotonic() < end_s, told
    return told


def test_messages_of_any_size_come_whole_and_in_their_order(worker):
    sent = ["one", "x" * 1_000_000, "", "two"]
    for message in sent:
        assert worker.send(message)
    assert heard(worker, 4) == sent


def test_what_it_prints_is_no_message(capfd):
    with Worker("tests.echoing", tells=str) as worker:
        worker.send("a")
        assert heard(worker, 1) == ["a"]
    assert capfd.readouterr() == ("", "printed\n")
    with Worker("tests.echoing", tells=str, quiet=True) as worker:
        worker.send("a")
        assert heard(worker, 1) == ["a"]
    assert capfd.readouterr() == ("", "")


def test_one_that_reads_nothing_keeps_nobody_waiting_and_hears_the_newest(worker):
    worker.process.send_signal(signal.SIGSTOP)
    for number in range(300):
        assert worker.send(f"{number} " * 500)
    worker.send("newest", alone=True)
    worker.process.send_signal(signal.SIGCONT)
    told = []
    while told[-1:] != ["newest"]:
        told += heard(worker, 1)
    assert 1 < len(told) < 200


def test_one_that_is_gone_is_known_to_be(worker):
    worker.send("a")
    heard(worker, 1)
    worker.process.kill()
    worker.process.wait(PATIENCE_S)
    assert worker.receive() == []
    assert worker.ended
    worker.send("b")
    assert not worker.send("c")


def test_one_that_does_not_end_is_ended():
    worker = Worker("tests.echoing", tells=str)
    worker.send("a")
    heard(worker, 1)
    worker.send("sleep")
    begun_s = time.monotonic()
    worker.close(0.2)
    assert worker.process.returncode == -signal.SIGKILL
    assert time.monotonic() - begun_s < PATIENCE_S
    worker.close()


_PARENT = """
import sys
from vbraille.workers import Worker
worker = Worker("tests.echoing", tells=str)
worker.send("a")
while not worker.receive():
    pass
worker.send("sleep")
print(worker.process.pid, flush=True)
sys.stdin.read()
"""


def test_it_is_gone_with_its_parent_whatever_it_does():
    parent = subprocess.Popen(
        [sys.executable, "-c", _PARENT], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    child = os.pidfd_open(int(parent.stdout.readline()))
    parent.kill()
    parent.communicate()
    assert select.select([child], [], [], PATIENCE_S)[0]
    os.close(child)


def test_a_message_that_comes_in_pieces_is_one():
    read, write = os.pipe()
    middle, through = os.pipe()
    Outgoing(through).put("abc")
    incoming = Incoming(read, str)
    for byte in os.read(middle, 100):
        assert incoming.take() == []
        os.write(write, bytes([byte]))
    assert incoming.take() == ["abc"]
    os.close(write)
    assert incoming.take() == []
    assert incoming.ended
    for descriptor in (read, middle, through):
        os.close(descriptor)


def test_one_whose_parent_was_gone_before_it_could_be_told_ends_at_once():
    left = subprocess.Popen(
        [sys.executable, "-m", "tests.echoing", str(os.getpid() + 1)],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
    )
    with left:
        assert left.wait(PATIENCE_S) == 0  # though its input is still open
