"""Samples that OpenSesame itself writes: whole experiments, whose loops have the answers.

PYTHONPATH has OpenSesame; SDL_VIDEODRIVER and SDL_AUDIODRIVER are dummy:
python docs/mappings/making/opensesame_samples.py
"""

import os
import tempfile
from pathlib import Path

from done import HERE, PRACTICE, letters, questions
from libopensesame.experiment import Experiment

SCRIPT = """\
---
API: 3
OpenSesame: {version}
Platform: posix
---
set title "{name}"
set start sequence
set subject_nr {number}
set experiment_file {name}.osexp
set canvas_backend legacy
define sequence sequence
\trun trials always
define loop trials
\tset repeat 1
\tset order sequential
\tset item trial
{cycles}
\trun trial
define sequence trial
\trun answer always
\trun logger always
define inline_script answer
\tset _run ""
\t___prepare__
\t{answering}
\t__end__
define logger logger
\tset auto_log no
{logged}
"""


def run(name, number, cycles, variables):
    """Run an experiment of a participant, whose loop has these variables."""
    lines = [
        f'\tsetcycle {n} {key} "{value}"'
        for n, cycle in enumerate(cycles)
        for key, value in cycle.items()
        if value != ""
    ]
    logged = "\n".join(f'\tlog "{variable}"' for variable in variables)
    script = SCRIPT.format(
        version=version(), name=name, number=number, cycles="\n".join(lines), logged=logged,
        answering="pass",
    )  # fmt: skip
    path = HERE / f"opensesame-{name}-subject-{number}.csv"
    folder = tempfile.mkdtemp()
    script_path = Path(folder, f"{name}.osexp")
    experiment = Experiment(
        name, script, folder, experiment_path=folder, fullscreen=False, subject_nr=number,
        logfile=str(path),
    )  # fmt: skip
    os.chdir(script_path.parent)
    experiment.run()
    experiment.end()


def version():
    """Version of OpenSesame."""
    from libopensesame import metadata

    return metadata.__version__


def main():
    """Write all samples."""
    for number, trials in enumerate(letters().values(), 1):
        cycles = [
            {"practice": "yes", "string": string, "texture": 0, "response_answer": string,
             "response_time_key_done": rt * 1000, "count_read_string": n}
            for n, (string, rt) in enumerate(PRACTICE)
        ]  # fmt: skip
        cycles += [
            {"practice": "no", "string": t["string"], "texture": t["texture"],
             "response_answer": t["answer"] or "None",
             "response_time_key_done": round(float(t["rt"]) * 1000), "count_read_string": n}
            for n, t in enumerate(trials, len(PRACTICE))
        ]  # fmt: skip
        run("letters", number, cycles, ["subject_nr", "opensesame_version", *cycles[0]])
    for number, trials in enumerate(questions().values(), 1):
        cycles = [
            {"task": t["task"], "shown": t["shown"], "first": t["first"], "second": t["second"],
             "texture": t["texture"], "response": t["answer"], "correct": t["right"],
             "response_sure": t["sure"], "count_trial": n}
            for n, t in enumerate(trials)
        ]  # fmt: skip
        run("questions", number, cycles, ["subject_nr", "opensesame_version", *cycles[0]])


main()
