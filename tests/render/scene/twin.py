"""Deflections of scenes in plain numpy, straight from the equations: the twin of the kernels.

Lévesque 2009, 8.4.5, over the patterns of `referencewaves`, `referencestrokes` and
`referencebraille`. It is slow and plain on purpose; the tests hold the kernels to it.
"""

from __future__ import annotations

from dataclasses import replace
from functools import reduce
from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace as replaced

from tests.render.scene.twinbraille import label_deflections, label_opacity
from tests.render.scene.twinsignals import SIGNALS, Signals
from tests.render.scene.twinstrokes import (
    coordinates,
    cue_profile,
    cued_over,
    dots_deflection,
    dots_profile,
    drawn,
    drawn_mask,
    drawn_profile,
    is_inside,
    placed,
)
from tests.render.scene.twinwaves import (
    ActuatorPlaces,
    Values,
    axial_grating,
    intensity,
    linear_grating,
    radial_grating,
    vibrated,
    vibration,
)
from vbraille.scene.bitmap import opaque
from vbraille.scene.geometry import PlacedDot, drawn_radius_mm, is_everywhere
from vbraille.scene.patterns import (
    AxialGrating,
    Circle,
    Dots,
    Group,
    Image,
    Label,
    LinearGrating,
    Moving,
    PathShape,
    Polygon,
    RadialGrating,
    SignalLevel,
    StraightLine,
    Tile,
    Uniform,
    UniformVibration,
)
from vbraille.scene.traversal import driving

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike

    from vbraille.render.labels import Assets
    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.scene import Scene

_LEAST_FADE_MM = 1e-9  # of a fill; below that it does not fade in


def deflections(
    scene: Scene,
    assets: Assets,
    x_mm: ArrayLike,
    y_mm: ArrayLike,
    parity: ArrayLike = 0,
    time_s: float = 0.0,
    signals: Mapping[str, float] | None = None,
) -> Values:
    """Compute the deflections of a scene at places, which are at rest beside its canvas.

    Parameters
    ----------
    scene
        A resolved scene.
    assets
        Bitmaps of its images and cells of its labels.
    x_mm, y_mm : float[n]
        The places.
    parity : int[n] or int
        0 where the parities of an actuator's column and row are the same, else 1.
    time_s
        Time since the scene was first shown, in seconds.
    signals
        Values of its signals; None for those of a hand that stands still.

    Returns
    -------
    float64[n]
        Deflections, 0 … 1.
    """
    if signals is None:
        signals = Signals(scene.signals, driving(*scene.elements)).step(0.0)
    at = places(x_mm, y_mm, parity, time_s, signals)
    if not scene.elements:
        return np.zeros(at.x_mm.shape)
    whole = Group(operation=scene.operation, parts=scene.elements)
    width_mm, height_mm = scene.canvas.width_mm, scene.canvas.height_mm
    across = (at.x_mm >= 0) & (at.x_mm <= width_mm)
    on_canvas = across & (at.y_mm >= 0) & (at.y_mm <= height_mm)
    return np.where(on_canvas, deflection(whole, assets, at), 0.0)


def opacity(
    pattern: AnyPattern,
    assets: Assets,
    x_mm: ArrayLike,
    y_mm: ArrayLike,
    parity: ArrayLike = 0,
    time_s: float = 0.0,
    signals: Mapping[str, float] | None = None,
) -> Values:
    """Compute the opacity mask of a pattern at places; the arguments are those of a scene's.

    Only a blend's mask can depend on time and parity, by the pattern that chooses in it.
    """
    return mask(pattern, assets, places(x_mm, y_mm, parity, time_s, signals))


