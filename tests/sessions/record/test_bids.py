"""A session as BIDS has it: names, tables, their sidecars and recordings at regular times."""

import csv
import gzip
import io
import json
from dataclasses import replace

import numpy as np
import pytest
from msgspec import structs

from tests.sessions.bidsvalid import complaints
from tests.sessions.sittings import COMPARED, MINI, Session
from vbraille.sessions.record import bids
from vbraille.sessions.record.export import rows, to_csv
from vbraille.sessions.record.traces import read_trace

STEM = "sub-P1/ses-01/beh/sub-P1_ses-01_task-mini"
EVENTS = f"{STEM}_run-01_events"
RECORDING = f"{STEM}_run-01_recording-carriage_physio"
ASKS = MINI + '[[fields]]\nname = "hand"\nask = "Reading hand"\n'


@pytest.fixture(scope="module")
def record(tmp_path_factory):
    """A session read by a simulated reader, with a question that was not answered."""
    record = Session(tmp_path_factory.mktemp("bids") / "s", ASKS, hand="fluent").sit().record
    return replace(record, head={**record.head, "fields": {"hand": ""}})


@pytest.fixture(scope="module")
def files(record):
    """Files of the data set."""
    return bids.files(record)


def table(tsv, **options):
    return list(csv.DictReader(io.StringIO(tsv.decode()), delimiter="\t", **options))


def physio(content, columns):
    return table(gzip.decompress(content), fieldnames=columns)


def test_names_are_those_of_bids(record, files, tmp_path):
    assert sorted(files) == sorted(
        [
            f"{STEM}_beh.tsv", f"{STEM}_beh.json", f"{EVENTS}.tsv", f"{EVENTS}.json",
            f"{RECORDING}.tsv.gz", f"{RECORDING}.json",
        ]
    )  # fmt: skip
    bids.write(record, tmp_path / "set")
    written = [
        path.relative_to(tmp_path / "set")
        for path in (tmp_path / "set").rglob("*")
        if path.is_file()
    ]
    assert len(written) == 10
    assert complaints(tmp_path / "set") == ""
    (tmp_path / "set" / f"{STEM}_trials.tsv").touch()
    assert f"{STEM}_trials.tsv" in complaints(tmp_path / "set")


def test_two_values_that_were_compared_are_no_number(tmp_path):
    compared = Session(tmp_path / "s", COMPARED).sit().record
    (name,) = (name for name in bids.files(compared) if name.endswith("_beh.json"))
    column = json.loads(bids.files(compared)[name])["dot_width_mm"]
    assert "Units" not in column
    assert column["Description"].endswith(", in mm")
    bids.write(compared, tmp_path / "set")
    assert complaints(tmp_path / "set") == ""


def test_labels_have_letters_and_digits_only(record, tmp_path):
    named = replace(record, plan=structs.replace(record.plan, participant="P-0_7", protocol="a-b"))
    for path in bids.files(named):
        assert path.startswith("sub-P07/ses-01/beh/sub-P07_ses-01_task-ab_")
    bids.write(named, tmp_path / "set")
    assert complaints(tmp_path / "set") == ""


def test_every_trial_is_as_in_the_table_and_nothing_is_empty(record, files):
    read = table(files[f"{STEM}_beh.tsv"])
    printed = list(csv.DictReader(io.StringIO(to_csv(rows(record)))))
    assert len(read) == 4
    assert read == [{name: value or "n/a" for name, value in row.items()} for row in printed]
    assert {row["field_hand"] for row in read} == {"n/a"}


def test_every_column_is_described(files):
    sidecar = json.loads(files[f"{STEM}_beh.json"])
    assert sidecar["TaskName"] == "mini"
    for name in table(files[f"{STEM}_beh.tsv"])[0]:
        assert sidecar[name]["Description"]
        unit = next((unit for unit in ("s", "mm") if name.endswith(f"_{unit}")), None)
        assert sidecar[name].get("Units") == unit
    sidecar = json.loads(files[f"{RECORDING}.json"])
    assert (sidecar["SamplingFrequency"], sidecar["StartTime"]) == (1000.0, 0.0)
    assert sidecar["Columns"] == ["x_mm", "y_mm", "speed_mm_s", "frame", "line", "flags"]
    assert all(sidecar[name]["Description"] for name in sidecar["Columns"])
    assert (sidecar["x_mm"]["Units"], "Units" in sidecar["flags"]) == ("mm", False)


def test_a_recording_is_its_trace(record, files):
    sidecar = json.loads(files[f"{RECORDING}.json"])
    ticks = read_trace(record.folder / sidecar["Trace"]).ticks
    read = physio(files[f"{RECORDING}.tsv.gz"], sidecar["Columns"])
    assert len(read) == ticks.size  # no deadline was missed
    for name, field in (("frame", "tick"), ("line", "line"), ("flags", "flags")):
        assert [int(row[name]) for row in read] == ticks[field].tolist()
    for name, field in (("x_mm", "x_mm"), ("y_mm", "y_mm"), ("speed_mm_s", "vx_mm_s")):
        values = [np.nan if row[name] == "n/a" else float(row[name]) for row in read]
        np.testing.assert_allclose(values, ticks[field], rtol=1e-5, atol=1e-12)


def test_rows_are_at_regular_times_whatever_was_missed(record):
    real = read_trace(record.folder / "trace-001.gz")
    ticks = real.ticks[[*range(1200), *range(1210, 1500)]].copy()
    ticks["late"][700:] += 3  # three deadlines, then ten ticks that were lost
    ticks["x_mm"][:2] = np.nan
    traces = bids.Traces(record)
    traces._traces["trace-001.gz"] = replace(real, ticks=ticks)
    made = bids.files(record, traces)
    columns = json.loads(made[f"{RECORDING}.json"])["Columns"]
    read = physio(made[f"{RECORDING}.tsv.gz"], columns)
    assert len(read) == 1503
    missing = [n for n, row in enumerate(read) if row["frame"] == "n/a"]
    assert missing == [700, 701, 702, *range(1203, 1213)]
    assert all(set(read[n].values()) == {"n/a"} for n in missing)
    assert [row["x_mm"] for row in read[:2]] == ["n/a", "n/a"]
    for n, row in enumerate(read):
        assert row["frame"] in ("n/a", str(n if n < 700 else n - 3))


def test_the_same_record_gives_the_same_bytes(record, files):
    assert bids.files(record) == files


def test_a_trace_of_no_use_is_left_out_and_said(record, files):
    path = record.folder / "trace-001.gz"
    whole = path.read_bytes()
    try:
        for content in (b"\0" + whole[1:], None):
            path.unlink()
            if content is not None:
                path.write_bytes(content)
            traces = bids.Traces(record)
            made = bids.files(record, traces)
            assert sorted(made) == [
                f"{STEM}_beh.json", f"{STEM}_beh.tsv", f"{EVENTS}.json", f"{EVENTS}.tsv",
            ]  # fmt: skip
            assert len(traces.faults) == 1
            assert [row["answered"] for row in table(made[f"{STEM}_beh.tsv"])] == [
                row["answered"] for row in table(files[f"{STEM}_beh.tsv"])
            ]
    finally:
        path.write_bytes(whole)
