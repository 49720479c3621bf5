"""The page of protocols: each of its examples is a protocol that a session follows to its end."""

import re
import tomllib

import pytest

from tests.documents import DOCS, protocol_tables
from tests.sessions.sittings import Session, of
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import load_protocol, parse_protocol, shipped_text
from vbraille.sessions.record.folder import check_folder

PAGE = (DOCS / "protocols.md").read_text(encoding="utf-8")
HEAD = """
format = 1
name = "page"
title = "An example of the page"
source = "ours"
model = "vbd"
"""
REST = {
    "design": '[design]\nkind = "list"\nstrings = ["ac", "ca"]\nrepeats = 2\n',
    "display": "[display]\ndot_row = 1\n",
}
_MOST_RUN = 12  # trials of a session that is run


def examples():
    """Protocols of the page; those that are a part of a file with what they lack."""
    for text in re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL):
        given = tomllib.loads(text)
        lacking = [] if "format" in given else [t for n, t in REST.items() if n not in given]
        yield text if "format" in given else HEAD + "".join(lacking) + text


@pytest.mark.parametrize("toml", list(examples()))
def test_an_example_is_a_protocol_that_a_session_follows(toml, tmp_path):
    protocol = parse_protocol(toml, "page.toml", beside=shipped_text)
    plan = make_plan(protocol, "P01", 1)
    assert len(plan.trials) == protocol.trials
    if (
        len(plan.trials) > _MOST_RUN
        or protocol.written
        or protocol.pictures
        or protocol.needs_conventional
    ):
        return
    session = Session(tmp_path / "s", toml, participant="P01")
    sat = session.sit()
    assert sat.progress.ended
    assert sat.progress.done == len(of(sat.events, "answer"))
    assert all(finding.good for finding in check_folder(session.folder))


def test_each_table_has_an_example():
    named = set(re.findall(r"key of `\[\[?(\w+)\]", "\n".join(r[0] for r in protocol_tables())))
    assert named <= {name for toml in examples() for name in tomllib.loads(toml)}


def test_the_example_that_comes_with_the_program_is_planned():
    assert load_protocol("factors").trials == 68
