"""A source with real braille for the page: lines of a story, each frame made by the renderer.

`python -m tests.live.scenes [PORT]` serves it on this machine; an environment variable ``SCENE``
chooses the scene: live, still, blind, page (two axes), vbd, playback.
"""

from __future__ import annotations

import asyncio
import math
import os
import sys
import threading
import time
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec
import numpy as np

from tests.live.canned import COMMANDS
from vbraille.config.settings import KNOBS, say_mapping
from vbraille.errors import InputError
from vbraille.layout.pages import Layout
from vbraille.live.framing import FrameHeader, frame_bytes
from vbraille.live.messages import (
    ArrayShown,
    KnobShown,
    LetGo,
    LineShown,
    Map,
    Next,
    PagePress,
    PlayedEvent,
    Point,
    Turn,
    ViewState,
)
from vbraille.live.server import LiveServer
from vbraille.render.braille.models import STRESS2, VBD, Model
from vbraille.translate.book import Book
from vbraille.translate.documents import Document
from vbraille.translate.liblouis import BrailleTable

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.layout.blocks import Line
    from vbraille.live.sources import Steering

RATE_HZ = 1000
LENGTH_S = 42.0
SWING_MM = 0.2
MOST_SAMPLES = 64
TEXT = Path(__file__).parents[2] / "texts/english.txt"
SAID = [
    "reading begins at line 1",
    "line 1",
    "dot width: 2.6 mm",
    "line 2",
    "texture: 0.2",
]
MOMENTS = [
    PlayedEvent(0.0, "line", "line 1 under the hand"),
    PlayedEvent(2.4, "trial", "trial 12 of 78: letter, 2.6 mm dots", None, "2.6 mm"),
    PlayedEvent(3.1, "cue", "cue: begin"),
    PlayedEvent(7.85, "answer", "answer: n (right, after 4.7 s)", True, "2.6 mm"),
    PlayedEvent(9.0, "trial", "trial 13 of 78: letter, 2.2 mm dots", None, "2.2 mm"),
    PlayedEvent(9.7, "cue", "cue: begin"),
    PlayedEvent(13.2, "tuning", "contrast: 0.9"),
    PlayedEvent(16.4, "answer", "answer: m (asked: n, after 6.7 s)", False, "2.2 mm"),
    PlayedEvent(18.0, "pause", "the participant rests"),
    PlayedEvent(24.0, "line", "line 2 under the hand"),
    PlayedEvent(25.0, "trial", "trial 14 of 78: word, 2.6 mm dots"),
    PlayedEvent(28.316, "fault", "the device was silent for 0.21 s"),
    PlayedEvent(33.5, "answer", "answer: garden (right, after 7.8 s)"),
    PlayedEvent(38.0, "note", "the experimenter notes: finger slipped"),
]


@dataclass
class Text:
    """Some lines of a story on a display."""

    model: Model
    lines: list[Line]

    @classmethod
    def of(cls, model: Model, count: int = 4) -> Text:
        display = model.on(model.style.geometry)
        width = model.style.geometry.cells_per_line(display.span_mm)
        table = BrailleTable("en-ueb-g2.ctb")
        layout = Layout(Book(Document.open(TEXT), table), width)
        return cls(model, list(islice(layout.lines(), count)))

    def shown(self, under: int) -> list[LineShown]:
        pitch = self.model.style.geometry.line_pitch_mm
        lines = []
        for n, line in enumerate(self.lines):
            sources = [line.source(cell) for cell in range(len(line))]
            begin = min(source[0] for source in sources if source is not None)
            lines.append(
                LineShown(
                    number=line.number,
                    text=line.text.rstrip(),
                    start_mm=0.0,
                    top_mm=n * pitch,
                    cells=[int(mask) for mask in line.masks],
                    sources=[
                        (0, 0) if source is None else (source[0] - begin, source[1] - begin)
                        for source in sources
                    ],
                    under=n == under,
                )
            )
        return lines


