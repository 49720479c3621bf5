"""Workers: every task once, whoever does it, and what goes wrong in one sentence."""

import multiprocessing
import os
import re
import signal
import subprocess
import sys
from importlib.util import find_spec

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


def slow(task):
    import time

    time.sleep(0.05)
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
    """Whoever makes the file is done at once; the others would take an hour."""
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


@heavy
def test_a_cluster_does_each_task_once_and_its_end_is_said():
    pytest.importorskip("distributed")
    cluster = subprocess.Popen(
        [sys.executable, "-c", _CLUSTER], stdout=subprocess.PIPE, text=True, start_new_session=True
    )
    try:
        address = cluster.stdout.readline().strip()
        workers = Workers(cluster=address)
        assert all_done(workers, list(range(7))) == {number: 2 * number for number in range(7)}
        found = []

        def done(number, _result):
            found.append(number)
            if len(found) == 5:
                os.killpg(cluster.pid, signal.SIGKILL)

        with pytest.raises(VbrailleError, match=r"went away after [0-9]+ of 400 tasks"):
            workers.work(slow, list(range(400)), done)
        assert 5 <= len(found) < 400
        with pytest.raises(VbrailleError, match="no cluster answers at"):
            all_done(workers, [1, 2])
    finally:
        cluster.kill()
        cluster.wait()
        cluster.stdout.close()


_CLUSTER = """
from distributed import LocalCluster
if __name__ == "__main__":
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        print(cluster.scheduler_address, flush=True)
        cluster.sync(__import__("asyncio").sleep, 120)
"""


@pytest.mark.parametrize("number", [0, -1, 257])
def test_numbers_of_workers_are_checked(number):
    with pytest.raises(InputError, match=f"is {number}; it must be 1 to 256"):
        Workers(number)


@pytest.mark.parametrize("address", ["nowhere", "tcp://", "http://lab:8786", "lab:", "a b:1", ""])
def test_an_address_is_checked(address):
    with pytest.raises(InputError, match=f"is {re.escape(repr(address))}, which is no address"):
        Workers(cluster=address)


@pytest.mark.skipif(find_spec("distributed") is not None, reason="distributed is installed")
def test_a_cluster_needs_distributed():
    with pytest.raises(InputError, match="needs distributed; pip install"):
        Workers(cluster="tcp://lab:8786")
