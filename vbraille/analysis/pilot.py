"""Pilots: a whole study of a protocol with the simulated reader, and its report."""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from itertools import repeat
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.analysis import analyse
from vbraille.errors import InputError
from vbraille.sessions.session import Session

if TYPE_CHECKING:
    from collections.abc import Callable


def pilot(
    protocol: str,
    participants: int,
    folder: str | Path,
    *,
    answers: str = "simulated",
    seed: int = 1,
    workers: int = 1,
    report: Callable[[int, int], None] = lambda _done, _all: None,
) -> Path:
    """Run the sessions of simulated people, analyse them, and return the report's directory.

    People are called SIM001 and so on, and the report warns that no person answered. Given again,
    a pilot that was interrupted goes on.

    Parameters
    ----------
    answers
        Source of the answers, such as ``simulated:0.4,lapses=0.05``.
    report
        Function that is called with how many sessions are done, and how many there are.

    Raises
    ------
    InputError
        If an argument cannot be used, or the pilot is done already.
    """
    folder = Path(folder)
    if (folder / "report").exists():
        raise InputError(f"{folder} has a report already; choose another directory")
    folder.mkdir(parents=True, exist_ok=True)
    names = [f"SIM{number:03}" for number in range(1, participants + 1)]
    paths = [folder / f"{name}.session" for name in names]
    with ProcessPoolExecutor(workers, get_context("spawn")) as pool:
        same = repeat(protocol), names, paths, repeat(answers), repeat(seed)
        for done, _ in enumerate(pool.map(conduct, *same), 1):
            report(done, participants)
    analyse(paths).write(folder / "report")
    return folder / "report"


def conduct(protocol: str, name: str, path: Path, answers: str, seed: int) -> None:
    """Run a session as fast as the machine can, from where it is."""
    session = Session(path)
    if not path.exists():
        session = Session.create(protocol, name, path=path, seed=seed)
    if session.content.events[-1].kind != "end":
        session.run(answers, hand="slow", fast=True, sound="none")
