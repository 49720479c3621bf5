"""Tasks that several processes share, here or on a cluster, with the same results everywhere.

A task says all that its result depends on, its seed among it, and tasks do not depend on how many
processes there are. So one worker and many give the same results. dask is imported only where
there is more than one worker.
"""

from __future__ import annotations

import os
import re
import signal
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, TypeVar

from vbraille.errors import InputError, VbrailleError
from vbraille.wording import count, setting

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

Task = TypeVar("Task")
Found = TypeVar("Found")

MOST_WORKERS = 256
HOW_TO_GET_DASK = "pip install 'vbraille[sweeps]' installs it"
_ADDRESS = re.compile(r"(?:(?:tcp|tls|ws|wss|ucx)://)?(?:[\w.-]+|\[[0-9a-fA-F:]+\]):[0-9]{1,5}")
_PATIENCE_S = 10  # for a cluster to answer
# Turns of a worker: at each it waits until this process, on a busy machine, gives it more.
_TURNS = 8
# Threads of linear algebra beside those of other workers would only take turns with them.
_ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


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
            raise InputError(
                f"{setting('cluster')} needs distributed; pip install distributed installs it"
            )

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

    import dask  # pyright: ignore[reportMissingImports]
    from dask.callbacks import Callback  # pyright: ignore[reportMissingImports]

    keys = {f"task-{number}": number for number in range(len(tasks))}
    delayed = dask.delayed(function, pure=False)  # pyright: ignore[reportPrivateImportUsage]
    graph = [delayed(task, dask_key_name=key) for key, task in zip(keys, tasks, strict=True)]
    finished = 0

    def posttask(key: str, found: Found, *_: Any) -> None:
        nonlocal finished
        if key in keys:
            finished += 1
            done(keys[key], found)

    try:
        with Callback(posttask=posttask), _one_thread():
            dask.compute(  # pyright: ignore[reportPrivateImportUsage]
                *graph,
                scheduler="processes",
                num_workers=number,
                chunksize=max(1, len(tasks) // (number * _TURNS)),
                optimize_graph=False,
                initializer=_begin_worker,
            )
    except BrokenProcessPool:
        raise VbrailleError(
            f"a worker was ended from outside after {finished} of {count(len(tasks), 'task')}; "
            f"give fewer {setting('workers')} if the memory was full"
        ) from None


def _begin_worker() -> None:
    """Leave a Ctrl-C to the process that the workers work for."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def _one_thread() -> Iterator[None]:
    """Have processes that begin now calculate with one thread each."""
    before = {name: os.environ.get(name) for name in _ONE_THREAD}
    os.environ.update(dict.fromkeys(_ONE_THREAD, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


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
