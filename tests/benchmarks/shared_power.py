"""Studies shared by WORKERS as `vbraille power` does; prints seconds of processor time as JSON."""

import json
import os
import sys
from time import process_time

from tests.benchmarks.bare_power import question
from vbraille.forecast.power import PORTION, SEED
from vbraille.forecast.studies import StudyTask, count_found
from vbraille.forecast.workers import Workers


def timed(task: StudyTask) -> tuple[int, float]:
    """Simulate studies, and tell in which process, and what that has used since its start."""
    count_found(task)
    return os.getpid(), process_time()


if __name__ == "__main__":
    workers, many = map(int, sys.argv[1:])
    plan = question(many).plan()
    tasks = [
        StudyTask(plan, SEED, start, min(PORTION, many - start))
        for start in range(0, many, PORTION)
    ]
    used: dict[int, float] = {}

    def done(_number: int, found: tuple[int, float]) -> None:
        process, used_s = found
        used[process] = max(used.get(process, 0.0), used_s)

    Workers(workers).work(timed, tasks, done)
    own_s = process_time()
    used.pop(os.getpid(), None)
    print(json.dumps({"own": own_s, "workers": list(used.values())}))
