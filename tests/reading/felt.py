"""A picture that tests feel."""

from vbraille.render import MODELS

DISPLAY = MODELS["stress2-8x8"].display
SCENE = """
title = "A house"
description = "A house and the sun."
canvas = { width_mm = 120, height_mm = 90 }

[[elements]]
kind = "circle"
id = "sun"
title = "Sun"
description = "It shines."
center_mm = [90, 20]
radius_mm = 10
stroke = { width_mm = 3 }
fill = { texture = { kind = "linear-grating", ridge_mm = 2, gap_mm = 2 } }

[[elements]]
kind = "polygon"
id = "wall"
vertices_mm = [[20, 30], [60, 30], [60, 80], [20, 80]]
stroke = { width_mm = 3 }
fill = { texture = { kind = "linear-grating", ridge_mm = 2, gap_mm = 2 } }
"""
