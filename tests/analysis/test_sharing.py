"""Work that processes share: the results of one process, in its order, and its errors."""

import os
import subprocess
import sys

import pytest

from vbraille.analysis import sharing
from vbraille.errors import InputError

ITEMS = list(range(7))


def squared(number):
    if number < 0:
        raise InputError(f"{number} is below 0; give another")
    return number**2, os.getpid()


def lost(number):
    """Square of a number, of which no process but the first one comes back."""
    if os.getpid() != int(os.environ["FIRST"]):
        os._exit(1)
    return number**2


@pytest.fixture(autouse=True)
def two(monkeypatch):
    monkeypatch.setattr(sharing, "_processes", lambda: 2)


def test_results_are_in_order_and_made_by_other_processes():
    found = list(sharing.shared(squared, ITEMS))
    assert [square for square, _ in found] == [n**2 for n in ITEMS]
    assert os.getpid() not in {process for _, process in found}


def test_few_are_done_here():
    assert list(sharing.shared(squared, ITEMS[:3])) == [(n**2, os.getpid()) for n in ITEMS[:3]]


def test_an_error_is_the_one_of_the_item():
    found = sharing.shared(squared, [0, 1, -2, 3])
    assert [next(found)[0], next(found)[0]] == [0, 1]
    with pytest.raises(InputError, match="-2 is below 0; give another"):
        next(found)


def test_a_process_that_is_lost_costs_no_result(monkeypatch):
    monkeypatch.setenv("FIRST", str(os.getpid()))
    assert list(sharing.shared(lost, ITEMS)) == [n**2 for n in ITEMS]


def test_beside_other_threads_no_process_is_begun():
    code = (
        "import threading; from vbraille.analysis.sharing import _processes; "
        "ended = threading.Event(); threading.Thread(target=ended.wait).start(); "
        "print(_processes()); ended.set()"
    )
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert told.stdout == "1\n"
