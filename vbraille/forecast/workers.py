"""Tasks that several processes share, here or on a cluster, with the same results everywhere.

A task says all that its result depends on, its seed among it, and tasks do not depend on how many
processes there are. So one worker and many give the same results. dask is imported only where
there is more than one worker.
"""

from __future__ import annotations

import ctypes
import os
import re
import signal
import warnings
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, TypeVar

from vbraille.errors import InputError, VbrailleError
from vbraille.wording import count, setting

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from concurrent.futures import ProcessPoolExecutor

Task = TypeVar("Task")
Found = TypeVar("Found")

MOST_WORKERS = 256
HOW_TO_GET_DISTRIBUTED = "pip install 'vbraille[cluster]' installs it"
HOW_TO_GET_DASK = "pip install 'vbraille[sweeps]' installs it"
_ADDRESS = re.compile(r"(?:(?:tcp|tls|ws|wss|ucx)://)?(?:[\w.-]+|\[[0-9a-fA-F:]+\]):[0-9]{1,5}")
_PATIENCE_S = 10  # for a cluster to answer
# Turns of a worker: at each it waits until this process, on a busy machine, gives it more.
_TURNS = 16
_MOST_IN_TURN = 8  # tasks; what a worker has done is known at the end of its turn
_PR_SET_PDEATHSIG = 1


@dataclass(frozen=True, slots=True)
class Workers:
    """Who works: so many processes here, or a cluster of dask's.

    Parameters
    ----------
    number
        Number of processes here; with one, this process does the work itself.
    cluster
        Address of the scheduler of a cluster, such as ``tcp://lab:8786``; None for none.

    Raises
    ------
    InputError
        If there are no such workers.
    """

    number: int = 1
    cluster: str | None = None

    def __post_init__(self) -> None:
        if not 1 <= self.number <= MOST_WORKERS:
            raise InputError(
                f"{setting('workers')} is {self.number}; it must be 1 to {MOST_WORKERS}"
            )
        if self.cluster is None:
            return
        if not _ADDRESS.fullmatch(self.cluster):
            raise InputError(
                f"{setting('cluster')} is {self.cluster!r}, which is no address; give the one "
                f"that the scheduler says, such as tcp://192.168.1.5:8786"
            )
        if not _is_there("distributed"):
            raise InputError(f"{setting('cluster')} needs distributed; {HOW_TO_GET_DISTRIBUTED}")

    def available(self, warn: Callable[[str], None]) -> Workers:
        """These workers, or a single one if dask is not installed, which is then told."""
        if self.number == 1 or self.cluster is not None or _is_there("dask"):
            return self
        warn(f"workers: 1, since dask is not installed; {HOW_TO_GET_DASK}")
        return Workers()

    def work(
        self,
        function: Callable[[Task], Found],
        tasks: Sequence[Task],
        done: Callable[[int, Found], None],
    ) -> None:
        """Do all tasks, and give each result with the number of its task as soon as it is there.

        Parameters
        ----------
        function
            What is done with a task; it must be found by its name in its module.
        tasks
            The tasks, which must be picklable. An error of `function` ends the work.
        done
            Function that takes the number of a task, from 0, and its result.

        Raises
        ------
        VbrailleError
            If a worker or the cluster goes away, or as `function` raises it. What was done before
            was given to `done`.
        """
        if not tasks:
            return
        if self.cluster is not None:
            _on_cluster(self.cluster, function, tasks, done)
        elif self.number == 1 or len(tasks) == 1:
            for number, task in enumerate(tasks):
                done(number, function(task))
        else:
            _on_processes(min(self.number, len(tasks)), function, tasks, done)


def _is_there(package: str) -> bool:
    return find_spec(package) is not None


