"""Tasks that several processes share, with the same results however many; results that are kept.

A task says all that its result depends on, its seed among it, and tasks do not depend on how many
processes there are. So one worker and many give the same results. joblib has the processes.
"""

from __future__ import annotations

import ctypes
import json
import os
import signal
import warnings
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, TypeVar

from vbraille.errors import InputError, VbrailleError
from vbraille.wording import count, setting

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

Task = TypeVar("Task")
Found = TypeVar("Found")
MOST_WORKERS = 256
_PR_SET_PDEATHSIG = 1


@dataclass(frozen=True, slots=True)
class Workers:
    """Processes that share the work.

    Parameters
    ----------
    number
        Number of processes; with one, this process does the work itself.

    Raises
    ------
    InputError
        If there are no, or too many.
    """

    number: int = 1

    def __post_init__(self) -> None:
        if not 1 <= self.number <= MOST_WORKERS:
            raise InputError(
                f"{setting('workers')} is {self.number}; it must be 1 to {MOST_WORKERS}"
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
            If a worker goes away, or as `function` raises it. What was done before
            was given to `done`.
        """
        if self.number == 1 or len(tasks) < 2:
            for number, task in enumerate(tasks):
                done(number, function(task))
            return
        from concurrent.futures.process import BrokenProcessPool

        import joblib  # takes a while to load

        finished = 0
        parallel = joblib.Parallel(self.number, return_as="generator_unordered")
        calls = (
            joblib.delayed(_call)(function, number, task, os.getpid())
            for number, task in enumerate(tasks)
        )
        results: Iterator[tuple[int, Found]] = parallel(calls)  # pyright: ignore[reportAssignmentType]
        try:
            for number, found in results:
                done(number, found)
                finished += 1
        except (BrokenProcessPool, OSError):
            raise VbrailleError(
                f"a worker was ended from outside after {finished} of {count(len(tasks), 'task')}; "
                f"give fewer {setting('workers')} if the memory was full"
            ) from None
        finally:
            with suppress(Exception), warnings.catch_warnings(action="ignore"):
                results.close()  # pyright: ignore[reportAttributeAccessIssue]


def _call(
    function: Callable[[Task], Found], number: int, task: Task, parent: int
) -> tuple[int, Found]:
    _belong_to(parent)
    return number, function(task)


@cache
def _belong_to(parent: int) -> None:
    """Leave Ctrl-C to the process that this one works for, and end when it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, int(signal.SIGKILL))
    if os.getppid() != parent:  # the parent was gone before that
        os._exit(1)


class KeptResults:
    """A file of results, a line each, of one piece of work.

    Parameters
    ----------
    path
        File to go on with, or to begin; None keeps nothing.
    work
        All that the results depend on, in the terms of JSON.

    Raises
    ------
    InputError
        If the file is of other work, is no such file, or cannot be read or made.
    """

    def __init__(self, path: Path | None, work: dict[str, Any]) -> None:
        self._path = path
        self.found: dict[int, Any] = {}
        if path is None:
            return
        head = json.dumps(work, sort_keys=True)
        try:
            text = path.read_text("utf-8") if path.exists() else ""
            if not text:
                path.write_text(f"{head}\n", "utf-8")
                return
        except (OSError, UnicodeDecodeError) as error:
            why = getattr(error, "strerror", None) or "it is not UTF-8"
            raise InputError(f"{setting('keep')} {path} cannot be used: {why}") from None
        first, *lines = text.splitlines()
        if first != head:
            raise InputError(
                f"{setting('keep')} {path} is of other work; give a new name, or the same options "
                f"as then"
            )
        for line in lines:
            try:
                number, found = json.loads(line)
            except (ValueError, TypeError):  # the end of a line that was being written
                continue
            self.found[number] = found
        if not text.endswith("\n"):
            self._append("\n")

    def add(self, number: int, found: Any) -> None:
        """Keep the result of a task."""
        self.found[number] = found
        self._append(f"{json.dumps([number, found])}\n")

    def _append(self, text: str) -> None:
        if self._path is None:
            return
        try:
            with self._path.open("a", encoding="utf-8") as file:
                file.write(text)
        except OSError as error:
            raise VbrailleError(f"{self._path} cannot be written: {error.strerror}") from None


def work_on(
    workers: Workers,
    function: Callable[[Task], Found],
    tasks: Sequence[Task],
    kept: KeptResults,
    report: Callable[[int, int], None],
) -> VbrailleError | None:
    """Do the tasks that are not kept yet, and give what ended the work early, if anything did.

    Parameters
    ----------
    workers
        Who works.
    function
        What is done with a task, with a result in the terms of JSON.
    tasks
        All tasks of the work.
    kept
        Results that are there, to which new ones are added.
    report
        Function that is called with how many tasks are done, and how many there are.
    """
    left = [number for number in range(len(tasks)) if number not in kept.found]

    def done(place: int, found: Found) -> None:
        kept.add(left[place], found)
        report(len(kept.found), len(tasks))

    try:
        workers.work(function, [tasks[number] for number in left], done)
    except InputError:
        raise
    except VbrailleError as error:
        return error
    return None
