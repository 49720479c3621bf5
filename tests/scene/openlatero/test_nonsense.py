"""Files of nonsense: read in one way or another, and never more than what can be felt."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tests.render.scene.twin import deflections
from tests.scene.openlatero.files import scene
from tests.tiers import examples
from vbraille.render.labels import Assets
from vbraille.scene.converting import write_scene
from vbraille.scene.openlatero import read_gen
from vbraille.scene.openlatero.making import PATTERNS, TEXTURES
from vbraille.scene.reading import resolve
from vbraille.scene.scene import Scene
from vbraille.toml import TomlFile

TEXTS = (
    "", "0", "-1", "0.01", "1", "2.5", "8", "30", "400", "1e9", "nan", "inf", "12,5", "1,5,2,5",
    "0,0", "9,9", "40.5,12", "yes", "no", "low", "peak", "multiply", "blend", "overwrite",
    "reactive", "inherent", "superposed", "arc", "straight", "\\", "ü",
)  # fmt: skip
NAMES = (
    "amplitude", "angle", "blend_size", "blur", "center", "corner", "cue", "dot", "dot_radius",
    "dots", "edge_size", "edge_width", "enable", "end_point", "factor", "fill", "fill_texture",
    "frequency", "gap", "gap_size", "Grating", "grid_width", "gutter", "height", "imgfile",
    "intensity", "invert", "join", "length", "mask", "min_spacing", "motion", "operation",
    "PitchModulator", "position", "radius", "ridge", "ridge_size", "rounding_offset", "seed",
    "secondary_scale", "span", "start_point", "stroke", "texture", "type", "user_angle",
    "velocity", "vertex", "vertices", "vibration", "width", "wrong",
)  # fmt: skip
plain = st.builds("<{0}>{1}</{0}>".format, st.sampled_from(NAMES), st.sampled_from(TEXTS))
kinds = st.one_of(
    st.builds('type="{}"'.format, st.sampled_from([*PATTERNS, "Texture", "Wrong", ""])),
    st.builds('type="Texture" subtype="{}"'.format, st.sampled_from([*TEXTURES, "Wrong"])),
)


def holding(inner):
    inside = st.lists(inner, max_size=5).map("".join)
    return st.one_of(
        st.builds("<{0}>{1}</{0}>".format, st.sampled_from(NAMES), inside),
        st.builds("<Pattern {}>{}</Pattern>".format, kinds, inside),
    )


nonsense = st.recursive(plain, holding, max_leaves=12)
patterns = st.builds(
    "<Pattern {}>{}</Pattern>".format, kinds, st.lists(nonsense, max_size=6).map("".join)
)


@given(st.lists(patterns, min_size=1, max_size=3), st.booleans())
@examples(90)
def test_nonsense_is_read_and_never_feels_out_of_range(tmp_path_factory, parts, as_shown):
    path = tmp_path_factory.getbasetemp() / "nonsense.gen"
    path.write_text(scene(*parts), encoding="utf-8")
    found = read_gen(path, as_shown=as_shown)
    assert all(warning.startswith("line ") and "\n" not in warning for warning in found.warnings)
    text = write_scene(found.scene)
    assert write_scene(TomlFile(text, "made.scene").read(Scene)) == text
    shown = resolve(found.scene, path.parent)
    values = deflections(
        shown, Assets(), np.linspace(-5, 290, 60), np.linspace(-9, 230, 60), 0, 1.3
    )
    assert np.isfinite(values).all()
    assert values.min() >= 0
    assert values.max() <= 1