def places(
    x_mm: ArrayLike,
    y_mm: ArrayLike,
    parity: ArrayLike,
    time_s: float,
    signals: Mapping[str, float] | None = None,
) -> ActuatorPlaces:
    """Make places of arrays; single numbers count for all, and no signals for those of tests."""
    signals = Signals(SIGNALS).step(0.0) if signals is None else signals
    x, y, odd = np.broadcast_arrays(
        np.atleast_1d(np.asarray(x_mm, np.float64)), np.asarray(y_mm, np.float64), parity
    )
    return ActuatorPlaces(x, y, np.where(odd == 0, 1.0, -1.0), time_s, signals)


# Deflections


def deflection(pattern: AnyPattern, assets: Assets, at: ActuatorPlaces) -> Values:
    """Compute a pattern with its changes: amplitude, then inversion, then vibration."""
    changed = pattern.amplitude * plain(pattern, assets, at)
    if pattern.inverted:
        changed = 1 - changed
    shown = np.clip(vibrated(changed, at, pattern.vibration), 0.0, 1.0)
    return shown * at.signals[pattern.factor] if pattern.factor else shown


def plain(pattern: AnyPattern, assets: Assets, at: ActuatorPlaces) -> Values:
    """Compute a pattern without its changes."""
    match pattern:
        case Uniform():
            return np.full(at.x_mm.shape, pattern.level)
        case SignalLevel():
            return np.full(at.x_mm.shape, at.signals[pattern.name])
        case Moving():
            passed_s = at.moved_s(pattern.velocity_by)
            right, down = pattern.velocity_mm_s
            moved = replace(at, x_mm=at.x_mm - right * passed_s, y_mm=at.y_mm - down * passed_s)
            return deflection(pattern.part, assets, moved)
        case UniformVibration():
            return vibration(at, pattern.frequency_hz)
        case LinearGrating():
            return linear_grating(pattern, at)
        case RadialGrating():
            return radial_grating(pattern, at)
        case AxialGrating():
            return axial_grating(pattern, at)
        case Tile():
            inner = at.wrapped(pattern.origin_mm, pattern.width_mm, pattern.height_mm)
            return deflection(pattern.part, assets, inner)
        case Image():
            values = intensity(assets.bitmaps[pattern], at)
            if pattern.texture is None:
                return values
            return values * deflection(pattern.texture, assets, at)
        case StraightLine() | Circle() | Polygon() | PathShape():
            return shape(pattern, assets, at)
        case Dots():
            return dots_deflection(placed(_dots(pattern), at), pattern.dot, at)
        case Label():
            return label_deflections(pattern, assets.written[pattern], at.x_mm, at.y_mm)
        case Group():
            return group(pattern, assets, at)
    raise TypeError(f"a {type(pattern).__name__} is not rendered; resolve the scene first")


def shape(
    shape: StraightLine | Circle | Polygon | PathShape, assets: Assets, at: ActuatorPlaces
) -> Values:
    """Compute a shape: its stroke or dots, and its fill, fig. 8.21.

    A blended fill is eq. 8.20 with the profile at full amplitude, or else a weak stroke would let
    the fill through. Another fill begins at the stroke's inner edge, and does not overlap it.
    """
    if shape.cue is not None and shape.is_cued_over:
        finished = _finished(replaced(shape, cue=None), assets, at)
        return cued_over(finished, shape, shape.cue, at)
    return _finished(shape, assets, at)


def _finished(
    shape: StraightLine | Circle | Polygon | PathShape, assets: Assets, at: ActuatorPlaces
) -> Values:
    """Compute a shape without a cue that goes over all of it."""
    up = drawn(shape, at)
    fill = None if isinstance(shape, StraightLine) else shape.fill
    if fill is None:
        return up
    inner = np.where(is_inside(shape, at), deflection(fill.texture, assets, at), 0.0)
    if fill.blended:
        # A texture across dots or a stroke may be above their profile: the sum is then above 1.
        return np.minimum(up + inner * (1 - drawn_profile(shape, at)), 1.0)
    from_edge = coordinates(shape, at).across_mm - drawn_radius_mm(shape) - fill.gap_mm
    if fill.fade_mm < _LEAST_FADE_MM:
        return up + np.where(from_edge > 0, inner, 0.0)
    return up + inner * np.clip(from_edge / fill.fade_mm, 0.0, 1.0)


