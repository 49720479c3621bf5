"""A style that is changed by the names of its fields."""

import inspect
from dataclasses import fields

import pytest

from vbraille.braille.geometry import Geometry
from vbraille.errors import InputError
from vbraille.reading.opening import OpenDevice
from vbraille.render import VBD, BrailleStyle, Tuning
from vbraille.render.braille.style import StyleChanges

PARTS = ("tuning", "geometry")


def values(style):
    """Values of all fields by which a style can be changed."""
    own = {field.name: getattr(style, field.name) for field in fields(style)}
    return own | {
        field.name: getattr(own[part], field.name) for part in PARTS for field in fields(own[part])
    }


def test_each_field_is_changed_by_its_name_and_no_other():
    for name in ("texture", "dot_width_mm", "first_row"):
        value = {"texture": 0.5, "dot_width_mm": 1.5, "first_row": 0}[name]
        changed = values(VBD.style.replace(**{name: value}))
        differing = {one for one, was in values(VBD.style).items() if changed[one] != was}
        assert differing - set(PARTS) == {name}


def test_a_misspelt_field_is_refused_at_the_call_with_the_nearest_name():
    for wrong, right in {
        "texure": "texture",
        "dot_width": "dot_width_mm",
        "maping": "mapping",
    }.items():
        with pytest.raises(InputError, match=f"a style has no {wrong}; the nearest is {right}$"):
            VBD.style.replace(**{wrong: 0.5})


def test_a_type_checker_knows_each_field_that_can_be_changed():
    known = {
        field.name: field.type
        for part in (BrailleStyle, Tuning, Geometry)
        for field in fields(part)
    }
    assert StyleChanges.__annotations__.keys() == known.keys()
    for name, hint in StyleChanges.__annotations__.items():
        assert hint.__forward_arg__ == known[name]
    for call, name in (
        (BrailleStyle.replace, "changes"),
        (OpenDevice.tune, "turned"),
    ):
        assert inspect.signature(call).parameters[name].annotation == "Unpack[StyleChanges]"
