"""Every STEP-th portion from FIRST on of MANY studies, by a bare process; says as shared_power."""

import json
import sys
from time import process_time

from vbraille.forecast.power import PORTION, SEED, PowerQuestion
from vbraille.forecast.studies import StudyTask, count_found
from vbraille.sessions.planning.protocolfiles import load_protocol

EFFECT = {"T0": "0.5", "T25": "0.56", "T100": "0.64"}  # Lévesque 2009, 4.3


def question(studies: int) -> PowerQuestion:
    """Question about 12 participants with 78 trials each."""
    return PowerQuestion(load_protocol("letters"), EFFECT, (12,), studies=studies)


if __name__ == "__main__":
    first, step, many = map(int, sys.argv[1:])
    plan = question(many).plan()
    for start in range(first * PORTION, many, step * PORTION):
        count_found(StudyTask(plan, SEED, start, min(PORTION, many - start)))
    print(json.dumps({"own": process_time(), "workers": []}))