class Scene:
    """A source whose hand goes along a line, or is where a page holds it."""

    def __init__(self, kind: str = "live") -> None:
        self.kind = kind
        self.model = VBD if kind == "vbd" else STRESS2
        self.playback = kind == "playback"
        self.length_s = LENGTH_S if self.playback else 0.0
        self.moments = MOMENTS if self.playback else []
        self.asked: list[Steering] = []
        self.asking = threading.Lock()
        self.two = kind == "page"
        self.style = self.model.style
        self.display = self.model.on(self.style.geometry)
        self.text = Text.of(self.model)
        self.row = 1
        self.held: Point | None = None
        self.paused = False
        self.said = list(SAID)
        self.start = time.monotonic()
        self.number = 0
        self.compile()

    def compile(self) -> None:
        """Tell another state, and render what it shows."""
        masks = [line.masks for line in self.text.lines]
        if self.two:
            self.program = self.style.render_page(masks, self.display)
        else:
            self.program = self.style.render(masks[self.row], self.display)
        self.number += 1
        self.state = self.made_state()
        self.told = self.number, msgspec.json.encode(self.state)

    def made_state(self) -> ViewState:
        array, style, blind = self.display, self.style, self.kind == "blind"
        geometry = style.geometry
        rows = [(-1, -1)] * array.rows
        for row, pair in zip(
            range(array.rows)[style.rows_on(array)],
            zip(style.mapping.left, style.mapping.right, strict=True),
            strict=False,
        ):
            rows[row] = pair
        return ViewState(
            self.number,
            title="The story of an unknown reader" if not blind else "Legibility of letters",
            array=ArrayShown(
                array.name,
                array.rows,
                array.columns,
                array.column_pitch_mm,
                array.row_pitch_mm,
                SWING_MM,
                array.rest_side == "right",
                array.travel_mm,
                geometry.line_pitch_mm * len(self.text.lines) if self.two else 0.0,
                self.two,
                float(RATE_HZ),
            ),
            geometry={
                name: getattr(geometry, name)
                for name in (
                    "dot_width_mm",
                    "dot_spacing_mm",
                    "cell_gap_mm",
                    "row_spacing_mm",
                    "line_pitch_mm",
                )
            },
            rows_shown=rows,
            lines=[] if blind else self.text.shown(self.row),
            place="" if blind else f"line {self.row + 1}, page 1",
            knobs=[]
            if blind
            else [
                KnobShown(
                    knob.key,
                    knob.label,
                    knob.unit,
                    knob.value(style),
                    knob.step,
                    knob.low,
                    knob.high,
                )
                for knob in KNOBS.values()
            ],
            mapping="" if blind else say_mapping(style.mapping),
            paused=self.paused,
            simulated=not self.playback,
            held=self.held is not None,
            device="reading, place known",
            said=[] if blind else self.said,
            facts=[("trial", "12 of 78"), ("condition", "hidden")] if blind else [],
            blind=blind,
            commands=[] if blind else COMMANDS,
        )

    def x_mm(self, t: float | NDArray[np.float64]) -> NDArray[np.float64]:
        """Where the hand is at times in s."""
        t = np.asarray(t, np.float64)
        if self.held is not None:
            return np.full(t.shape, self.held.x_mm)
        if self.kind == "still":
            return np.full(t.shape, 117.3)
        goes = 118.0 - 112.0 * np.cos(2 * math.pi * t / 9.0)
        return goes + 2.2 * np.sin(2 * math.pi * t * 0.83)

    def frames(self, x_mm: NDArray[np.float64]) -> NDArray[np.float32]:
        """Deflections at places along the line, or along the second line of a page."""
        if not self.two:
            return self.program.path(np.ascontiguousarray(x_mm))
        y_mm, theta = self.pose()
        part = self.program.part_of(y_mm)
        # Frames as ticks make them; of float32 they would be compiled anew, which takes seconds.
        out = np.zeros((x_mm.size, *self.display.shape))
        for at, frame in zip(x_mm, out, strict=True):
            self.program.frame(float(at), frame, theta_rad=theta, part=part)
        return out.astype(np.float32)

    def pose(self) -> tuple[float, float]:
        if self.held is not None:
            return self.held.y_mm, self.held.theta_rad
        return (self.row + 0.5) * self.style.geometry.line_pitch_mm, 0.0

    def viewer(self) -> SceneViewer:
        return SceneViewer(self)

    def map(self, request: Map) -> bytes:
        if request.form == "svg":
            return b'<svg xmlns="http://www.w3.org/2000/svg" width="2" height="1"/>'
        return (TEXT.parents[1] / "docs/wave.png").read_bytes()

    def ask(self, request: Steering) -> None:
        """Take what a page asks for, or a test as the reader beside it."""
        self.asked.append(request)
        with self.asking:
            self.obey(request)

    def obey(self, request: Steering) -> None:
        match request:
            case Point():
                was, self.held = self.held, request
                if was is not None:
                    return
            case LetGo():
                self.held = None
            case Turn(knob=knob, value=value):
                try:
                    self.style = self.style.replace(**{KNOBS[knob].field: value})
                except ValueError as error:
                    raise InputError(str(error)) from None
                self.said = [*self.said, KNOBS[knob].said(value)]
            case PagePress(command="PAUSE"):
                self.paused = not self.paused
            case PagePress(command="LNDN" | "LNUP" as command):
                self.row = min(max(self.row + (1 if command == "LNDN" else -1), 0), 3)
                self.said = [*self.said, f"line {self.row + 1}"]
        self.compile()


