"""Frames as bytes: the same as the contract's header says, and thinned out evenly."""

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tests.live.headers import FRAME, MAP
from tests.live.pages import read_frame
from tests.tiers import examples
from vbraille.live.framing import NO_DEFLECTIONS, FrameHeader, frame_bytes, map_bytes, thinned
from vbraille.live.messages import FRAME_KIND, MAP_KIND, MOST_SAMPLES, VERSION


def test_each_number_stands_where_the_header_has_it(rng):
    values = {name: float(n + 1) for n, name in enumerate(FrameHeader._fields)}
    whole = {name: int(values[name]) for name in ("flags", "state", "line", "part", "late")}
    deflections = rng.random((2, 3), np.float32)
    samples = rng.random((4, 3), np.float32)
    read = read_frame(frame_bytes(FrameHeader(**values | whole), deflections, samples))
    assert read.header["kind"] == FRAME_KIND
    assert read.header["version"] == VERSION
    assert {name: read.header[name] for name in FrameHeader._fields} == values
    np.testing.assert_array_equal(read.deflections, deflections)
    np.testing.assert_array_equal(read.samples, samples)
    assert set(FRAME.names or ()) - set(FrameHeader._fields) == {
        "kind", "version", "samples", "rows", "columns", "signals",
    }  # fmt: skip


def test_a_frame_of_nothing_is_its_header():
    frame = frame_bytes(FrameHeader(), NO_DEFLECTIONS)
    assert len(frame) == FRAME.itemsize
    assert math.isnan(read_frame(frame).header["x_mm"])


def test_deflections_begin_where_a_page_can_look_at_them_as_numbers():
    assert FRAME.itemsize % 8 == 0


def test_numbers_too_large_begin_anew():
    assert read_frame(frame_bytes(FrameHeader(line=1 << 32, part=-1))).header["line"] == 0


def test_a_map_says_its_form_and_size():
    for form in ("png", "svg"):
        (header,) = np.frombuffer(map_bytes(b"file", form), MAP, 1)
        assert header.tolist() == (MAP_KIND, form == "svg", 0, 4)


@examples(100)
@given(st.integers(0, 20_000))
def test_thinning_keeps_the_newest_and_is_even(count):
    kept = thinned(count)
    assert kept.size == min(count, MOST_SAMPLES)
    if count:
        assert kept[-1] == count - 1
        steps = np.diff(kept)
        assert not steps.size or steps.max() - steps.min() <= 1
