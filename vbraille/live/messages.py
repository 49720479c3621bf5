"""Messages between a page of the live view and its server, in JSON.

The page pulls: it asks for a frame with `Next` when it has drawn the one before, so that nothing
piles up on the way. The server answers with the `ViewState`, if that has changed since this page
was told it, and then with one frame (`vbraille.live.frames`).
"""

from __future__ import annotations

from typing import Annotated

import msgspec

Finite = Annotated[float, msgspec.Meta(ge=-1e9, le=1e9)]


class Request(msgspec.Struct, frozen=True, tag_field="ask", forbid_unknown_fields=True):
    """Request of a page; its subclasses are the kinds."""


class Hello(Request, frozen=True, tag="hello"):
    """The first request of a page, with the token of its address; answered with `Welcome`."""

    token: str = ""


class Next(Request, frozen=True, tag="next"):
    """The next frame.

    Parameters
    ----------
    at_s
        In a recording, time of the frame, in seconds from its start.
    """

    at_s: float | None = None


class PagePress(Request, frozen=True, tag="press"):
    """A command by its name, as in `docs/keys.md`, and the place it is for, such as a card's."""

    command: str
    place: int | None = None


class Turn(Request, frozen=True, tag="turn"):
    """A knob of the braille style, turned to a value."""

    knob: str
    value: Finite


class Point(Request, frozen=True, tag="point"):
    """The hand of a simulated device, held at a pose of the array's centre on the canvas."""

    x_mm: Finite
    y_mm: Finite = 0.0
    theta_rad: Finite = 0.0


class LetGo(Request, frozen=True, tag="let-go"):
    """The hand of a simulated device, let go: it reads by itself again."""


Steering = PagePress | Turn | Point | LetGo


class ArrayShown(msgspec.Struct, frozen=True):
    """The actuators of a device.

    Parameters
    ----------
    name
        Name of the device.
    rows, columns
        Shape of a frame.
    column_pitch_mm, row_pitch_mm
        Distances of neighbouring columns and rows.
    swing_mm
        Way of a contactor from rest to full deflection.
    rest_right
        Whether an actuator at rest stands at the right end of its swing.
    travel_mm, height_mm
        How far the carriage goes along x and y; a height of 0 is one axis.
    turns
        Whether the carriage measures an angle.
    rate_hz
        Ticks a second that are wanted.
    """

    name: str
    rows: int
    columns: int
    column_pitch_mm: float
    row_pitch_mm: float
    swing_mm: float
    rest_right: bool
    travel_mm: float
    height_mm: float
    turns: bool
    rate_hz: float


class LineShown(msgspec.Struct, frozen=True):
    """A line on the virtual page.

    Parameters
    ----------
    number
        Number of the line, which is another for each.
    text
        Print of the line; empty where the source is braille.
    start_mm
        Left edge of the first of these cells.
    top_mm
        Upper edge of the line: its dots stand around the middle of a line pitch.
    cells
        Dot masks of the cells; bit n - 1 is dot n.
    sources
        For each cell, where the text that it stands for begins and ends; equal for none.
    under
        Whether this is the line under the hand.
    """

    number: int
    text: str
    start_mm: float
    top_mm: float
    cells: list[int]
    sources: list[tuple[int, int]]
    under: bool = False


class KnobShown(msgspec.Struct, frozen=True):
    """A knob of the braille style.

    Parameters
    ----------
    name
        Name, such as "dot_width_mm".
    label, unit
        Name and unit for people.
    value, step, low, high
        Value, how far a key turns it, and its bounds.
    fixed
        Why it cannot be turned; empty if it can.
    """

    name: str
    label: str
    unit: str
    value: float
    step: float
    low: float
    high: float
    fixed: str = ""


class SceneShown(msgspec.Struct, frozen=True):
    """A tactile picture.

    Parameters
    ----------
    title, description
        What it shows.
    width_mm, height_mm
        Size of the canvas.
    image
        Address (``data:``) of its deflection map; white is rest. Empty where there is none.
    left_mm, top_mm
        Place on the canvas where the carriage is at 0, 0.
    """

    title: str
    description: str
    width_mm: float
    height_mm: float
    image: str = ""
    left_mm: float = 0.0
    top_mm: float = 0.0


