"""Polygons whose edges meet are found, however many edges there are."""

import math
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vbraille.scene.patterns import meeting_edges


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
    "a vertex on another edge": (((0, 0), (10, 0), (10, 10), (5, 0), (0, 10)), (1, 3)),
}


@pytest.mark.parametrize("name", SHAPES)
def test_edges_that_meet_are_found(name):
    vertices, edges = SHAPES[name]
    assert meeting_edges(vertices) == edges


def test_a_crossing_among_many_edges_is_found_in_seconds():
    vertices = list(ring(5_000, 5.0))
    began = time.process_time()
    assert meeting_edges(tuple(vertices)) is None
    vertices[700], vertices[702] = vertices[702], vertices[700]
    first, second = meeting_edges(tuple(vertices))
    assert 690 < first < second < 710
    assert time.process_time() - began < 5


def test_too_many_vertices_are_refused():
    with pytest.raises(ValueError, match="there can be 20000"):
        meeting_edges(ring(20_001))


places = st.tuples(st.integers(0, 6), st.integers(0, 6))


@given(st.lists(places, min_size=3, max_size=9))
def test_edges_meet_as_they_do_pair_by_pair(vertices):
    number = len(vertices)
    edges = [(vertices[n], vertices[(n + 1) % number]) for n in range(number)]
    if any(a == b for a, b in edges):
        return
    before = [edges[n - 1] for n in range(number)]
    back = any(
        turn(a, b, d) == 0 and (a[0] - b[0]) * (d[0] - b[0]) + (a[1] - b[1]) * (d[1] - b[1]) > 0
        for (a, b), (_, d) in zip(before, edges, strict=True)
    )
    crossed = any(
        turn(*edges[i], edges[j][0]) * turn(*edges[i], edges[j][1]) <= 0
        and turn(*edges[j], edges[i][0]) * turn(*edges[j], edges[i][1]) <= 0
        and boxes_meet(edges[i], edges[j])
        for i in range(number)
        for j in range(i + 2, number - (i == 0))
    )
    assert (meeting_edges(tuple(vertices)) is not None) == (back or crossed)


def turn(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def boxes_meet(one, other):
    return all(
        max(min(a, b), min(c, d)) <= min(max(a, b), max(c, d))
        for a, b, c, d in zip(*one, *other, strict=True)
    )
