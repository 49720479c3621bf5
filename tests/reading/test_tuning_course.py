"""A simulated chooser's preference is found, and a course is what its choices make of it."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tests.tiers import examples
from vbraille.config.settings import KNOBS
from vbraille.errors import InputError
from vbraille.reading.tuning_course import (
    CHOICES_PER_KNOB,
    ORDER,
    TuningCourse,
    from_json,
    to_json,
)
from vbraille.render import STRESS2, VBD

SHARE = st.floats(0, 1)
# Of what is tried: where two values are as near to what is liked, a sixteenth from an end, and the
# chooser takes the outer one, it is 0.0603 of it.
MOST_OFF = 0.0625
# Least and largest value that is tried, as the course has them for each of the two displays.
TRIED = {
    "stress2": {
        "texture": (0, 1),
        "contrast": (0.2, 1),
        "dot_width_mm": (1.3, 5.2),
        "dot_spacing_mm": (2.22, 6.66),
    },
    "vbd": {
        "texture": (0, 1),
        "contrast": (0.2, 1),
        "dot_width_mm": (1, 4),
        "dot_spacing_mm": (2.4, 7.2),
    },
}


def value(course, which):
    return course.knob.value(course.shown(which))


def complete(model, choose):
    course = TuningCourse(model)
    while not course.done:
        course = course.choose(choose(course))
    return course


def nearer_to(liked, noise=0.0, rng=None):
    """Choose whichever is nearer to what is liked of each knob, but for noise."""

    def choose(course):
        away = [abs(value(course, which) - liked[course.knob.key]) for which in (1, 2)]
        if rng is not None:
            low, high = TRIED[course.start.name][course.knob.key]
            away = [a + rng.normal(0, noise * (high - low)) for a in away]
        return 1 if away[0] <= away[1] else 2

    return choose


@examples(100)
@given(shares=st.lists(SHARE, min_size=4, max_size=4), model=st.sampled_from((STRESS2, VBD)))
@example(shares=[1 / 16] * 4, model=STRESS2)
@example(shares=[15 / 16] * 4, model=VBD)
def test_what_a_chooser_likes_is_found(shares, model):
    tried = TRIED[model.name]
    liked = {
        n: tried[n][0] + s * (tried[n][1] - tried[n][0]) for n, s in zip(tried, shares, strict=True)
    }
    course = complete(model, nearer_to(liked))
    assert [found.knob.key for found in course.found] == list(ORDER)
    for knob, found, least, most in course.found:
        low, high = tried[knob.key]
        assert abs(found - liked[knob.key]) <= MOST_OFF * (high - low) + 0.011
        assert knob.value(course.style) == found
        assert low <= least <= found <= most <= high
        assert least - 0.011 <= liked[knob.key] <= most + 0.011


def test_a_chooser_who_is_not_sure_comes_near_it():
    rng = np.random.default_rng(20090618)
    liked = {"texture": 0.6, "contrast": 0.9, "dot_width_mm": 2.2, "dot_spacing_mm": 4.5}
    away, held = [], []
    for _ in range(30):
        course = complete(STRESS2, nearer_to(liked, 0.1, rng))
        for knob, found, least, most in course.found:
            low, high = TRIED["stress2"][knob.key]
            away.append(abs(found - liked[knob.key]) / (high - low))
            held.append(least <= liked[knob.key] <= most)
    assert np.median(away) < 0.05  # of what is tried; by chance it would be some 0.3
    assert np.mean(held) >= 0.9  # 120 intervals of 95 %


def test_it_takes_seven_choices_a_knob_and_no_two_values_are_alike_or_a_world_apart():
    course = TuningCourse(STRESS2)
    for number in range(course.total):
        one, other = value(course, 1), value(course, 2)
        assert (one < other) == (number % 2 == 0)
        low, high = TRIED["stress2"][course.knob.key]
        assert 0.02 <= abs(one - other) / (high - low) <= 0.51
        course = course.choose(1)
    assert course.total == 4 * CHOICES_PER_KNOB == 28
    assert course.knob is None
    with pytest.raises(ValueError, match="every choice"):
        course.choose(1)
    assert course.shown(1) == course.shown(2) == course.style


@pytest.mark.parametrize("lower", [True, False])
def test_whoever_always_wants_more_or_less_gets_all_or_least(lower):
    def choose(course):
        return 1 if (value(course, 1) < value(course, 2)) == lower else 2

    for knob, found, least, most in complete(STRESS2, choose).found:
        assert found == TRIED["stress2"][knob.key][0 if lower else 1] == (least if lower else most)


@given(choices=st.lists(st.sampled_from((1, 2)), max_size=28))
def test_it_goes_on_from_what_was_kept_and_back_by_undo(choices):
    course = TuningCourse(STRESS2)
    for which in choices:
        again = course.choose(which)
        assert again.undo() == course
        course = again
    kept = from_json(to_json(course, "evening", "stress2"), STRESS2)
    assert kept == course
    assert (kept.style, kept.knob) == (course.style, course.knob)


def test_a_dot_never_becomes_wider_than_its_cell():
    crowded = STRESS2.style.replace(dot_spacing_mm=1.0, cell_gap_mm=2.0, dot_width_mm=2.0)
    model = type(STRESS2)("stress2", "STReSS²", STRESS2.display, crowded)
    for which in (1, 2):
        course = complete(model, lambda _, which=which: which)
        geometry = course.style.geometry
        assert geometry.dot_width_mm <= geometry.cell_pitch_mm
    assert KNOBS["dot_width_mm"].value(model.style) == 2.0


@pytest.mark.parametrize(
    "text", ["", "[]", "{}", '{"format": 1}', '{"format": 2, "start": {}, "choices": [3]}',
             '{"format": 2, "start": {"texture": 7}, "choices": []}', "[" * 5000],
)  # fmt: skip
def test_what_is_no_course_is_refused(text):
    with pytest.raises(InputError, match="cannot be gone on with"):
        from_json(text, STRESS2)
