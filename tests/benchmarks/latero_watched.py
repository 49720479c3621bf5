"""A Latero that says, each time its blades come to rest, how long that took since the host's last.

A line for each: milliseconds from the last FULL of the host with anything to feel until all blades
were at rest, and until motor power was off as well. The host is the address that has sent most
since the last time; the watchdog has another port.
"""

from __future__ import annotations

import time
from collections import Counter

from vbraille.engine.realtime import come_first
from vbraille.simulation.laterosim import LateroCarriage, LateroSimulator
from vbraille.simulation.specs import parse_hand

_PRIORITY = 41


class Watched(LateroSimulator):
    """The simulated Latero, which notes who has sent what."""

    def __init__(self) -> None:
        super().__init__(
            LateroCarriage(parse_hand("sweep:60"), 8.4), say=lambda _: None, port=0, wait_s=0.0
        )
        self._felt: dict[tuple[str, int], int] = {}  # when each client last showed anything
        self._asked: Counter[tuple[str, int]] = Counter()
        self._rested_ns: int | None = None
        self._armed = False

    def _note(self, client: tuple[str, int], now_us: int) -> None:
        super()._note(client, now_us)
        now_ns = time.monotonic_ns()
        self._asked[client] += 1
        if not self.board.at_rest:
            self._felt[client] = now_ns
            self._armed = self._armed or self._asked[client] > 200
            self._rested_ns = None
            return
        if not self._armed:
            return
        self._rested_ns = self._rested_ns or now_ns
        if not self.board.powered or now_ns - self._rested_ns > 500_000_000:
            host = self._asked.most_common(1)[0][0]
            rest_ms, off_ms = ((at - self._felt[host]) / 1e6 for at in (self._rested_ns, now_ns))
            print(rest_ms, off_ms, flush=True)
            self._asked.clear()
            self._felt.clear()
            self._armed, self._rested_ns = False, None


def main() -> None:
    """Answer until it is killed."""
    watched = Watched()
    print(watched.spec, flush=True)
    come_first(_PRIORITY)
    watched.run(lambda: False)


if __name__ == "__main__":
    main()
