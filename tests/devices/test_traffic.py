"""Random traffic: a conversation goes by the table, and says what may be said in each stage."""

import random
from contextlib import suppress

import pytest

from tests.devices.bench import DOWN_BYTES, HALF, REST, Bench, shown
from tests.devices.serial.test_transitions import AFTER_THE_START, ROWS, watched
from tests.tiers import by_tier
from vbraille.devices.serial.conversation import Stage
from vbraille.devices.serial.wire import (
    PLACED,
    RESTING,
    Error,
    Frame,
    Hello,
    Levels,
    State,
    Watchdog,
    encode,
    enframe,
)
from vbraille.devices.serial.wire import Rest as RestMessage
from vbraille.errors import DeviceError
from vbraille.simulation.firmware import Controller


class Traffic:
    """All that may happen to a device, at random."""

    def __init__(self, seed):
        self.chance = random.Random(seed)
        self.made = Bench()
        self.device = watched(self.made)

    def step(self):
        made, chance = self.made, self.chance
        acts = self.stall, self.line, self.say, self.port, self.want, self.stranger, self.idle
        act = self.read if chance.random() < 0.4 else chance.choice(acts)
        act()
        if chance.random() < 0.4:
            made.deaf = made.mute = False
            made.room = DOWN_BYTES
            if not made.plugged:
                made.plug()
        if chance.random() < 0.1:
            self.stranger(rate_hz=1000)

    def read(self):
        frame = self.chance.choice((HALF, HALF, REST))
        for _ in range(self.chance.choice((1, 1, 5, 5, 30, 120))):
            with suppress(DeviceError):
                self.made.run(self.device, 1, frame)
        if self.device.conversation.stage is Stage.FAILED:
            self.device.close()
            self.check()
            self.made = Bench()
            self.device = watched(self.made)

    def stall(self):
        self.made.us += self.chance.choice((1, 45, 70, 150, 600)) * 1000

    def idle(self):
        """Have nothing to feel, as if for a long time."""
        self.device.conversation.frames.felt_ns -= 5_000_000_000
        with suppress(DeviceError):
            self.made.run(self.device, self.chance.choice((1, 5, 60)), REST)

    def line(self):
        what = self.chance.choice(("deaf", "mute", "room"))
        setattr(self.made, what, 0 if what == "room" else True)

    def say(self):
        chance = self.chance
        flags = chance.choice((0, PLACED, PLACED | RESTING, RESTING, 0x0F, 0x0B))
        sequence = chance.choice((chance.randrange(1 << 16), self._newest()))
        self.made.put(
            chance.choice(
                (
                    encode(
                        State(
                            9,
                            self.made.us,
                            7,
                            sequence,
                            flags,
                            chance.randrange(256),
                            None,
                            0,
                            0,
                            0,
                        )
                    ),
                    encode(Watchdog(chance.randrange(3), 0)),
                    encode(Error(chance.choice((3, 200, 200, 200)), "so it is")),
                    encode(shown()),
                    enframe(b"\x81\x05"),
                    bytes(chance.randrange(256) for _ in range(20)),
                )
            )
        )

    def _newest(self):
        return self.device.conversation.frames.sequence

    def port(self):
        if self.made.plugged:
            self.made.unplug()
        else:
            self.made.plug()

    def stranger(self, rate_hz=500):
        if self.made.controller.info.rate_hz != rate_hz:
            self.made.controller = Controller(shown(rate_hz=rate_hz))

    def want(self):
        self.chance.choice((self.device.rest, self.device.set_zero))()

    def check(self):
        """FRAMEs go out where they may, and nothing is said to a stranger."""
        levels = Levels(60, 1023)
        for stage, said in self.device.conversation.said:
            if isinstance(said, Frame):
                assert stage in (Stage.LIVE, Stage.AT_REST)
                assert stage is Stage.LIVE or not levels.unpack(said.packed).any()
            elif isinstance(said, Hello):
                assert stage in (Stage.GREETING, Stage.ASKED)
            else:
                assert isinstance(said, RestMessage)
                assert stage not in (Stage.STRANGER, Stage.GONE)
        return self.device.conversation.taken


@pytest.mark.no_cover
def test_nothing_else_happens_in_random_traffic():
    seen = set()
    for seed in range(by_tier(15, 40, 4000)):
        traffic = Traffic(seed)
        for _ in range(150):
            before = traffic.device.conversation
            traffic.step()
            assert before.steady <= (before.stage is Stage.LIVE)
            seen |= {row[:2] for row in before.taken}
        traffic.device.close()
        seen |= {row[:2] for row in traffic.check()}
    assert seen <= set(ROWS)
    assert len(seen) > 0.6 * len(AFTER_THE_START), set(AFTER_THE_START) - seen
