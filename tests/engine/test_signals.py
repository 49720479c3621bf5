"""Pictures that answer: signals in the ticks of an engine, and frames made again from records."""

import numpy as np
import pytest

from tests.engine.planar import PLANE, Bench
from vbraille.engine.record import FLOATS, INTS, columns_of
from vbraille.engine.ticks import recall, replay
from vbraille.render import work
from vbraille.render.compiling import compile_scene
from vbraille.render.program import scratch_for
from vbraille.scene.patterns import Circle, Group, StraightLine
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.signals import Direction, Inverse, Product, Pulse, Speed, Switch, packed
from vbraille.scene.strokes import Along, Stroke
from vbraille.scene.textures import LinearGrating, SignalLevel, Uniform

CANVAS = Canvas(width_mm=200, height_mm=200)


def compiled(*elements, **signals):
    scene = Scene(canvas=CANVAS, elements=elements, signals=signals)
    return compile_scene(scene, PLANE)


def going(speed_mm_s, stops_s):
    """A hand that goes to the right and then stands."""
    return lambda t_s: (20.0 + speed_mm_s * min(t_s, stops_s), 50.0, 0.0)


def test_a_texture_comes_250_ms_after_the_hand_has_stopped_and_rises_in_as_long():
    """Lévesque 2009, eq. 9.7, measured from frames alone."""
    bench = Bench(going(40.0, 1.0), rate_hz=1000)
    bench.engine.show(compiled(Uniform(factor="slow"), slow=Speed()), 1)
    ticks = bench.run(2.0)
    shown = ticks["frame"][:, 0, 0]
    slow = np.hypot(ticks["vx_mm_s"], ticks["vy_mm_s"]) < 10.0
    below = np.flatnonzero(slow & (np.arange(slow.size) > 500))[0]
    assert not shown[600:below].any()
    assert np.flatnonzero(shown[below:] > 0)[0] == pytest.approx(250, abs=2)
    assert np.flatnonzero(shown[below:] >= 1)[0] == pytest.approx(500, abs=2)
    assert np.abs(np.diff(shown[600:])).max() < 0.006


SWITCH = Switch(levels=(1.0, 0.0), fade_s=0.1)


def test_a_switch_fades_at_once_into_the_other_layer_and_wakes_what_rests():
    layers = (Uniform(level=0.25, factor="view"), Uniform(level=1.0, factor="other"))
    program = compiled(*layers, view=SWITCH, other=Inverse(of="view"))
    bench = Bench(lambda _: (50.0, 50.0, 0.0), rate_hz=1000)
    bench.engine.show(program, 1)
    assert bench.run(0.5)["frame"][-1] == pytest.approx(0.25)
    for wait_s in (0.0, 6.0):
        bench.run(wait_s or 0.001)
        before = bench.engine.output[0, 0]
        bench.engine.switches = packed({1: 0 if bench.engine.switches else 1}, {"view": SWITCH})
        shown = bench.run(0.4)["frame"][:, 0, 0]
        assert np.flatnonzero(np.abs(shown - before) > 1e-9)[0] <= 4  # ms
        assert np.abs(np.diff(shown)).max() <= 0.02
    assert shown[-1] == pytest.approx(0.25)


def test_eight_signals_are_recorded_and_frames_made_again_from_any_tick_bit_for_bit():
    signals = {
        "slow": Speed(below_mm_s=15, transition_mm_s=20, delay_s=0.05),
        "right": Direction(),
        "axis": Direction(angle_deg=90, axis=True, at_rest="low"),
        "view": SWITCH,
        "pulse": Pulse(period_s=0.3),
        "both": Product(of=("right", "pulse")),
        "not": Inverse(of="right"),
    }
    along = Along(ridge_mm=3, velocity_mm_s=40, velocity_by="right")
    program = compiled(
        Group(
            operation="blend",
            parts=(LinearGrating(ridge_mm=3), LinearGrating(ridge_mm=5, wave_angle_deg=90)),
            by=SignalLevel(name="axis"),
        ),
        Circle(center_mm=(70, 50), radius_mm=9, stroke=Stroke(along=along), factor="view"),
        StraightLine(start_mm=(0, 40), end_mm=(150, 60), stroke=Stroke(), factor="both"),
        Circle(center_mm=(40, 50), radius_mm=5, stroke=Stroke(), factor="not"),
        **signals,
    )
    rng = np.random.default_rng(4)
    knots = np.cumsum(rng.uniform(-25, 40, (60, 2)), axis=0) * 0.05 + (20, 50)

    def hand(t_s):
        x, y = (np.interp(t_s, np.arange(60) * 0.05, knots[:, axis]) for axis in (0, 1))
        return float(x), float(y), 0.0

    bench = Bench(hand, rate_hz=1000)
    bench.engine.show(program, 1)
    blocks = []
    for press in range(6):
        bench.engine.switches = packed({1: press % 2}, signals)
        blocks.append(bench.run(0.45))
    ticks = np.concatenate(blocks)
    values = np.stack([ticks[name] for name in FLOATS[-8:]], axis=1)
    assert (np.ptp(values, axis=0) > 0.5).all()
    sent = np.array(bench.sent)
    for begin in (1, 700, 1703):
        some = ticks[begin:]
        ints, floats, _ = columns_of(np.concatenate([some, some[:1]]))  # room for one more
        frames = np.zeros((ints.shape[0], *PLANE.shape))
        room = np.zeros((3, *PLANE.shape))
        room[:2] = sent[begin - 1]
        at, scratch = np.zeros(work.AT), scratch_for(PLANE.shape)
        ints, floats = ints[: some.size].copy(), floats[: some.size].copy()
        assert ints.shape[1] == len(INTS)
        replay(program.numbers, program.table, scratch, ints, floats, at, *room, frames)
        faded = np.flatnonzero(some["share"] == 1.0)[0]
        np.testing.assert_array_equal(frames[faded : some.size], sent[begin + faded :])


def test_signals_are_computed_again_from_records_without_them():
    signals = {"slow": Speed(), "right": Direction(), "pulse": Pulse(period_s=0.3)}
    parts = [Uniform(factor=name) for name in signals]
    program = compiled(*parts, **signals)
    bench = Bench(going(40.0, 1.0), rate_hz=1000)
    bench.engine.show(program, 1)
    ticks = bench.run(1.7)
    ints, floats, _ = columns_of(np.concatenate([ticks, ticks[:1]]))
    ints, floats = ints[:-1].copy(), floats[:-1].copy()
    known = floats.copy()
    floats[:, FLOATS.index("signal_1") :] = np.nan
    recall(program.numbers, ints, floats, np.zeros(work.AT))
    np.testing.assert_array_equal(floats[1:], known[1:])


def test_a_part_whose_signal_is_0_changes_nothing_and_hides_nothing():
    below = LinearGrating(ridge_mm=3)
    over = (
        Uniform(level=0.5, inverted=True, factor="off"),
        Circle(center_mm=(50, 50), radius_mm=9, stroke=Stroke(width_mm=8), factor="off"),
    )
    off = Switch(levels=(0.0, 1.0))
    x = np.linspace(30, 70, 200)
    alone = compiled(below).poses(x, np.full(200, 50.0))[1]
    program = compiled(below, *over, off=off)
    np.testing.assert_array_equal(program.poses(x, np.full(200, 50.0))[1], alone)
    on = program.poses(x, np.full(200, 50.0), switches=packed({1: 1}, {"off": off}))[1]
    assert np.abs(on[1:] - alone[1:]).max() > 0.4
