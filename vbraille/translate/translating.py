"""A process that translates batches: it takes them from its input, and gives cells in order."""

from __future__ import annotations

import os
import signal
import sys
from queue import SimpleQueue
from threading import Thread
from typing import TYPE_CHECKING, cast

from vbraille.errors import VbrailleError
from vbraille.translate.batches import translated
from vbraille.translate.liblouis import BrailleTable
from vbraille.translate.passing import receive, send
from vbraille.translate.switching import Translator
from vbraille.translate.undefined import Undefined

if TYPE_CHECKING:
    from typing import BinaryIO

    from vbraille.translate.batches import Batch
    from vbraille.translate.switching import How


def main() -> None:
    """Translate until the input ends, as it does when the program ends that wants the cells."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever stops the program stops that one
    name, undefined, own, grade, switch = cast("How", receive(sys.stdin.buffer))
    table = BrailleTable(name, Undefined(undefined))
    translator = Translator(table, own, grade, switch=switch)
    batches: SimpleQueue[Batch] = SimpleQueue()
    # What is sent is taken at once, so that who sends never waits for a translation.
    Thread(target=_take, args=(sys.stdin.buffer, batches), daemon=True).start()
    while True:
        batch = batches.get()
        try:
            done = translated(batch, translator)
        except VbrailleError as error:
            done = error
        try:
            send(sys.stdout.buffer, done)
        except BrokenPipeError:
            os._exit(0)


def _take(stream: BinaryIO, batches: SimpleQueue[Batch]) -> None:
    try:
        while True:
            batches.put(cast("Batch", receive(stream)))
    except EOFError:
        os._exit(0)


if __name__ == "__main__":
    main()