def _on_processes(
    number: int,
    function: Callable[[Task], Found],
    tasks: Sequence[Task],
    done: Callable[[int, Found], None],
) -> None:
    from concurrent.futures.process import BrokenProcessPool

    from dask.callbacks import Callback  # pyright: ignore[reportMissingImports]
    from dask.multiprocessing import get  # pyright: ignore[reportMissingImports]

    # dask begins with the last name of the alphabet.
    keys = {f"task-{len(tasks) - number:07}": number for number in range(len(tasks))}
    graph = {key: (function, task) for key, task in zip(keys, tasks, strict=True)}
    finished = 0

    def posttask(key: str, found: Found, *_: Any) -> None:
        nonlocal finished
        if key in keys:
            finished += 1
            done(keys[key], found)

    portion = max(1, min(len(tasks) // (number * _TURNS), _MOST_IN_TURN))
    try:
        with Callback(posttask=posttask), _forked(number) as pool:
            get(graph, list(keys), pool=pool, chunksize=portion, optimize_graph=False)
    except BrokenProcessPool:
        raise VbrailleError(
            f"a worker was ended from outside after {finished} of {count(len(tasks), 'task')}; "
            f"give fewer {setting('workers')} if the memory was full"
        ) from None


@contextmanager
def _forked(number: int) -> Iterator[ProcessPoolExecutor]:
    """Fork this process for workers, each with one thread of linear algebra.

    A new process would import for some seconds what this one has already. The workers are forked
    at once, by this thread, before the pool has threads. Threads of linear algebra in each would
    only take turns with those of other workers. Where the work ends early, nobody waits for them.
    """
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import active_children, get_context

    from threadpoolctl import threadpool_limits  # pyright: ignore[reportMissingImports]

    others = set(active_children())
    with threadpool_limits(1), warnings.catch_warnings():
        # Python 3.12 and later warn of threads, and those of linear algebra are ready for forks.
        warnings.filterwarnings("ignore", r"This process .* is multi-threaded", DeprecationWarning)
        with ProcessPoolExecutor(
            number, get_context("fork"), initializer=_begin_worker, initargs=(os.getpid(),)
        ) as pool:
            try:
                yield pool
            except BaseException:
                for worker in set(active_children()) - others:
                    worker.kill()
                raise


def _begin_worker(parent: int) -> None:
    """Leave signals to the process that the workers work for, and end when it ends."""
    signal.set_wakeup_fd(-1)
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with suppress(OSError, AttributeError):  # where there is no such call
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, int(signal.SIGKILL))
    if os.getppid() != parent:  # the parent was gone before that
        os._exit(1)


def _on_cluster(
    address: str,
    function: Callable[[Task], Found],
    tasks: Sequence[Task],
    done: Callable[[int, Found], None],
) -> None:
    import logging

    import dask  # pyright: ignore[reportMissingImports]
    from distributed import Client, as_completed  # pyright: ignore[reportMissingImports]

    # What it would log of a lost connection is said in one sentence instead.
    for name in ("asyncio", *logging.root.manager.loggerDict):
        if name.partition(".")[0] in ("asyncio", "distributed", "tornado"):
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)
    patience = f"{_PATIENCE_S}s"
    finished = 0
    with dask.config.set({"distributed.comm.timeouts.connect": patience}):  # pyright: ignore[reportPrivateImportUsage]
        try:
            client = Client(address, timeout=patience, set_as_default=False)
        except (OSError, ValueError) as error:
            raise VbrailleError(
                f"no cluster answers at {address}: {str(error).splitlines()[0]}"
            ) from None
        try:
            futures = client.map(function, tasks, pure=False)
            numbers = {future.key: number for number, future in enumerate(futures)}
            for future in as_completed(futures, loop=client.loop, raise_errors=False):
                if future.status != "finished":
                    if isinstance(error := _error_of(future), VbrailleError):
                        raise error
                    break
                done(numbers[future.key], future.result())
                finished += 1
        except (OSError, TimeoutError, RuntimeError):
            pass  # the connection; how much was done is told below
        finally:
            with suppress(Exception):
                client.close(timeout=1)
    if finished < len(tasks):
        raise VbrailleError(
            f"the cluster at {address} went away after {finished} of {count(len(tasks), 'task')}; "
            f"what is done is told, and with {setting('keep')} FILE the same command goes on there"
        )


def _error_of(future: Any) -> BaseException | None:
    """Error of a task; None if it was not the task that failed."""
    if future.status != "error":
        return None
    error = future.exception()
    if isinstance(error, Exception) and type(error).__module__.startswith("distributed"):
        return None
    return error if isinstance(error, VbrailleError) else VbrailleError(f"a task failed: {error}")
