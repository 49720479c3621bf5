"""`vbraille play` at a terminal."""

import re

from tests.cli import program
from tests.cli.test_read_live import until_address
from tests.cli.watcher import Watcher

SUMMARY = r"summary: seconds [0-9.]+"


def test_a_game_is_played_at_a_terminal():
    with program.Terminal(
        "play", "--seed", "3", "--players", "2", "--hand", "sweep:400", "--cues", "none"
    ) as terminal:
        terminal.until("h says the keys")
        assert "seed: 3" in terminal.printed
        assert "table: 24 cards face down, 4 rows of 6" in terminal.printed
        terminal.type("\n")
        terminal.until("card: row 1, card 1; feel it")
        terminal.type("n\n")
        terminal.until("two cards: o feels the other, enter says whether they match")
        terminal.type("\n")
        terminal.until("no match: both cards are turned back\r\nturn: player 2")
        terminal.type("q")
        assert terminal.end() == 0
        assert re.search(SUMMARY, terminal.printed)


def test_a_game_without_a_terminal_is_refused(call):
    said = call("play")
    assert said.code == 2
    assert "start it at a terminal" in said.err


def test_a_page_turns_cards_without_a_terminal():
    with program.start("play", "--seed", "3", "--monitor", "--hand", "sweep:400") as process:
        try:
            with Watcher(until_address(process)) as page:
                page.until(lambda _, state: state["cards"])
                assert [len(row) for row in page.state["cards"]] == [6, 6, 6, 6]
                page.ask(ask="press", command="POINT", place=7)
                page.until(lambda _, state: state["cards"][1][1]["side"] == "turned up")
                assert page.state["blind"]
                assert page.state["said"][-1] == "card: row 2, card 2; feel it"
        finally:
            process.kill()
