"""What the actuators are told, and that the device has it."""

import numpy as np

from tests.devices.bench import REST, Bench
from vbraille.devices.serial.wire import Frame, Levels


def test_levels_are_those_of_the_formula(rng):
    inverted, enabled = (rng.integers(0, 2, 60) for _ in range(2))
    gain = rng.integers(0, 256, 60)
    made = Bench(
        top_level=150,
        inverted=bytes(inverted.tolist()),
        enabled=bytes(enabled.tolist()),
        gain=bytes(gain.tolist()),
    )
    device = made.open()
    made.settle(device)
    for frame in (np.ones((6, 10)), rng.random((6, 10)), np.full((6, 10), 1 / 3)):
        made.run(device, 3, frame)
        levels = np.rint(frame.reshape(-1) * gain / 255 * 150) * enabled
        levels = np.where(inverted, 150 - levels, levels)
        assert made.controller.levels.tolist() == levels.tolist()
    device.close()
    made.pause(0.03)
    assert made.controller.levels.tolist() == (150 * inverted).tolist()


def test_no_actuator_is_moved_faster_than_it_may():
    made = Bench(largest_slew_per_s=100)  # a tenth in a millisecond
    device = made.open()
    made.settle(device, REST)
    ways = []
    for target in (1.0, 0.0, 0.25):
        levels = []
        for _ in range(13):
            made.run(device, 1, np.full((6, 10), target))
            made.hear()
            levels.append(Levels(60, 1023).unpack(made.sent[-1].packed)[0] / 1023)
        ways.append(np.round(levels, 2).tolist())
    up = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.0, 1.0, 1.0]
    assert ways[0] == up
    assert ways[1] == [0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0.0, 0.0, 0.0, 0.0]
    assert ways[2] == [0.1, 0.2, *[0.25] * 11]
    # Late, it goes no further, for it would go there at once.
    made.us += 30_000
    made.run(device, 1, np.ones((6, 10)))
    made.hear()
    assert Levels(60, 1023).unpack(made.sent[-1].packed)[0] == round(0.35 * 1023)
    # Two frames at one time are no way round it.
    device.write(np.ones((6, 10)))
    made.hear()
    assert Levels(60, 1023).unpack(made.sent[-1].packed)[0] == round(0.35 * 1023)
    device.close()


def test_the_way_back_from_rest_is_no_faster():
    made = Bench(largest_slew_per_s=100)
    device = made.open()
    made.settle(device, np.ones((6, 10)))
    made.run(device, 20, np.ones((6, 10)))
    made.mute = True
    made.run(device, 150, np.ones((6, 10)))
    made.mute = False
    made.sent.clear()
    made.settle(device, np.ones((6, 10)))
    made.hear()
    levels = [Levels(60, 1023).unpack(e.packed)[0] for e in made.sent if isinstance(e, Frame)]
    assert levels[0] == 0
    assert levels[-4:] == [102, 205, 307, 409]
    device.close()


def test_sequences_count_on_and_wrap():
    made = Bench(rows=1, columns=1, inverted=b"\0", gain=b"\xff", enabled=b"\1")
    device = made.open()
    frame = np.ones((1, 1))
    made.run(device, 10, frame)
    sequences = [event.sequence for event in made.sent if isinstance(event, Frame)]
    assert sequences == list(range(1, len(sequences) + 1))
    device.conversation.frames.sequence = 65_530  # as if so many had been sent
    made.run(device, 20, frame)
    sequences = [event.sequence for event in made.sent if isinstance(event, Frame)]
    sequences = sequences[sequences.index(65_531) :]
    assert sequences[:8] == [65_531, 65_532, 65_533, 65_534, 65_535, 0, 1, 2]
    assert set(np.diff(sequences[5:])) == {1}
    device.close()


def test_a_frame_is_acknowledged_by_the_states():
    made = Bench()
    device = made.open()
    assert device.acknowledged_ns is None
    made.settle(device)
    assert device.acknowledged_ns is None
    made.deaf = True
    made.pause(0.003)
    device.read()
    assert device.acknowledged_ns is None
    made.deaf = False
    made.pause(0.001)
    device.read()
    assert device.acknowledged_ns == 4_000_000
    made.pause(0.001)
    device.read()
    assert device.acknowledged_ns == 4_000_000
    made.mute = True
    made.run(device, 150)  # what is not sent is not acknowledged
    made.mute = False
    made.pause(0.005)
    device.read()
    assert device.acknowledged_ns is None
    device.close()
