"""The part of a picture that an array can reach: how near it is, and where."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from vbraille.scene.geometry import Box
    from vbraille.scene.scene import Canvas

# Zooms that a person goes through, from the farthest to the nearest.
ZOOMS: Final = (0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0)
_MARGIN: Final = 0.25  # share of the reach within whose edges is a place that is brought into it


@dataclass(frozen=True, slots=True)
class Aperture:
    """A window on a picture's canvas, as large as the carriage goes, which zoom and pan move.

    Places of the carriage and of the canvas are in mm at the fingertip. A place of the picture as
    it is written is that of the canvas divided by the zoom.

    Parameters
    ----------
    reach_mm
        How far the carriage goes along x and y; 0 along y if it measures none.
    zoom
        Factor of the picture's places.
    left_mm, top_mm
        Place of the canvas where the carriage is at 0, 0.
    """

    reach_mm: tuple[float, float]
    zoom: float = 1.0
    left_mm: float = 0.0
    top_mm: float = 0.0

    @property
    def is_whole(self) -> bool:
        """Tell whether the picture is as it is written, from its top left corner on."""
        return (self.zoom, self.left_mm, self.top_mm) == (1.0, 0.0, 0.0)

    def on_canvas(self, x_mm: float, y_mm: float) -> tuple[float, float]:
        """Place of the canvas at a place of the carriage."""
        return x_mm + self.left_mm, y_mm + self.top_mm

    def of_carriage(self, x_mm: float, y_mm: float) -> tuple[float, float]:
        """Place of the carriage at a place of the canvas."""
        return x_mm - self.left_mm, y_mm - self.top_mm

    def zoomed(self, zoom: float, at_mm: tuple[float, float]) -> Aperture:
        """Zoom about a place of the carriage, which stays on the same place of the picture."""
        share = zoom / self.zoom
        x_mm, y_mm = at_mm
        left_mm, top_mm = share * (x_mm + self.left_mm) - x_mm, share * (y_mm + self.top_mm) - y_mm
        return replace(self, zoom=zoom)._from(left_mm, top_mm)

    def panned(self, right: float, down: float, canvas: Canvas) -> Aperture:
        """Move by shares of the reach, as far as there is canvas."""

        def moved(place_mm: float, share: float, reach_mm: float, size_mm: float) -> float:
            # Not beyond the canvas, or where all of that is within the window, not off it.
            ends = 0.0, size_mm - reach_mm, place_mm
            return min(max(place_mm + share * reach_mm, min(ends)), max(ends))

        return self._from(
            moved(self.left_mm, right, self.reach_mm[0], canvas.width_mm),
            moved(self.top_mm, down, self.reach_mm[1], canvas.height_mm),
        )

    def reaching(self, x_mm: float, y_mm: float) -> Aperture:
        """Move no farther than is needed to have a place of the canvas well within reach."""

        def brought(place_mm: float, at_mm: float, reach_mm: float) -> float:
            away_mm = at_mm - place_mm
            if 0.0 <= away_mm <= reach_mm:
                return place_mm
            return at_mm - min(max(away_mm, _MARGIN * reach_mm), (1.0 - _MARGIN) * reach_mm)

        return self._from(
            brought(self.left_mm, x_mm, self.reach_mm[0]),
            brought(self.top_mm, y_mm, self.reach_mm[1]),
        )

    def _from(self, left_mm: float, top_mm: float) -> Aperture:
        """Move the window to a place of the canvas; along y only if the carriage goes there."""
        return replace(self, left_mm=left_mm, top_mm=top_mm if self.reach_mm[1] else 0.0)

    def words(self, canvas: Canvas) -> str:
        """Words for what is within reach, in mm of the picture as it is written."""
        said = []
        places = (self.left_mm, self.reach_mm[0], canvas.width_mm, "left"), (
            self.top_mm, self.reach_mm[1], canvas.height_mm, "top"
        )  # fmt: skip
        for place, reach, of, edge in places:
            if reach:
                first, last = max(place, 0.0), min(place + reach, of)
                said.append(
                    f"{first / self.zoom:.0f} to {last / self.zoom:.0f} mm from the {edge}"
                    if first < last
                    else f"nothing from the {edge}"
                )
        return ", ".join(said)

    def placed(self, x_mm: float, y_mm: float) -> str:
        """Words for a place of the canvas."""
        x, y = x_mm / self.zoom, y_mm / self.zoom
        return f"{x:.0f} mm from the left, {y:.0f} mm from the top"

    def sized(self, box: Box) -> str:
        """Words for the size of a box on the canvas."""
        width, height = (box.right - box.left) / self.zoom, (box.bottom - box.top) / self.zoom
        return f"{width:.0f} mm × {height:.0f} mm"