class SceneViewer:
    """A page's view of a scene."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._tick = -1

    def state(self, request: Next) -> tuple[int, bytes]:  # noqa: ARG002
        return self._scene.told

    def frame(self, request: Next, *, again: bool = False) -> bytes | None:
        scene = self._scene
        now = request.at_s if scene.playback else time.monotonic() - scene.start
        tick = round((now or 0.0) * RATE_HZ)
        since = self._tick
        if scene.playback:
            since = tick - 1 if request.since_s is None else round(request.since_s * RATE_HZ)
        if not scene.playback and tick <= since and not again:
            return None
        self._tick = tick
        since = max(since, tick - 1000) if since >= 0 else tick - 1
        ticks = np.arange(since + 1, tick + 1)
        if ticks.size > MOST_SAMPLES:
            ticks = ticks[np.linspace(0, ticks.size - 1, MOST_SAMPLES).astype(int)]
        if not ticks.size:
            ticks = np.array([tick])
        x_mm = scene.x_mm(ticks / RATE_HZ)
        frames = scene.frames(x_mm)
        blind = scene.kind == "blind"
        row = min(request.row, frames.shape[1] - 1)
        follow = frames[:, row, min(request.column, frames.shape[2] - 1)]
        if blind:
            follow = np.full(ticks.size, np.nan)
        samples = np.stack([(tick - ticks) / RATE_HZ, x_mm, follow], axis=1)
        y_mm, theta = scene.pose()
        before = scene.x_mm((tick - 1) / RATE_HZ)
        header = FrameHeader(
            state=scene.number,
            line=scene.row + 1,
            tick=float(tick),
            time_s=tick / RATE_HZ,
            x_mm=float(x_mm[-1]),
            y_mm=y_mm,
            theta_rad=theta,
            vx_mm_s=float(x_mm[-1] - before) * RATE_HZ,
            lateness_us=41.0,
            work_us=23.0,
            age_ms=0.6,
        )
        shown = np.zeros((0, 0), np.float32) if blind else frames[-1]
        return frame_bytes(header, shown, samples.astype(np.float32))


async def _serve(port: int | None) -> None:
    async with LiveServer(Scene(os.environ.get("SCENE", "live")), port=port) as server:
        print(server.admission.steering_address, flush=True)
        await asyncio.Event().wait()


if __name__ == "__main__":
    asyncio.run(_serve(int(sys.argv[1]) if len(sys.argv) > 1 else None))
