"""Codebooks: every column of every table, in the words that the table's maker has for it."""

import csv
import io
import json

from tests.sessions.sittings import MINI, Session
from vbraille.sessions.record import bids
from vbraille.sessions.record.codebook import COLUMNS, HEAD, entry_of, to_codebook
from vbraille.sessions.record.export import rows

ASKS = MINI + '[[fields]]\nname = "hand"\nask = "Reading hand"\n'


def test_every_column_of_an_export_has_a_meaning_its_unit_and_its_values():
    read = [*csv.DictReader(io.StringIO(to_codebook({"t.csv": map(entry_of, COLUMNS)})))]
    assert [row["column"] for row in read] == list(COLUMNS)
    assert [row["meaning"] for row in read] == list(COLUMNS.values())
    assert {row["file"] for row in read} == {"t.csv"}
    told = {row["column"]: row for row in read}
    assert tuple(read[0]) == HEAD
    assert told["response_s"]["unit"] == "s"
    assert told["cell_gap_mm"]["unit"] == "mm"
    assert told["trial"]["unit"] == ""
    assert told["early"]["values"] == "1: it does not count; 0: it counts"
    assert told["moved_by"]["values"].count(";") == 2


def test_what_a_protocol_asks_is_its_own_words(tmp_path):
    record = Session(tmp_path / "s", ASKS).sit().record
    assert entry_of("field_hand", {"field_hand": "Reading hand"}).meaning == "Reading hand"
    assert entry_of("field_hand").meaning.startswith("answer to a question")
    (beh,) = [json.loads(v) for k, v in bids.files(record).items() if k.endswith("_beh.json")]
    for name in rows(record)[0]:  # the JSON beside a table says what the codebook says
        assert beh[name] == entry_of(name, {"field_hand": "Reading hand"}).to_bids()
    assert beh["early"]["Levels"]["1"] == "it does not count"


def test_a_column_that_somebody_added_is_as_it_was_given():
    assert entry_of("age").meaning == "as it was given"
