"""``vbraille tables``, and the sentences that name the nearest of them."""

import json

from vbraille.translate import BrailleTable, list_tables


def test_every_table_is_a_line_that_says_what_it_is(call):
    said = call("tables")
    assert (said.code, said.err) == (0, "")
    lines = said.out.splitlines()
    assert len(lines) == len(list_tables()) > 100
    assert "fr-bfu-g2.ctb: French contracted braille, language fr, grade 2" in lines
    for line, table in zip(lines, list_tables(), strict=True):
        assert line.startswith(f"{table.name}: ")
        assert f"language {table.language}" in line


def test_the_tables_of_a_language(call):
    usual, *lines = call("tables", "--language", "fr").out.splitlines()
    assert usual == "usual: fr-bfu-comp6.utb"
    assert len(lines) >= 3
    assert all(", language fr" in line for line in lines)
    for spelling in ("FR", "fr_FR", "fr-CA"):
        assert call("tables", "--language", spelling).out.splitlines() == [usual, *lines]
    for line in lines:
        BrailleTable(line.split(":")[0])
    _, *chinese = call("tables", "--language", "CMN_hans").out.splitlines()
    assert chinese
    assert all("language cmn-Hans" in line for line in chinese)
    assert set(chinese) <= set(call("tables", "--language", "cmn").out.splitlines())


def test_a_language_that_is_not_there_names_the_nearest(call):
    said = call("tables", "--language", "frr")
    assert (said.code, said.out) == (2, "")
    assert said.err.startswith("vbraille: no braille table for language 'frr'; the nearest is fr ")


def test_tables_and_ports_are_printed_as_json(call):
    told = json.loads(call("tables", "--language", "fr", "--json").out)
    assert told["usual"] == "fr-bfu-comp6.utb"
    assert len(told["tables"]) == len(call("tables", "--language", "fr").out.splitlines()) - 1
    assert {"name", "title", "language", "grade", "dots", "kind"} == set(told["tables"][0])
