"""What a calibration makes up for, in ticks that are compiled as in those of Python alone."""

import numpy as np

from tests.engine.lendable import Rig, Twin, assert_same_tick
from tests.engine.test_loop import picture
from vbraille.devices.calibration import Calibration, Tried
from vbraille.devices.wire.codec import Decoder, Levels
from vbraille.devices.wire.messages import Frame

ENOUGH, MOST, TOP = 120, 4000, 1023


def test_compiled_ticks_send_what_python_alone_sends_and_record_what_was_asked_for():
    rig = Rig()
    twin = Twin(rig)
    rows, columns = rig.device.display.shape
    found = Calibration(
        "bench",
        rows,
        columns,
        (Tried(0, 0, "dead"), Tried(0, 1, gain=0.5), Tried(rows - 1, 1, inverted=True, gain=0.8)),
    )
    shown = picture((1, 63, 21) * 8, mapping="sheared")
    for loop in (rig.loop, twin.loop):
        loop.device.correct(found)
        loop.show(shown, 0)
    messages, levels = Decoder(), Levels(rows * columns, TOP)
    compiled, differing = 0, 0
    # A machine that stalls has the actuators rest, and an inverted one set out again.
    for tick in range(MOST):
        if differing >= ENOUGH:
            break
        rig.way_mm = 60.0 + 40.0 * np.sin(tick / 60)
        chunk = rig.say()
        rig.put(chunk)
        record = rig.tick()
        compiled += rig.compiled
        assert_same_tick(record, twin.tick(int(record["time_ns"]), list(rig.asked), chunk))
        heard = rig.receive()
        assert heard == twin.sent
        rig.controller.receive(heard, rig.us)
        sent = [message for message in messages.feed(heard) if isinstance(message, Frame)]
        if rig.compiled and sent:
            asked = rig.loop.output
            wanted = np.rint(np.abs(found.scale()) * asked * TOP)
            wanted = np.where(found.scale() < 0, TOP - wanted, wanted)
            np.testing.assert_array_equal(levels.unpack(sent[-1].packed), wanted.reshape(-1))
            np.testing.assert_array_equal(record["frame"], asked.astype(np.float32))
            differing += bool((wanted != np.rint(asked * TOP)).any())
    assert compiled >= differing == ENOUGH
    rig.close()
