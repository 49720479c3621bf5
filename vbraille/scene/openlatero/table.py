"""Elements of OpenLatero's files: what may stand in each, and what counts where it does not.

A row has the name of an element, its kind, what is usual, its range where it is not that of the
kind, and after ``>`` the name that it has in our scenes. Kinds are units, ``number`` for none,
``yesno``, ``place``, ``words`` of which the first is usual, ``speed`` in a unit or in Hz,
``text``, ``pattern``, ``unused``, ``unshown``, of which that is said, and ``patterns``, ``places``
and ``sounds``, of which there may be several; all others are names of parts. A part or a type may
stand at several places.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

TABLE = """
file
  Generator            generator
  Pattern              pattern
generator
  Pattern              pattern

Group
  operation            operation
  Pattern              patterns
Toggle
  Pattern              patterns
Line
  start_point          place     0,0                  > start_mm
  end_point            place     289.9,230.1875       > end_mm
  stroke               stroke
Circle
  center               place     0,0                  > center_mm
  radius               mm        100                  > radius_mm
Circle Polygon
  stroke               stroke
  fill_texture         fill_texture
Polygon
  vertices             vertices
  join                 join
  corner               corner
Dot Dots
  dot                  places    0,0
  dot_radius           mm        100                  > radius_mm
  height               share     1                    > amplitude
  ridge                dot_ridge
  vibration            vibration
  operation            operation
Image
  Pattern              pattern
  mask                 mask
Audio
  sound                sounds

texture                                               # of every type
  amplitude            share     1
  invert               yesno     no
  vibration            vibration
  td_centric           text
  motion               movement
  icon                 unused
Vibration
  freq                 Hz        50
LinearGrating
  angle                °         0
  seed                 place     0,0                  > start_mm
  Grating              wave
RadialGrating
  seed                 place     0,0                  > center_mm
  Grating              wave
AxialGrating
  seed                 place     0,0                  > center_mm
  seed_angle           °         0
  Grating              turning_wave
DoubleLinearGrating
  seed                 place     0,0
  angle                °         0
  primary_ridge_size   mm        8
  primary_gap_size     mm        0
  secondary_scale      number    1
  constraint           words     orthogonal | parallel
  primary_amplitude    share     1
  secondary_amplitude  share     1
  operation            operation
Combo
  operation            operation
  Pattern              patterns
Blend
  Modulator            modulator
  Pattern              patterns
Motion
  cue_type             words     none | vibration bands | superposed bands | superposed vibration bands | disabling bands | blending bands
  direction            °         0
  velocity             mm/s      50
  Pattern              pattern
Pattern
  grid_width           mm        20      0.1..10000  > width_mm
  grid_height          mm        20      0.1..10000  > height_mm
  Pattern              pattern

operation
  Modulator            modulator
modulator                                             # Velocity
  limit                mm/s      5       0..1000
  transition           mm/s      5       0.1..1000
  delay                ms        500
modulator                                             # Directional
  low_velocity_mode    words     toggle | high | low
  direction            °         0
  symmetric            yesno     no                             > axis
  direction_tolerance  °         30      0..180       > tolerance_deg
  direction_transition °         20      0.1..180     > transition_deg
  velocity_tolerance   mm/s      0       0..1000      > below_mm_s
  velocity_transition  mm/s      5       0.1..1000    > slow_transition_mm_s
movement
  enable               yesno     no
  velocity             mm/s      50
  direction            °         0
wave
  enable               yesno     yes
  ridge_size           mm        8                    > ridge_mm
  gap_size             mm        0                    > gap_mm
  velocity             speed     0 mm/s
  invert               yesno     no                             > inverted
  PitchModulator       pitch
turning_wave
  enable               yesno     yes
  ridge_size           °         36      0..360       > ridge_deg
  gap_size             °         0       0..360       > gap_deg
  velocity             speed     0 °/s
  invert               yesno     no                             > inverted
  PitchModulator       turning_pitch
pitch
  enable               yesno     no
  factor               number    5       0.05..20     > factor
  length               mm        113     0.05..10000  > length_mm
  position             mm        0       -10000..10000
turning_pitch
  enable               yesno     no
  factor               number    5       0.05..20     > factor
  length               °         113     0.5..360     > length_deg
  position             °         0       0..360
vibration
  enable               yesno     yes
  frequency            Hz        50
  amplitude            share     1                    > amplitude
  blend_mode           words     high | low

stroke
  width                mm        10
  intensity            share     1
  ridge                ridge
  dots                 dots
  fill                 fill
  motion               cue
ridge dot_ridge
  width                mm        0                    # that of the stroke, if it is not there
  texture              ripples
ridge
  edge_width           mm        1       0.1..10000
dot_ridge
  edge_width           mm        0.2     0.1..10000
ripples
  enable               yesno     no
  amplitude            share     0                    > amplitude
  nb_cycles            number    3       0..49        # on one side of a stroke
dots
  enable               yesno     no
  height               share     1
  min_spacing          mm        1                    > separation_mm
  ridge                ridge
  vibration            vibration
fill
  gutter               yesno     no
  Grating              along
  vibration            vibration
along
  enable               yesno     no
  ridge_size           mm        2                    > ridge_mm
  gap_size             mm        0                    > gap_mm
  velocity             speed     0 mm/s
  invert               unshown
  PitchModulator       unshown
cue
  cue                  words     none | inherent | superposed | suppressed | vibration | blend
  velocity             mm/s      50
  superposed_ratio     share     0.2                 > share
  blend_value          share     0.5
  min_width            mm        10                  > width_mm
  Grating              bands
  vibration            vibration
bands
  enable               yesno     yes
  ridge_size           mm        2                    > ridge_mm
  gap_size             mm        30                   > gap_mm
  velocity             speed     0 mm/s
  invert               unshown
fill_texture
  enable               yesno     no
  gap                  mm        0       -10000..10000
  edge_size            mm        1                    > fade_mm
  Pattern              pattern
vertices
  vertex               places    0,0
join
  type                 words     round | straight
  rounding_offset      mm        0
corner
  enable               yesno     no
  span                 words     circle intercept | user specified | arc | right-angled
  type                 words     solid | invert vib
  user_angle           °         30      1..180
  blend                words     out | in
  blend_size           mm        1       0.05..10000  > blend_mm
  motion               yesno     yes
  vibration            vibration

sound
  audiofile            text
  mask                 mask
mask
  imgfile              text
  blur                 yesno     no                             # of 2 pixels
  position             text                           # a place, or "centered"
  lock_aspect_ratio    unused                         # while the user changes the size
  reference_maximized  yesno     yes
  width                text                           # in mm, or a share of the largest
  height               text
  default_alpha        share     0                    > outside
"""  # noqa: E501


class Row(NamedTuple):
    """A row of the table.

    Parameters
    ----------
    kind
        Kind of the element.
    usual
        What is usual, and the range if there is one, as they are written.
    here
        Name that the value has in our scenes; empty for none of its own.
    """

    kind: str
    usual: str
    here: str


@cache
def rows_of(owner: str) -> dict[str, Row]:
    """Rows of a part by its name, of a pattern or a texture by its type; none if it has none."""
    rows: dict[str, Row] = {}
    owners: tuple[str, ...] = ()
    for line in TABLE.splitlines():
        written, _, here = line.partition("#")[0].partition(">")
        if not line.startswith(" "):
            owners = tuple(written.split())
        elif owner in owners:
            name, kind, *usual = written.split(None, 2)
            rows[name] = Row(kind, "".join(usual).strip(), here.strip())
    return rows
