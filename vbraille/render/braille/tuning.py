"""What a reader may change while reading."""

from __future__ import annotations

from dataclasses import dataclass

from vbraille.errors import check_range

# The kernels' polynomial of T_k has six coefficients; finer texture than this is below what the
# source's encoders resolve.
MOST_TEXTURE_CYCLES = 11


@dataclass(frozen=True, slots=True)
class Tuning:
    """Texture and contrast of braille, which a reader may change while reading.

    Parameters
    ----------
    texture
        Level T in [0, 1], from no texture to what Lévesque 2009 calls "textured" (VBD) or to the
        texture alone (STReSS², eq. 4.3).
    contrast
        Share of the full swing, in [0, 1].
    cycles
        Half-cycles of texture in a dot's radius, k of eq. 4.2; an odd number, so that the waveform
        meets rest at both edges. The VBD does not use it.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    texture: float = 0.0
    contrast: float = 1.0
    cycles: int = 7

    def __post_init__(self) -> None:
        for name in ("texture", "contrast"):
            check_range(name, getattr(self, name), 0, 1)
        if self.cycles % 2 != 1 or not 1 <= self.cycles <= MOST_TEXTURE_CYCLES:
            raise ValueError(
                f"texture cycles are {self.cycles}; "
                f"they must be an odd number, 1 to {MOST_TEXTURE_CYCLES}"
            )
