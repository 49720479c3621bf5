"""A presenter takes any program: a string as a protocol has it, and a tactile picture as well."""

import numpy as np

from tests.sessions.sittings import MINI
from vbraille.devices import open_device
from vbraille.engine.batch import BatchEngine
from vbraille.render import MODELS
from vbraille.render.compiling import compile_scene
from vbraille.scene.patterns import Circle
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.strokes import Stroke
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.record import events
from vbraille.sessions.record.journal import Tie
from vbraille.sessions.record.traces import read_trace
from vbraille.sessions.running.presenters import OnDevice, Presentation, presentation_of
from vbraille.simulation.specs import device_spec, steering_of
from vbraille.simulation.steering import ReadLine

ARRAY = MODELS["vbd"].display
DISC = Scene(
    canvas=Canvas(width_mm=200.0, height_mm=40.0),
    elements=(Circle(center_mm=(100.0, 0.0), radius_mm=15.0, stroke=Stroke(width_mm=4.0)),),
)


def present(folder, presentation):
    """Present something to a hand that sweeps, and give the notices and the frames of it."""
    steering = steering_of("sim")
    device = open_device(device_spec("sim", "sweep:150", 1, steering), ARRAY)
    engine = BatchEngine(device, poll_ticks=500)
    presenter = OnDevice(
        engine, ARRAY.span_mm, folder, keeps=True, tie=lambda: Tie(0, 0), steering=steering
    )
    name = presenter.open(1, 0)
    presenter.poll()
    presenter.show(presentation)
    if presentation.end_mm is None:
        steering.give(ReadLine(180.0))  # a person's hand goes over a picture by itself
    notices = [notice for _ in range(8) for notice in presenter.poll()]
    felt = presenter.explorations[0]
    presenter.withdraw()
    presenter.close()
    return notices, felt, read_trace(folder / name).ticks


def test_a_string_is_touched_and_read_to_its_end(tmp_path):
    protocol = parse_protocol(MINI, "p.toml")
    stimulus = make_plan(protocol, "P1", 1).trials[0].stimuli[0]
    notices, felt, ticks = present(tmp_path, presentation_of(protocol, stimulus, stimulus.tuning))
    assert [notice.kind for notice in notices][:2] == [events.Contact, events.Read]
    assert np.ptp(felt.frames) > 0
    assert set(ticks["line"].tolist()) == {0, 1}


def test_a_picture_is_felt_where_it_is_and_ended_by_a_key_alone(tmp_path):
    notices, felt, ticks = present(tmp_path, Presentation(compile_scene(DISC, ARRAY)))
    assert not {notice.kind for notice in notices} & {events.Contact, events.Read}
    frames = felt.frames.reshape(len(felt.frames), -1)
    moved = (frames != frames[0]).any(axis=1)
    assert moved.any()
    assert np.abs(felt.x_mm[moved] - 100.0).max() < 15.0 + ARRAY.span_mm
    assert set(ticks["line"].tolist()) == {0, 1}
