"""Results of finished tasks in a file, so that work that was ended goes on where it was."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError, VbrailleError
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from vbraille.forecast.workers import Found, Task, Workers


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
    told: Callable[[int, int], None],
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
    told
        Function that is told how many tasks are done, and how many there are.
    """
    left = [number for number in range(len(tasks)) if number not in kept.found]

    def done(place: int, found: Found) -> None:
        kept.add(left[place], found)
        told(len(kept.found), len(tasks))

    try:
        workers.work(function, [tasks[number] for number in left], done)
    except InputError:
        raise
    except VbrailleError as error:
        return error
    return None
