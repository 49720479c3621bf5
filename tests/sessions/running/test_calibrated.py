"""What was made up for in a device's actuators, in the journal of a session."""

from tests.sessions.sittings import Session, of
from vbraille.devices.calibration import Calibration, Tried
from vbraille.engine.batch import BatchEngine
from vbraille.sessions.record.folder import check

FOUND = Calibration("bench", 6, 10, (Tried(0, 1, "dead"),)).to_json()


class Calibrated(BatchEngine):
    """An engine that says so of its device."""

    calibration = FOUND


def test_each_run_keeps_what_was_made_up_for(tmp_path):
    session = Session(tmp_path / "s")
    session.sit(("read:", "stop"))
    sat = session.sit(engine=Calibrated)
    first, second = of(sat.events, "run")
    assert "calibration" not in first
    assert second["calibration"] == FOUND
    assert all(finding.good for finding in check(sat.record))
