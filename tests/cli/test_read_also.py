"""Reading with a conventional display beside, by the program as its users have it."""

import pytest

from tests.cli.program import Terminal
from tests.conventional.handytech import FWINRT, LNDN, ROUTE_0, Brltty, needs_brltty, until

pytestmark = needs_brltty


@pytest.mark.real_time  # BRLTTY shows its own cells again in its own time, if it has any
def test_each_line_stands_there_its_keys_are_obeyed_and_the_end_leaves_it_blank(text, tmp_path):
    with Brltty(tmp_path) as brltty:
        how = ("--also", f"brlapi:{brltty.host}", "--hand", "sweep:5", "--cues", "none")
        with Terminal("read", text, *how) as terminal:
            terminal.until("display: HandyTech mdlr, 40 cells")
            first = until(lambda: any(brltty.display.standing) and brltty.display.standing)
            brltty.display.press(LNDN)
            terminal.until("line: 2")
            until(lambda: brltty.display.standing != first)
            brltty.display.press(ROUTE_0 + 3)
            assert "word: four" in terminal.until("word: .*\n")
            brltty.display.press(FWINRT)
            terminal.until("line: 3")
            brltty.stop()
            terminal.until("display: no BRLTTY answers at .*; start it, or give its address")
            terminal.type("p")
            terminal.until("line: 2")  # reading goes on
            brltty.start()
            terminal.until("display: HandyTech mdlr, 40 cells")
            until(lambda: any(brltty.display.standing))
            terminal.type("q")
            assert terminal.end() == 0
        brltty.display.wait(b"")


def test_without_brltty_reading_goes_on_and_says_so(call, text):
    done = call(
        "read", text, "--also", "brlapi:127.0.0.1:60000", "--hand", "sweep:150", "--no-places"
    )
    assert done.code == 0
    assert "display: no BRLTTY answers at 127.0.0.1:60000; start it" in done.out
    assert "summary: lines 3" in done.out


def test_what_is_no_display_is_refused_before_anything_is_read(call, text):
    done = call("read", text, "--also", "brl")
    assert (done.code, done.out) == (2, "")
    assert done.err == (
        "vbraille: --also is 'brl'; give brlapi for the display of BRLTTY on this machine, "
        "or brlapi:HOST:N, as in brlapi:127.0.0.1:0, for one elsewhere\n"
    )