class SignalShown(msgspec.Struct, frozen=True):
    """A signal of a picture, with words for 1 and 0; frames have its value at its place."""

    name: str
    words: str


class CommandShown(msgspec.Struct, frozen=True):
    """A command that a page offers as a button: its name in `PagePress`, and what it does."""

    name: str
    words: str


class CardShown(msgspec.Struct, frozen=True):
    """A place on the table of a memory game.

    Parameters
    ----------
    place
        Words for the place, such as "row 1, card 2".
    side
        "face down", "turned up" or "empty".
    felt
        Whether its card is under the hand.
    """

    place: str
    side: str
    felt: bool = False


class PlayedEvent(msgspec.Struct, frozen=True):
    """Something that happened at a time of a recording.

    Parameters
    ----------
    at_s
        Seconds from the start of the recording.
    kind
        "line", "trial", "cue", "answer", "fault", "tuning", "pause" or "note".
    text
        Sentence on what happened.
    right
        Whether an answer was right; None where nothing is right or wrong.
    """

    at_s: float
    kind: str
    text: str
    right: bool | None = None


class Welcome(msgspec.Struct, frozen=True, tag_field="tell", tag="welcome"):
    """Answer to `Hello`.

    Parameters
    ----------
    steers
        Whether this page may steer.
    playback, length_s, moments
        Whether a recording is played back, so that `Next` names a time; its length, and what
        happened in it, by time.
    """

    steers: bool
    playback: bool = False
    length_s: float = 0.0
    moments: list[PlayedEvent] = []


class ViewState(msgspec.Struct, frozen=True, tag_field="tell", tag="state"):
    """All that a page shows beside the frames, which changes seldom.

    Parameters
    ----------
    number
        Number of the state; `vbraille.live.view.LiveView` gives it.
    title
        Title of what is read.
    array
        The actuators; None before the device is known.
    geometry
        Distances of the braille in mm: ``dot_width_mm``, ``dot_spacing_mm``, ``cell_gap_mm``,
        ``row_spacing_mm`` and ``line_pitch_mm``.
    rows_shown
        For each row of actuators the dot rows, from 0, that it shows: in the left dot column and
        in the right one; -1 for none.
    lines
        The line under the hand and some around it, from top to bottom.
    place
        Sentence that says where the reader is, such as "line 12, page 3".
    knobs
        Knobs of the braille style.
    mapping
        Words for the mapping.
    paused
        Whether the array rests because the reader said so.
    simulated, held
        Whether a page may be the hand, and whether one is.
    device
        Sentence on the state of the device, such as "reading" or a fault.
    said, said_before
        The last sentences that the reader was told, oldest first, and how many were before.
    facts
        Name and value of whatever else is shown, such as the trial of a session.
    blind
        Whether stimuli are hidden, since a participant is to answer about them.
    done
        Whether reading is over.
    scene
        Tactile picture under the hand; None where lines are read.
    signals
        Signals of the picture under the hand.
    commands
        Commands that a page with the right to steer offers.
    cards
        Rows of the table of a memory game; a `PagePress` with a place turns a card.
    """

    number: int = 0
    title: str = ""
    array: ArrayShown | None = None
    geometry: dict[str, float] = {}
    rows_shown: list[tuple[int, int]] = []
    lines: list[LineShown] = []
    place: str = ""
    knobs: list[KnobShown] = []
    mapping: str = ""
    paused: bool = False
    simulated: bool = False
    held: bool = False
    device: str = ""
    said: list[str] = []
    said_before: int = 0
    facts: list[tuple[str, str]] = []
    blind: bool = False
    done: bool = False
    scene: SceneShown | None = None
    signals: list[SignalShown] = []
    commands: list[CommandShown] = []
    cards: list[list[CardShown]] = []


class Refused(msgspec.Struct, frozen=True, tag_field="tell", tag="refused"):
    """Answer to a request that cannot be done: a sentence that says what to do."""

    why: str


to_request = msgspec.json.Decoder(Hello | Next | Steering).decode
to_json = msgspec.json.Encoder().encode
