"""What a calibration makes up for, in ticks that are compiled as in those of Python alone."""

import numpy as np

from tests.engine.steady import PICTURES, TOP, Twin, assert_same_tick, levels_of
from vbraille.devices.calibration import Calibration, Tried
from vbraille.devices.serial.wire import Decoder

ENOUGH, MOST = 120, 4000


def test_compiled_ticks_send_what_python_alone_sends_and_record_what_was_asked_for(rigs):
    rig = rigs()
    twin = Twin(rig)
    rows, columns = rig.device.display.shape
    found = Calibration(
        "bench",
        rows,
        columns,
        (Tried(0, 0, "dead"), Tried(0, 1, gain=0.5), Tried(rows - 1, 1, inverted=True, gain=0.8)),
    )
    for loop in (rig.loop, twin.loop):
        loop.device.correct(found)
        loop.show(PICTURES[0], 0)
    messages = Decoder()
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
        sent = levels_of(messages.feed(heard))
        if rig.compiled and sent:
            asked = rig.loop.output
            wanted = np.rint(np.abs(found.scale()) * asked * TOP)
            wanted = np.where(found.scale() < 0, TOP - wanted, wanted)
            np.testing.assert_array_equal(sent[-1], wanted.reshape(-1))
            np.testing.assert_array_equal(record["frame"], asked.astype(np.float32))
            differing += bool((wanted != np.rint(asked * TOP)).any())
    assert compiled >= differing == ENOUGH
