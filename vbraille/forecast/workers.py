"""Tasks that several processes share, here or on a cluster, with the same results everywhere.

A task says all that its result depends on, its seed among it, and tasks do not depend on how many
processes there are. So one worker and many give the same results. joblib has the processes, and
dask the cluster.
"""

from __future__ import annotations

import ctypes
import logging
import os
import re
import signal
import warnings
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from typing import TYPE_CHECKING, TypeVar

from vbraille.errors import InputError, VbrailleError
from vbraille.wording import count, setting

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

Task = TypeVar("Task")
Found = TypeVar("Found")

MOST_WORKERS = 256
_ADDRESS = re.compile(r"(?:(?:tcp|tls|ws|wss|ucx)://)?(?:[\w.-]+|\[[0-9a-fA-F:]+\]):[0-9]{1,5}")
_PATIENCE_S = 10  # for a cluster to answer
_WORKERS_S = 30  # for its first worker to be there
_PR_SET_PDEATHSIG = 1


@dataclass(frozen=True, slots=True)
class Workers:
    """Processes here, or a cluster of dask's.

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
        if find_spec("distributed") is None:
            raise InputError(
                f"{setting('cluster')} needs distributed; pip install 'vbraille[cluster]' "
                f"installs it"
            )

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
        if self.cluster is None and (self.number == 1 or len(tasks) < 2):
            for number, task in enumerate(tasks):
                done(number, function(task))
        elif tasks:
            self._share(function, tasks, done)

    def _share(
        self,
        function: Callable[[Task], Found],
        tasks: Sequence[Task],
        done: Callable[[int, Found], None],
    ) -> None:
        import joblib  # takes a while to load

        finished = 0
        with ExitStack() as stack:
            if self.cluster is not None:
                _connect(self.cluster, stack)
                stack.enter_context(joblib.parallel_config("dask"))
            here = self.cluster is None
            parallel = joblib.Parallel(self.number if here else -1, return_as="generator_unordered")
            calls = (
                joblib.delayed(_call)(function, number, task, os.getpid() if here else None)
                for number, task in enumerate(tasks)
            )
            results: Iterator[tuple[int, Found]] = parallel(calls)  # pyright: ignore[reportAssignmentType]
            try:
                for number, found in results:
                    done(number, found)
                    finished += 1
            except VbrailleError:
                raise
            except Exception as error:
                if not _is_loss(error):
                    raise
                raise self._lost(finished, len(tasks)) from None
            finally:
                with suppress(Exception), warnings.catch_warnings(action="ignore"):
                    results.close()  # pyright: ignore[reportAttributeAccessIssue]

    def _lost(self, finished: int, tasks: int) -> VbrailleError:
        after = f"after {finished} of {count(tasks, 'task')}"
        if self.cluster is None:
            return VbrailleError(
                f"a worker was ended from outside {after}; give fewer {setting('workers')} if the "
                f"memory was full"
            )
        return VbrailleError(
            f"the cluster at {self.cluster} went away {after}; what is done is told, and with "
            f"{setting('keep')} FILE the same command goes on there"
        )


def _call(
    function: Callable[[Task], Found], number: int, task: Task, parent: int | None
) -> tuple[int, Found]:
    if parent is not None:
        _belong_to(parent)
    return number, function(task)


@cache
def _belong_to(parent: int) -> None:
    """Leave Ctrl-C to the process that this one works for, and end when it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, int(signal.SIGKILL))
    if os.getppid() != parent:  # the parent was gone before that
        os._exit(1)


def _is_loss(error: Exception) -> bool:
    """Tell if an error is of a process or a connection that went away, and not of a task."""
    from concurrent.futures.process import BrokenProcessPool

    lost = isinstance(error, BrokenProcessPool | OSError | TimeoutError)
    return lost or type(error).__module__.startswith("distributed")


def _connect(address: str, stack: ExitStack) -> None:
    """Connect to a cluster, until the end of the stack.

    Raises
    ------
    VbrailleError
        If no cluster answers there, or it has no workers.
    """
    import dask  # pyright: ignore[reportMissingImports]
    from distributed import Client  # pyright: ignore[reportMissingImports]

    # What it would log of a lost connection is said in one sentence instead.
    for name in ("asyncio", *logging.root.manager.loggerDict):
        if name.partition(".")[0] in ("asyncio", "distributed", "tornado"):
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)
    patience = f"{_PATIENCE_S}s"
    stack.enter_context(dask.config.set({"distributed.comm.timeouts.connect": patience}))  # pyright: ignore[reportPrivateImportUsage]
    try:
        client = Client(address, timeout=patience)
    except (OSError, ValueError) as error:
        raise VbrailleError(
            f"no cluster answers at {address}: {str(error).splitlines()[0]}"
        ) from None

    def close() -> None:
        with suppress(Exception):  # its end need not be said again
            client.close(timeout=1)

    stack.callback(close)
    try:
        client.wait_for_workers(1, timeout=_WORKERS_S)
    except TimeoutError:
        raise VbrailleError(
            f"the cluster at {address} has no workers; start some with: dask worker {address}"
        ) from None