def group(group: Group, assets: Assets, at: ActuatorPlaces) -> Values:
    """Compute a group: masking, addition, maximum, eqs. 8.21 and 8.22."""
    parts = [deflection(part, assets, at) for part in group.parts]
    match group.operation:
        case "multiply":
            return np.prod(parts, axis=0)
        case "add":
            return np.minimum(1.0, np.sum(parts, axis=0))
        case "weighted":
            return np.tensordot(group.weights or (), parts, 1)
        case "maximum":
            return np.max(parts, axis=0)
        case "blend":
            return _blended(group, assets, at, parts)
        case "overwrite":
            masks = [mask(part, assets, at) for part in group.parts]
            shown = np.zeros(at.x_mm.shape)
            for part, own in zip(parts, masks, strict=True):
                shown = np.minimum(1.0, (1 - own) * shown + part)
            return shown


def _blended(group: Group, assets: Assets, at: ActuatorPlaces, parts: Sequence[Values]) -> Values:
    """Compute eq. 8.21: (1 - α) δ1 + α δ2."""
    assert group.by is not None
    alpha = deflection(group.by, assets, at)
    return (1 - alpha) * parts[0] + alpha * parts[1]


def _dots(dots: Dots) -> list[PlacedDot]:
    return [PlacedDot(x, y) for x, y in dots.centers_mm]


# Opacity masks


def mask(pattern: AnyPattern, assets: Assets, at: ActuatorPlaces) -> Values:
    """Compute a pattern's opacity mask μ: 8.4.5 and fig. 8.25.

    Amplitude does not change it, nor does vibration of what is up. It is nowhere below the
    pattern: where inversion, or a vibration of what is down, brings up what was rest, it is 1.
    """
    own = _own_mask(pattern, assets, at)
    return own * at.signals[pattern.factor] if pattern.factor else own


def _own_mask(pattern: AnyPattern, assets: Assets, at: ActuatorPlaces) -> Values:
    """Compute a pattern's opacity mask without its factor."""
    everywhere = np.ones(at.x_mm.shape)
    if is_everywhere(pattern):
        return everywhere
    match pattern:
        case Image():
            return intensity(opaque(assets.bitmaps[pattern]), at)
        case StraightLine() | Circle() | Polygon() | PathShape():
            own = drawn_mask(pattern, at)
            if pattern.is_cued_over:
                over = cue_profile(pattern, coordinates(pattern, at))
                own = over + (1 - over) * own
            if isinstance(pattern, StraightLine) or pattern.fill is None:
                return own
            return np.where(is_inside(pattern, at), 1.0, own)
        case Dots():
            return dots_profile(placed(_dots(pattern), at), pattern.dot, at, mask=True)
        case Label():
            return label_opacity(pattern, assets.written[pattern], at.x_mm, at.y_mm)
        case Group():
            return _group_mask(pattern, assets, at)
    return everywhere


def _group_mask(group: Group, assets: Assets, at: ActuatorPlaces) -> Values:
    """Compute the mask of a group, which the source does not give.

    It follows the group's own operation, so that it is nowhere below the group. The masks of
    layers are put together as 1 - Π(1 - μ), which is what eq. 8.22 makes of patterns that are up
    where they can be; the largest of them, as in the author's later code, would be too small.
    """
    masks = [mask(part, assets, at) for part in group.parts]
    match group.operation:
        case "multiply":
            return np.prod(masks, axis=0)
        case "add" | "weighted":
            return np.minimum(1.0, np.sum(masks, axis=0))
        case "maximum":
            return np.max(masks, axis=0)
        case "blend":
            return _blended(group, assets, at, masks)
        case "overwrite":
            return 1 - reduce(np.multiply, [1 - own for own in masks])
