"""Workers: every task once, by any of them, and what goes wrong in one sentence."""

import multiprocessing
import os
import signal
import subprocess
import sys

import pytest

from tests.tiers import heavy
from vbraille.errors import InputError, VbrailleError
from vbraille.forecast.workers import Workers


def doubled(task):
    if task == 13:
        raise InputError("13 cannot be doubled; give another")
    return 2 * task


def ended(task):
    if task == 2:
        os.kill(os.getpid(), signal.SIGKILL)
    return task


def all_done(workers, tasks, function=doubled):
    found = {}
    workers.work(function, tasks, lambda number, result: found.setdefault(number, result))
    return found


def test_one_worker_does_each_task_in_its_order():
    found = all_done(Workers(), [5, 6, 7])
    assert list(found.items()) == [(0, 10), (1, 12), (2, 14)]
    assert all_done(Workers(), []) == {}


def test_more_workers_do_each_task_once():
    assert all_done(Workers(2), list(range(7))) == {number: 2 * number for number in range(7)}
    with pytest.raises(InputError, match="13 cannot be doubled"):
        all_done(Workers(2), [12, 13])
    with pytest.raises(VbrailleError, match="a worker was ended from outside after"):
        all_done(Workers(2), [1, 2], ended)


class Stop(BaseException):
    """What a signal raises in the middle of the work."""


def test_work_that_is_stopped_waits_for_no_worker(tmp_path):
    found = []

    def stop(number, _result):
        found.append(number)
        raise Stop

    with pytest.raises(Stop):
        Workers(2).work(lasting, [tmp_path / "first"] * 40, stop)
    assert len(found) == 1
    assert not multiprocessing.active_children()


def lasting(path):
    """The one that makes the file is done at once; the others would take an hour."""
    try:
        path.touch(exist_ok=False)
    except FileExistsError:
        signal.sigtimedwait([], 3600)


@heavy
def test_workers_end_with_the_process_that_they_work_for():
    run = subprocess.Popen([sys.executable, "-c", _BEGUN], stdout=subprocess.PIPE, text=True)
    try:
        workers = {int(run.stdout.readline()) for _ in range(2)}
    finally:
        run.kill()
        run.wait()
    # The pipe is theirs too, so that it ends with the last of them.
    assert run.stdout.read() == ""
    run.stdout.close()
    assert len(workers) == 2


_BEGUN = """
import os
from vbraille.forecast.workers import Workers
def said(task):
    os.write(1, f"{os.getpid()}{os.linesep}".encode())
    while True:
        os.sched_yield()
Workers(2).work(said, [1, 2], lambda *_: None)
"""


@pytest.mark.parametrize("number", [0, -1, 257])
def test_numbers_of_workers_are_checked(number):
    with pytest.raises(InputError, match=f"is {number}; it must be 1 to 256"):
        Workers(number)
