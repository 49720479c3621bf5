"""What is said of what OpenLatero's files hold: left out, or shown differently."""

import pytest

from tests.scene.openlatero.files import (
    circle,
    fill,
    grating,
    line,
    polygon,
    stroke,
    texture,
    waves,
)
from vbraille.scene.patterns import Circle


def layers(over):
    """A part that overwrites a circle."""
    return (
        f'<Pattern type="Group"><operation type="overwrite"/>{circle(stroke() + fill(grating()))}'
        f"{over}</Pattern>"
    )


LEFT_OUT = {
    "an unknown type": ('<Pattern type="Cirkel"/>', 'type of this pattern is "Cirkel"'),
    "an unknown texture": (texture("Linear"), 'subtype of this texture is "Linear"'),
    "an image without a texture": ('<Pattern type="Image"><mask/></Pattern>', "has no texture"),
    "an image without a picture": (
        f'<Pattern type="Image">{grating()}<mask/></Pattern>', "picture is not named",
    ),
    "a picture that is not there": (
        f'<Pattern type="Image">{grating()}<mask><imgfile>no.png</imgfile></mask></Pattern>',
        "there is no file no.png",
    ),
    "no ridges": (grating(ridge=0), "its ridges are 0 mm"),
    "no ridges in a double grating": (
        texture("DoubleLinearGrating", "<secondary_scale>0</secondary_scale>"), "are below 0.05 mm",
    ),
    "two vertices": (polygon(stroke(), ("1,1", "9,9")), "vertices are 2; there must be 3 or more"),
    "a line without a length": (line(stroke(), ("5,5", "5,5")), "a line needs two places"),
    "a circle without a radius": (circle(stroke(), radius=0), "radius is 0 mm"),
    "no stroke and no fill": (circle(stroke(width=0)), "nothing of it can be felt"),
    "no dots": ('<Pattern type="Dots"/>', "it has no dots"),
    "a blend of two": (
        f'<Pattern type="Group"><operation>blend</operation>{circle()}{line()}</Pattern>',
        "a blend is of 3 patterns, and this has 2",
    ),
    "half a toggle": (f'<Pattern type="Toggle">{circle()}</Pattern>', "a toggle is of 2 patterns"),
    "sounds": ('<Pattern type="Audio"><sound/><sound/></Pattern>', "its sound is not named"),
    "a product with nothing": (
        f'<Pattern type="Group"><operation>multiply</operation>{circle()}{grating(ridge=0)}'
        "</Pattern>",
        "a part of a product is left out",
    ),
}  # fmt: skip


def said(found):
    return "\n".join(found.warnings)


@pytest.mark.parametrize("name", LEFT_OUT)
def test_what_cannot_be_shown_is_said_and_left_out(read, name):
    text, message = LEFT_OUT[name]
    found = read(text, circle(stroke()))
    assert [type(element) for element in found.scene.elements] == [Circle]
    assert message in said(found)
    assert "left out" in said(found)
    assert all(warning.startswith("line ") for warning in found.warnings)


DIFFERENT = {
    "a reactive group": (
        f'<Pattern type="Group"><operation type="reactive"><Modulator type="Velocity"/></operation>'
        f"{circle(stroke())}{line()}{line()}</Pattern>",
        "a reactive group is of 2 patterns, and this has 3",
    ),
    "a movement that is not known": (
        texture("Blend", f'<Modulator type="Sideways"/>{grating()}{grating(angle=9)}'),
        '"Sideways" is not known, so "Directional" is taken',
    ),
    "a cue without bands": (
        line(
            stroke(
                9, "<motion><cue>blend</cue><Grating><enable>no</enable></Grating></motion>"
            )
        ),
        "its cue has no bands; left out",
    ),
    "moving bands": (
        texture("Motion", f"<cue_type>superposed vibration bands</cue_type>{grating()}"),
        "its bands vibrate, as their name says",
    ),
    "dots over another shape": (
        layers(line(stroke(4, "<dots><enable>yes</enable></dots>"))),
        "its layers hide a little more or less of what is below them here than there",
    ),
    "a slope round a circle": (
        texture(
            "AxialGrating",
            '<Grating><PitchModulator type="slope"><enable>yes</enable></PitchModulator></Grating>',
        ),
        "has no slope here",
    ),
    "dots that overlap": (
        '<Pattern type="Dots"><dot>1,1</dot><dot>2,1</dot><dot_radius>3</dot_radius></Pattern>',
        "dots that overlap add up in OpenLatero",
    ),
    "markers inwards": (
        polygon("<corner><enable>yes</enable><blend>in</blend></corner>" + stroke()),
        "markers blend outwards here",
    ),
    "dots over a fill beneath": (
        circle(stroke(4, "<dots><enable>yes</enable></dots>") + fill(grating(), -1)),
        "dots stand in the place of the fill there",
    ),
    "short edges": (
        polygon(stroke(9, f"<fill>{waves(3, 0)}</fill>"), ("0,0", "9,0", "9,9", "0,9")),
        "an edge is too short for the round joints at its ends",
    ),
    "a texture on top": (
        f'<Pattern type="Group"><operation>overwrite</operation>{circle()}{grating()}</Pattern>',
        "its layers hide a little more or less",
    ),
    "an amplitude of 80 %": (
        grating(inside='<amplitude units="%">80</amplitude>'),
        "amplitude is 80, and shares are 0 to 1; 1 is taken",
    ),
    "a fast vibration": (
        texture("Vibration", "<freq>75</freq>"),
        "freq is 75, and it must be 0.1 to 50; 50 is taken",
    ),
    "fast ridges": (
        texture("LinearGrating", waves(8, 0, '<velocity units="Hz">900</velocity>')),
        "its ridges would move at 7200 mm/s; 1000 is taken",
    ),
    "an unknown word": (
        polygon('<corner><enable>yes</enable><type>texture</type></corner>'),
        'corner type "texture" is not known, so "solid" is taken',
    ),
    "an unknown operation": (
        f'<Pattern type="Group"><operation type="maks"/>{circle()}{line()}</Pattern>',
        'operation "maks" is not known, so "max" is taken; the nearest is max',
    ),
    "an answer that is neither": (
        grating(inside="<invert>perhaps</invert>"), 'invert is "perhaps", neither yes nor no',
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", DIFFERENT)
def test_what_differs_is_said_once_and_the_rest_is_shown(read, name):
    text, message = DIFFERENT[name]
    found = read(text)
    assert len(found.scene.elements) >= 1
    assert message in said(found)
    assert len(found.warnings) == 1


def test_what_holds_for_many_is_said_once_with_their_lines(read):
    found = read(*("\n" + circle("<colour>red</colour>") for _ in range(9)))
    (warning,) = found.warnings
    assert warning.startswith("line 7, Circle: colour is not known")
    assert warning.endswith("(and lines 9, 11, 13, 15, 17 and 3 more)")
