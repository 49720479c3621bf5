"""Columns of a session's table: what each holds, and those that a lab's own design adds."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial

# What each column holds: the table's head, and its description in BIDS.
COLUMNS = {
    "session": "name of the session's directory",
    "participant": "pseudonym",
    "protocol": "name of the protocol",
    "block": "from 1",
    "trial": "from 1, in the order of the plan",
    "condition": "name, as in the protocol",
    "texture": "level of texture, 0 to 1",
    "contrast": "share of the full swing, 0 to 1",
    "texture_cycles": "half-cycles of texture a radius, where the model has that",
    "model": "name of the display",
    "shown_on": "where strings stood: device, conventional for a conventional display, or paper",
    "mapping": "how dot rows are shown by actuator rows, by name",
    "dot_width_mm": "width of a dot along the line; two values where they are compared",
    "dot_spacing_mm": "between the two dot columns of a cell; two values where they are compared",
    "cell_gap_mm": "from a cell's right dot column to the next cell's left one",
    "row_spacing_mm": "between neighbouring dot rows",
    "line_pitch_mm": "between lines",
    "travel_mm": "of the carriage",
    "parameter": "what two stimuli were compared by, in mm if its name says so; empty where "
    "strings are read",
    "presented": "Unicode braille of the cells asked for; two values, the first one first",
    "string_set": "Unicode braille of the protocol's string, if its cells come in another order "
    "at each showing; else empty",
    "answered": "Unicode braille, ? for a place not read; the value chosen; as asked for, yes or "
    "no, same or different, a number, or words; empty if not answered",
    "correct": "1 if all places are right, or the answer is, 0 if not; empty where nothing is "
    "right and without an answer",
    "question": "what was asked: identify, which, same-different, detect, rating, magnitude, free",
    "outcome": "right or wrong; where something is looked for, hit, miss, false alarm or correct "
    "rejection; empty if nothing is right, and without an answer",
    "confidence": "how sure the answer is, on the scale of the protocol; empty if not asked",
    "first_answer": "what had been answered before an undo; else empty",
    "answers_from": "typed, simulated:NOISE for a simulated reader, program, or a file",
    "moved_by": "what moved the carriage: person, simulated for a simulated hand, or "
    "simulated:pointer if somebody at the live view was that hand in a part of the trial, so that "
    "it is no data about people; empty on paper",
    "attempt": "how often the trial was begun",
    "duration_s": "from the array's first touch of the leftmost dot to its last way back over it "
    "(Levesque 2009, 3.4); on paper and on a conventional display, by key",
    "returned": "1 if the hand went back over the leftmost dot; 0 if the duration ends with the "
    "last tick at which an actuator was off its idle end",
    "contact_s": "from the start signal to the first touch",
    "response_s": "from the start signal to the participant's key, or to the answer where there "
    "was none, pauses left out",
    "ended_by": "what ended reading: button:N, key:NAME, or answer if the answer came before the "
    "participant's key; empty if the protocol has no such key",
    "paused_s": "length of the pauses",
    "early": "1 if it was answered before it was read to its end: its duration does not count",
    "analysed": "1 if the analysis uses the trial; 0 for a catch trial, unless detecting is what "
    "was asked, and for one without an answer",
    "warned": "1 if the warning sounded",
    "faults": "what went wrong with the device in the trial, all attempts",
    "notes": "of the experimenter, typed in the trial",
    "notes_before": "typed between the trial shown before and this one",
    "notes_after": "typed between this trial and the one shown next, or the end",
    "cue_time": "wall clock at the start signal, UTC",
    "answer_time": "wall clock at the answer, UTC",
    "trace": "file of the trace of the last attempt",
}

# Columns of protocols whose strings are texts.
WRITTEN = {
    "table": "braille table that made the cells of the text",
    "text": "text that the cells asked for stand for; empty for a blank catch trial",
}


def designed(protocol: Protocol, trial: Trial) -> dict[str, str]:
    """Cells of a trial's row for the design: its group, factors, item and catch.

    A protocol without one of these has no column for it.
    """
    cells: dict[str, str] = {}
    if protocol.groups:
        cells["group"] = protocol.group
    for name, level in protocol.levels(trial.condition).items():
        cells[f"factor_{name}"] = level
    if protocol.item_columns:
        own = protocol.told(trial.item)
        cells |= {f"item_{name}": value for name, value in own.items()}
    if protocol.design.catch is not None:
        cells["catch"] = trial.catch
    if protocol.written:
        cells |= {name: getattr(trial.stimuli[0], name) or "" for name in ("table", "text")}
    return cells


def describe_design(protocol: Protocol) -> dict[str, str]:
    """What the columns of `designed` hold, by their names."""
    told: dict[str, str] = {}
    if protocol.groups:
        told["group"] = "name of the participant's group"
    for factor in protocol.factors:
        whose = "the participant's" if factor.between else "the condition's"
        told[f"factor_{factor.name}"] = f"{whose} level of the factor {factor.name}"
    for name in protocol.item_columns:
        told[f"item_{name}"] = f"column {name} of the protocol's file of items"
    if protocol.design.catch is not None:
        told["catch"] = "blank or repeat for a trial that only keeps watch; else empty"
    if protocol.written:
        told |= WRITTEN
    return told
