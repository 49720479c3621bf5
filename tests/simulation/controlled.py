"""A simulated controller on a bench: what is sent to it, what it says, and its timer."""

from tests.packing import packed as packed_levels
from vbraille.devices.serial.wire import (
    VERSION,
    CountSign,
    Decoder,
    Encoder,
    Frame,
    Info,
    RestSide,
    State,
    TurnSign,
    YCountSign,
    encode,
)
from vbraille.simulation.firmware import Controller

TOP = 1000  # 10 bits could say more
INFO = Info(
    version=VERSION,
    rows=2,
    columns=3,
    column_pitch_nm=1_200_000,
    row_pitch_nm=1_800_000,
    rest_side=RestSide.RIGHT,
    top_level=TOP,
    rate_hz=1000,
    largest_slew_per_s=0,
    travel_um=300_000,
    encoder=Encoder.ABSOLUTE,
    counts_per_m=200_000,
    count_sign=CountSign.RIGHTWARD,
    count_bits=16,
    left_stop_count=60_000,
    name="Bench",
    firmware="0.3",
    inverted=bytes((0, 0, 0, 1, 1, 1)),
    gain=b"\xff" * 6,
    enabled=b"\1" * 6,
    buttons=8,
    knobs=2,
    contactor_width_nm=0,
    contactor_height_nm=0,
    height_um=200_000,
    y_counts_per_m=100_000,
    y_count_sign=YCountSign.AWAY,
    far_stop_count=10,
    counts_per_turn=4096,
    turn_sign=TurnSign.CLOCKWISE,
    straight_count=4090,
)
REST = [0, 0, 0, TOP, TOP, TOP]
SWING = [TOP, 500, 0, 0, 500, TOP]


def packed(levels):
    return packed_levels(levels, TOP)


class Bench:
    """A controller, what it says, and a timer that ticks each millisecond when told to."""

    def __init__(self, info=INFO, now_us=10_000_000, made=Controller):
        self.controller = made(info)
        self.decoder = Decoder()
        self.now_us = now_us
        self.way_mm = 0.0
        self.sequence = 0

    def send(self, *messages):
        """Send messages to it; its answers."""
        return self.send_bytes(b"".join(map(encode, messages)))

    def send_bytes(self, chunk):
        return self.decoder.feed(self.controller.receive(chunk, self.now_us))

    def frame(self, levels=SWING):
        self.sequence = (self.sequence + 1) & 0xFFFF
        return self.send(Frame(self.sequence, packed(levels)))

    def show(self, levels=SWING):
        """Show levels, from rest if it is there; its answers."""
        heard = []
        if self.controller.at_rest:  # which it leaves at a tick
            heard = [*self.frame(REST), *without_states(self.tick())]
        return [*heard, *self.frame(levels)]

    def tick(self, milliseconds=1):
        """Let time pass; what it says meanwhile."""
        heard = []
        for _ in range(milliseconds):
            self.now_us += 1000
            heard += self.decoder.feed(self.controller.tick(self.now_us, self.way_mm))
        return heard

    def state(self):
        """STATE of the controller after another millisecond."""
        *_, state = self.tick()
        return state

    @property
    def levels(self):
        return self.controller.levels.tolist()


def without_states(heard):
    return [message for message in heard if not isinstance(message, State)]
