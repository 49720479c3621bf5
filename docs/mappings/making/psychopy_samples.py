"""Samples that PsychoPy itself writes, by the handlers that its Builder uses.

PYTHONPATH has PsychoPy: python docs/mappings/making/psychopy_samples.py
"""

import csv
import tempfile

import psychopy
from done import HERE, PRACTICE, letters, questions
from psychopy import data


def conditions(columns, trials):
    """Conditions of a loop, as PsychoPy reads them from a file."""
    with tempfile.NamedTemporaryFile("w", suffix=".csv", newline="") as file:
        writer = csv.DictWriter(file, columns, extrasaction="ignore")
        writer.writeheader()
        writer.writerows(trials)
        file.flush()
        return data.importConditions(file.name)


def begin(name, who):
    """Experiment of a participant, as Builder's scripts begin it."""
    info = {"participant": who, "session": "001", "date": "2026-11-22_10h12.07.123"}
    info |= {"expName": name, "psychopyVersion": psychopy.__version__}
    return data.ExperimentHandler(
        name=name, extraInfo=info, dataFileName=str(HERE / f"psychopy-{name}-{who}"),
        savePickle=False, saveWideText=False,
    )  # fmt: skip


def loop(experiment, name, trials):
    """A loop of trials in order, in the experiment."""
    handler = data.TrialHandler(trials, 1, method="sequential", name=name, seed=1)
    experiment.addLoop(handler)
    return handler


def read_letters(who, trials):
    """Strings, after two of practice; the answer stands in a text box, a key ends reading."""
    experiment = begin("letters", who)
    experiment.addData("welcome.started", 3.05)
    experiment.nextEntry()
    columns = ("string", "texture")
    practised = conditions(columns, [{"string": s, "texture": 0} for s, _ in PRACTICE])
    shown = conditions(columns, trials)
    given = [(string, rt) for string, rt in PRACTICE]
    for name, items, answers in (
        ("practice", practised, given),
        ("trials", shown, [(t["answer"], float(t["rt"])) for t in trials]),
    ):
        handler = loop(experiment, name, items)
        for _, (answer, rt) in zip(handler, answers, strict=True):
            handler.addData("key_done.keys", "space")
            handler.addData("key_done.rt", rt)
            handler.addData("answer_box.text", answer)
            experiment.nextEntry()
    experiment.addData("goodbye.started", 99.5)
    experiment.nextEntry()
    experiment.saveAsWideText(experiment.dataFileName + ".csv", delim=",")
    experiment.abort()


def ask(who, trials):
    """Questions of all kinds: keys, sliders and a text box."""
    experiment = begin("questions", who)
    columns = ("task", "shown", "first", "second", "texture")
    handler = loop(experiment, "trials", conditions(columns, trials))
    for _, trial in zip(handler, trials, strict=True):
        answer = trial["answer"]
        if trial["task"] == "rating":
            handler.addData("slider.response", float(answer))
        elif trial["task"] in ("magnitude", "free"):
            handler.addData("textbox.text", answer)
        else:
            handler.addData("key_resp.keys", answer)
            handler.addData("key_resp.corr", int(trial["right"]))
            handler.addData("sure.response", float(trial["sure"]))
        experiment.nextEntry()
    experiment.saveAsWideText(experiment.dataFileName + ".csv", delim=",")
    experiment.abort()


for who, trials in letters().items():
    read_letters(who, trials)
for who, trials in questions().items():
    ask(who, trials)
