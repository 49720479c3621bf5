"""What is kept of a device's actuators, in the host process: made up for, and told."""

import json
import select
import time

import numpy as np
import pytest

from tests import drivers
from tests.engine.test_loop import info
from vbraille.devices.calibration import Calibration, Tried
from vbraille.devices.calibrations import path_of, save
from vbraille.engine.host import Host
from vbraille.errors import InputError

PATIENCE_S = 60.0
FOUND = Tried(2, 3, inverted=True)


@pytest.fixture
def settings(tmp_path, monkeypatch):
    """Path of a settings file, and a driver that logs what it is to send."""
    environment = drivers.install(tmp_path)
    monkeypatch.setenv("PYTHONPATH", environment["PYTHONPATH"])
    path = tmp_path / "mine.toml"
    monkeypatch.setenv("VBRAILLE_SETTINGS", str(path))
    return path


def watch(host, ticks):
    """Records of so many ticks."""
    records, end = [], time.monotonic() + PATIENCE_S
    while sum(polled.size for polled in records) < ticks:
        assert time.monotonic() < end
        records.append(host.poll())
        select.select([], [], [], 0.005)
    return np.concatenate(records)


def test_the_host_makes_up_for_what_is_kept_and_records_what_was_asked_for(tmp_path, settings):
    display = info()
    found = Calibration(display.name, display.rows, display.columns, (FOUND,))
    save(settings, found)
    log = tmp_path / "frames"
    with Host(f"logged:{log}", display, 26) as host:
        assert host.calibration == found.to_json()
        assert json.loads(json.dumps(host.calibration)) == host.calibration
        records = watch(host, 200)
    assert not records["frame"].any()
    sent = np.fromfile(log).reshape(-1, display.rows, display.columns)[:, 2, 3]
    assert sent.max() == 1.0
    assert sent[0] <= 0.011
    assert sent[-1] == 0.0
    assert np.abs(np.diff(sent)).max() <= 0.011  # it goes over, and back, in a tenth of a second


def test_nothing_is_made_up_for_where_nothing_is_kept(tmp_path, settings):
    assert not settings.exists()
    with Host(f"logged:{tmp_path / 'frames'}", info(), 26) as host:
        assert host.calibration is None


def test_what_is_kept_and_cannot_be_used_is_one_sentence(tmp_path, settings):
    path = path_of(settings, info().name)
    path.write_text("device = 1")
    with (
        pytest.raises(InputError, match="device is 1; it must be a string"),
        Host(f"logged:{tmp_path / 'frames'}", info(), 26),
    ):
        pass
