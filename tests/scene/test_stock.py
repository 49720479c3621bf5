"""The bank of textures has the numbers that the source's author published."""

import pytest

from vbraille.scene.patterns import Group, Tile, Use
from vbraille.scene.resolving import resolve
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.stock import STOCK, stock_text, stock_textures
from vbraille.scene.textures import AxialGrating, LinearGrating, RadialGrating, UniformVibration


def bare(pattern):
    """Numbers of a texture alone, without its names and with modulo 180° for ridges alike."""
    if isinstance(pattern, Group):
        parts = [bare(part) for part in pattern.parts]
        by = None if pattern.by is None else bare(pattern.by)
        return (pattern.operation, parts, by)
    if isinstance(pattern, LinearGrating):
        change = pattern.distortion
        return (
            (pattern.wave_angle_deg or 0.0) % 180,
            round(pattern.ridge_mm, 9),
            round(pattern.gap_mm, 9),
            pattern.amplitude,
            pattern.inverted,
            None if change is None else tuple(change.__struct_fields__) + _numbers(change),
        )
    if isinstance(pattern, RadialGrating):
        change = pattern.distortion
        return (
            pattern.center_mm,
            pattern.ridge_mm,
            pattern.gap_mm,
            pattern.velocity_mm_s,
            pattern.vibration and (pattern.vibration.frequency_hz, pattern.vibration.amplitude),
            None if change is None else tuple(change.__struct_fields__) + _numbers(change),
        )
    raise AssertionError(pattern)


def _numbers(table):
    return tuple(getattr(table, name) for name in table.__struct_fields__)


def group(operation, *parts, by=None):
    return (operation, list(parts), by)


def lin(angle, ridge, gap=0.0, amplitude=1.0, inverted=False, change=None):
    return (angle % 180, ridge, gap, amplitude, inverted, change)


def rad(ridge, gap=0.0, velocity=0.0, vibration=None, change=None):
    return ((0.0, 0.0), ridge, gap, velocity, vibration, change)


def slope(factor, start, length):
    return ("factor", "start_mm", "length_mm", factor, start, length)


def peak(factor, center, length):
    return ("factor", "center_mm", "length_mm", factor, center, length)


TEXTURES = {
    "linear-0": lin(0, 8),
    "linear-45": lin(45, 8),
    "linear-90": lin(90, 8),
    "radial": rad(8),
    "radial-motion": rad(4, 8, 30),
    "radial-motion-vibrating": rad(4, 8, 30, (50, 1.0)),
    "dots": group("multiply", lin(0, 8), lin(90, 8)),
    "grid": group("maximum", lin(45, 2, 8), lin(135, 2, 8)),
    "combo": group("maximum", lin(90, 2, 1, 0.6), lin(45, 4, 12), lin(135, 4, 12)),
    "textured-1": group("multiply", lin(90, 10, 5), lin(0, 1, 0.5)),
    "textured-2": group("multiply", lin(0, 10, 3), lin(0, 1, 0.3)),
    "textured-3": group("add", lin(0, 10, 0, 0.8), lin(0, 1, 0, 0.2)),
    "textured-4": group("add", lin(0, 10, 0, 0.7), lin(90, 1, 0, 0.3)),
    "textured-5": group("maximum", lin(0, 8, 4), lin(90, 1, 5)),
    # There the third part weighs the first of two; here it weighs the second, as eq. 8.21 has it.
    "jaggies": group("blend", lin(135, 10, inverted=True), lin(45, 10), by=lin(90, 14.1)),
    "linear-slope": lin(0, 16, change=slope(8, 0, 226)),
    "linear-peak": lin(0, 16, change=peak(4, 113, 40)),
    "radial-slope": rad(4, change=slope(0.1, 0, 113)),
    "radial-abrupt": rad(16, change=slope(4, 60, 30)),
    "radial-ring": rad(16, change=peak(4, 60, 20)),
}
OTHERS = {"axial", "axial-peak", "vibration", "vibration-low", "pattern-grid"}


@pytest.mark.parametrize("name", TEXTURES)
def test_a_texture_has_the_published_numbers(name):
    assert bare(stock_textures()[name]) == TEXTURES[name]


def test_spokes_vibrations_and_tiles_have_the_published_numbers():
    stock = stock_textures()
    spokes, fine = stock["axial"], stock["axial-peak"]
    assert isinstance(spokes, AxialGrating)
    assert isinstance(fine, AxialGrating)
    assert (spokes.ridge_deg, spokes.gap_deg, spokes.distortion) == (36, 0, None)
    assert fine.distortion is not None
    assert (fine.ridge_deg, fine.gap_deg, *_numbers(fine.distortion)) == (20, 0, 10, 180, 40)
    strong, weak = stock["vibration"], stock["vibration-low"]
    assert isinstance(strong, UniformVibration)
    assert isinstance(weak, UniformVibration)
    assert (strong.frequency_hz, strong.amplitude) == (50, 1.0)
    assert (weak.frequency_hz, weak.amplitude) == (50, 0.3)
    tile = stock["pattern-grid"]
    assert isinstance(tile, Tile)
    assert (tile.width_mm, tile.height_mm, len(tile.part.vertices_mm)) == (23, 21, 3)


def test_every_texture_of_the_bank_is_one_of_these():
    assert set(stock_textures()) == {*TEXTURES, *OTHERS}


def test_every_texture_says_what_it_is():
    assert all(one.title and one.description for one in stock_textures().values())


def test_every_texture_can_be_used_and_moved_without_an_include():
    uses = tuple(Use(name=f"{STOCK}{name}", move_mm=(50, 40)) for name in stock_textures())
    shown = resolve(Scene(canvas=Canvas(width_mm=200, height_mm=100), elements=uses)).elements
    assert len(shown) == len(uses)
    assert not any(isinstance(one, Use) for one in shown)
    rings = shown[list(stock_textures()).index("radial")]
    assert rings.center_mm == (50, 40)


def test_the_bank_says_how_it_is_used_and_where_it_is_from():
    text = stock_text()
    assert 'texture = {kind = "use", name = "stock:grid"}' in text
    assert "MIT" in text
