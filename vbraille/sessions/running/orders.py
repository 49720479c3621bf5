"""Orders that an experimenter may type beside answers."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Order:
    """An order that an experimenter may type.

    Parameters
    ----------
    word
        Word that the order is typed as.
    name
        Name of the method of `vbraille.sessions.running.console.Console` that does the order.
    help
        What the order does, in words for people.
    takes
        Whether more text may follow the word.
    """

    word: str
    name: str
    help: str
    takes: bool = False


ORDERS = (
    Order("answer", "answer", "before an answer that is also one of these words", takes=True),
    Order("undo", "undo", "take back the last answer, and type it anew; the record keeps both"),
    Order("repeat", "repeat", "show the open trial again, from its start"),
    Order("note", "note", "write the rest of the line into the record", takes=True),
    Order("pause", "pause", "rest the array at once; again, or Enter, goes on"),
    Order("go", "go_on", "go on, as Enter does"),
    Order("break", "have_break", "a break, after the open trial"),
    Order("begin", "begin", "end practice"),
    Order("contrast", "contrast", "set the contrast, 0 to 1, unless the plan does", takes=True),
    Order("texture", "texture", "set the texture, 0 to 1, unless the plan does", takes=True),
    Order("stop", "stop", "end for now; session resume goes on"),
    Order("help", "help", "say what there is to type"),
)
_BY_WORD = {order.word: order for order in ORDERS}


def find_order(line: str) -> tuple[Order, str] | None:
    """Order that a line gives, and the text after its word; None if it is no order."""
    word, _, rest = line.strip().partition(" ")
    order = _BY_WORD.get(word.lower())
    if order is None or (rest.strip() and not order.takes):
        return None
    return order, rest.strip()
