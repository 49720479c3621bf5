"""Polygons whose edges meet are found, however many edges there are."""

import doctest
import math
import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tiers import heavy
from vbraille.scene import intersections
from vbraille.scene.intersections import meeting_edges
from vbraille.scene.patterns import Polygon
from vbraille.scene.strokes import Stroke


def ring(number, wobble=0.0):
    angles = [2 * math.pi * n / number for n in range(number)]
    return tuple(
        (
            100 + (40 + wobble * math.sin(9 * a)) * math.cos(a),
            100 + (40 + wobble * math.sin(9 * a)) * math.sin(a),
        )
        for a in angles
    )


SHAPES = {
    "a bow tie": (((0, 0), (10, 10), (10, 0), (0, 10)), (1, 3)),
    "a spike that goes back over itself": (((0, 0), (10, 0), (5, 0), (5, 5)), (1, 2)),
    "a vertex on another edge": (((0, 0), (10, 0), (10, 10), (5, 0), (0, 10)), (1, 3)),
    "a vertex on another vertex": (
        ((0, 0), (5, 5), (10, 0), (10, 10), (5, 5), (0, 10)),
        (1, 4),
    ),
    "a star of one line": (
        tuple((math.cos(0.8 * math.pi * n), math.sin(0.8 * math.pi * n)) for n in range(5)),
        (1, 3),
    ),
    "a triangle": (((0, 0), (10, 0), (0, 10)), None),
    "an arrow with a notch": (((0, 0), (10, 5), (0, 10), (3, 5)), None),
    "a vertex in the middle of a straight edge": (((0, 0), (5, 0), (10, 0), (0, 10)), None),
    "many vertices": (ring(500, 5.0), None),
}


@pytest.mark.parametrize("name", SHAPES)
def test_edges_that_meet_are_found(name):
    vertices, edges = SHAPES[name]
    assert meeting_edges(vertices) == edges


@heavy
def test_a_crossing_among_very_many_edges_is_found_in_seconds():
    vertices = list(ring(100_000, 5.0))
    began = time.process_time()
    assert meeting_edges(tuple(vertices)) is None
    vertices[70_000], vertices[70_002] = vertices[70_002], vertices[70_000]
    first, second = meeting_edges(tuple(vertices))
    assert 69_990 < first < second < 70_010
    assert time.process_time() - began < 10


def test_edges_that_are_too_close_together_to_be_compared_are_refused():
    slanted = [(n * 1e-3 + (n % 2) * 70.0, n * 1e-3 + (n % 2) * 30.0) for n in range(20_000)]
    with pytest.raises(ValueError, match="edges so close together that they cannot be compared"):
        meeting_edges((*slanted, (-500.0, 500.0)))


def test_places_may_be_numbers_of_numpy():
    assert meeting_edges(tuple(map(tuple, np.array([(0, 0), (9, 9), (9, 0), (0, 9)])))) == (1, 3)


places = st.tuples(st.integers(0, 6), st.integers(0, 6))


@given(st.lists(places, min_size=3, max_size=9))
def test_few_edges_and_many_are_judged_alike(vertices):
    """What plain Python finds among few is what numpy finds, pair by pair."""
    if any(a == b for a, b in zip(vertices, vertices[1:] + vertices[:1], strict=True)):
        return
    slowly = next(intersections._slowly(tuple(vertices)), None)
    assert (slowly is None) == (intersections._quickly(tuple(vertices)) is None)


def test_a_polygon_that_crosses_itself_is_refused():
    with pytest.raises(ValueError, match="vertices make edges that cross or touch, those after"):
        Polygon(vertices_mm=((0, 0), (10, 10), (10, 0), (0, 10)), stroke=Stroke())


def test_examples():
    tried = doctest.testmod(intersections)
    assert tried.attempted
    assert not tried.failed
