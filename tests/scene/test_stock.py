"""The bank of textures has the numbers that the source's author published."""

from msgspec.structs import replace

from vbraille.scene.patterns import (
    AxialGrating,
    Gradual,
    Group,
    LinearGrating,
    Peak,
    Polygon,
    RadialGrating,
    Stroke,
    Tile,
    TurnPeak,
    UniformVibration,
    Use,
    Vibration,
)
from vbraille.scene.resolving import resolve
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.stock import STOCK, stock_text, stock_textures
from vbraille.scene.traversal import mapped

MIDDLE = (0, 0)
VERTICES = ((5, 5), (5, 15), (15, 15))


def group(operation, *parts, by=None):
    return Group(operation=operation, parts=parts, by=by)


def lin(angle, ridge, gap=0, **more):
    return LinearGrating(ridge_mm=ridge, gap_mm=gap, wave_angle_deg=angle, **more)


def rad(ridge, gap=0, **more):
    return RadialGrating(center_mm=MIDDLE, ridge_mm=ridge, gap_mm=gap, **more)


def slope(factor, start, length):
    return Gradual(factor=factor, start_mm=start, length_mm=length)


def peak(factor, center, length):
    return Peak(factor=factor, center_mm=center, length_mm=length)


TURN = TurnPeak(factor=10, center_deg=180, length_deg=40)
TEXTURES = {
    "linear-0": lin(0, 8),
    "linear-45": lin(45, 8),
    "linear-90": lin(90, 8),
    "radial": rad(8),
    "radial-motion": rad(4, 8, velocity_mm_s=30),
    "radial-motion-vibrating": rad(4, 8, velocity_mm_s=30, vibration=Vibration(frequency_hz=50)),
    "axial": AxialGrating(center_mm=MIDDLE, ridge_deg=36),
    "axial-peak": AxialGrating(center_mm=MIDDLE, ridge_deg=20, distortion=TURN),
    "vibration": UniformVibration(frequency_hz=50),
    "vibration-low": UniformVibration(frequency_hz=50, amplitude=0.3),
    "dots": group("multiply", lin(0, 8), lin(90, 8)),
    "grid": group("maximum", lin(45, 2, 8), lin(135, 2, 8)),
    "combo": group("maximum", lin(90, 2, 1, amplitude=0.6), lin(45, 4, 12), lin(135, 4, 12)),
    "textured-1": group("multiply", lin(90, 10, 5), lin(180, 1, 0.5)),
    "textured-2": group("multiply", lin(0, 10, 3), lin(0, 1, 0.3)),
    "textured-3": group("add", lin(0, 10, amplitude=0.8), lin(0, 1, amplitude=0.2)),
    "textured-4": group("add", lin(0, 10, amplitude=0.7), lin(90, 1, amplitude=0.3)),
    "textured-5": group("maximum", lin(0, 8, 4), lin(90, 1, 5)),
    # There the third part weighs the first of two; here it weighs the second, as eq. 8.21 has it.
    "jaggies": group("blend", lin(135, 10, inverted=True), lin(45, 10), by=lin(90, 14.1)),
    "pattern-grid": Tile(
        width_mm=23, height_mm=21, part=Polygon(vertices_mm=VERTICES, stroke=Stroke(width_mm=2))
    ),
    "linear-slope": lin(None, 16, distortion=slope(8, 0, 226)),
    "linear-peak": lin(None, 16, distortion=peak(4, 113, 40)),
    "radial-slope": rad(4, distortion=slope(0.1, 0, 113)),
    "radial-abrupt": rad(16, distortion=slope(4, 60, 30)),
    "radial-ring": rad(16, distortion=peak(4, 60, 20)),
}


def test_the_textures_have_the_published_numbers():
    stock = stock_textures()
    assert set(stock) == set(TEXTURES)
    assert all(one.title and one.description for one in stock.values())
    for name, texture in stock.items():
        plain = mapped(texture, lambda one: replace(one, title="", description=""))
        assert plain == TEXTURES[name], name


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
