"""Braille under one fingertip: text as travelling waves of lateral skin deformation.

What a program wants is here, and is loaded when it is first asked for; `docs/api.md` tells of it
with examples.

>>> import vbraille
>>> len(vbraille.render_text("Hello", display=vbraille.STRESS2).cells)
6
"""

from importlib import import_module

from vbraille.version import __version__ as __version__

TYPE_CHECKING = False  # importing typing, for its constant, takes as long as all the rest
if TYPE_CHECKING:
    from vbraille import testing as testing
    from vbraille.analysis import analyse as analyse
    from vbraille.analysis.report import Analysis as Analysis
    from vbraille.braille.geometry import Geometry as Geometry
    from vbraille.devices.base import Device as Device
    from vbraille.display import Display as Display
    from vbraille.display import Pose as Pose
    from vbraille.errors import DeviceError as DeviceError
    from vbraille.errors import InputError as InputError
    from vbraille.errors import VbrailleError as VbrailleError
    from vbraille.pictures.framed import (
        open_framed as open_scene,  # noqa: F401  # pyright: ignore[reportUnusedImport]
    )
    from vbraille.reading.frames import RenderedLine as RenderedLine
    from vbraille.reading.frames import RenderedPage as RenderedPage
    from vbraille.reading.frames import render_page as render_page
    from vbraille.reading.frames import render_text as render_text
    from vbraille.reading.opening import OpenDevice as OpenDevice
    from vbraille.reading.opening import (
        open_to_read as open,  # noqa: A004, F401  # pyright: ignore[reportUnusedImport]
    )
    from vbraille.recording import Recording as Recording
    from vbraille.render.braille.mappings import MAPPINGS as MAPPINGS
    from vbraille.render.braille.models import LATERO as LATERO
    from vbraille.render.braille.models import STRESS2 as STRESS2
    from vbraille.render.braille.models import STRESS2_8X8 as STRESS2_8X8
    from vbraille.render.braille.models import VBD as VBD
    from vbraille.render.braille.models import Model as Model
    from vbraille.render.braille.style import BrailleStyle as BrailleStyle
    from vbraille.render.braille.style import Straying as Straying
    from vbraille.render.braille.style import Tuning as Tuning
    from vbraille.scene.scene import Canvas as Canvas
    from vbraille.scene.scene import Scene as Scene
    from vbraille.sessions.running.conditions import Conditions as Conditions
    from vbraille.sessions.session import Session as Session
    from vbraille.translate.tables import translate_text as translate_text

# Where each name is; what it has another name there stands after the colon.
_PLACES = {
    "BrailleStyle": "vbraille.render.braille.style",
    "Canvas": "vbraille.scene.scene",
    "Conditions": "vbraille.sessions.running.conditions",
    "Device": "vbraille.devices.base",
    "DeviceError": "vbraille.errors",
    "Display": "vbraille.display",
    "Geometry": "vbraille.braille.geometry",
    "InputError": "vbraille.errors",
    "LATERO": "vbraille.render.braille.models",
    "MAPPINGS": "vbraille.render.braille.mappings",
    "Model": "vbraille.render.braille.models",
    "OpenDevice": "vbraille.reading.opening",
    "Pose": "vbraille.display",
    "Recording": "vbraille.recording",
    "RenderedLine": "vbraille.reading.frames",
    "RenderedPage": "vbraille.reading.frames",
    "Analysis": "vbraille.analysis.report",
    "STRESS2": "vbraille.render.braille.models",
    "STRESS2_8X8": "vbraille.render.braille.models",
    "Scene": "vbraille.scene.scene",
    "Session": "vbraille.sessions.session",
    "Straying": "vbraille.render.braille.style",
    "Tuning": "vbraille.render.braille.style",
    "VBD": "vbraille.render.braille.models",
    "VbrailleError": "vbraille.errors",
    "analyse": "vbraille.analysis",
    "open": "vbraille.reading.opening:open_to_read",
    "open_scene": "vbraille.pictures.framed:open_framed",
    "render_page": "vbraille.reading.frames",
    "render_text": "vbraille.reading.frames",
    "translate_text": "vbraille.translate.tables",
}
__all__ = sorted([*_PLACES, "testing"])  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> object:
    """Load what is asked for; it is then at hand."""
    if name == "testing":
        return import_module("vbraille.testing")
    if name not in _PLACES:
        raise AttributeError(f"module 'vbraille' has no attribute {name!r}")
    place, _, its_name = _PLACES[name].partition(":")
    from vbraille.errors import needing_extras

    with needing_extras():
        found = getattr(import_module(place), its_name or name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    """Names for people, loaded or not."""
    return sorted({*globals(), *__all__})
