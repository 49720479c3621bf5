"""Messages between a page of the live view and its server.

The page pulls: it asks for a frame when it has drawn the one before, so that nothing can pile up
on the way. It asks in JSON. The server answers each `Next` with the `ViewState`, if that has
changed since this page was told it, and then with one frame, which `vbraille.live.framing` makes.
`docs/live-view.md` has both as tables.
"""

from __future__ import annotations

from typing import Final

import msgspec

VERSION: Final = 1
# Longest request of a page, in bytes.
MOST_BYTES: Final = 4096
# The ticks of a frame are thinned out evenly to this number at most.
MOST_SAMPLES: Final = 64
FRAME_KIND: Final = 1
MAP_KIND: Final = 2


class Request(msgspec.Struct, frozen=True, tag_field="ask", forbid_unknown_fields=True):
    """Request of a page; its subclasses are the kinds."""


class PageHello(Request, frozen=True, tag="hello"):
    """The first request of a page, which the server answers with `Welcome`.

    Parameters
    ----------
    token
        Token of the address by which the page was opened; empty without one.
    """

    token: str = ""


class Next(Request, frozen=True, tag="next"):
    """The next frame.

    Parameters
    ----------
    row, column
        The actuator whose deflection the samples hold, from 0.
    at_s
        In a recording, the time of the frame that is asked for, in seconds from its start, and
        ``since_s`` that of the frame before; the newest frame of a device where it is None.
    """

    row: int = 0
    column: int = 0
    at_s: float | None = None
    since_s: float | None = None


class PagePress(Request, frozen=True, tag="press"):
    """A command by its name, as in `docs/keys.md`; it needs the right to steer.

    Parameters
    ----------
    command
        The command.
    place
        Number of the place that a command is for which is pointed at, from 0, such as a card's.
    """

    command: str
    place: int | None = None


class Turn(Request, frozen=True, tag="turn"):
    """A knob of the braille style turned to a value; it needs the right to steer."""

    knob: str
    value: float


class Point(Request, frozen=True, tag="point"):
    """The hand of a simulated device held at a place; it needs the right to steer.

    Parameters
    ----------
    x_mm, y_mm, theta_rad
        Place of the array's centre on the canvas, and angle by which the array is turned.
    """

    x_mm: float
    y_mm: float = 0.0
    theta_rad: float = 0.0


class LetGo(Request, frozen=True, tag="let-go"):
    """The hand of a simulated device let go, so that it reads by itself again."""


class Map(Request, frozen=True, tag="map"):
    """The deflection map of what is under the hand, or of a recording at a time.

    Parameters
    ----------
    form
        "png" or "svg".
    at_s
        In a recording, the time of what is drawn.
    """

    form: str = "png"
    at_s: float | None = None


AnyRequest = PageHello | Next | PagePress | Turn | Point | LetGo | Map


class ArrayShown(msgspec.Struct, frozen=True):
    """The actuators of a device, as a page draws them.

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
        How far the carriage goes along x and y.
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
        Number by which records call the line.
    text
        Text of the line in print; empty where the source is braille.
    start_mm
        Place of the left edge of the first of these cells.
    top_mm
        Place of the upper edge of the line: its dots stand around the middle of a line pitch.
    cells
        Dot masks of the cells; bit n - 1 is dot n.
    sources
        For each cell, where in the text that begins and ends which it stands for; two equal
        numbers where it stands for nothing.
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
        Name of the knob, such as "dot_width_mm".
    label, unit
        Name and unit for people.
    value, step, low, high
        Value, how far a key turns it, and its bounds.
    fixed
        Reason why it cannot be turned here; empty if it can.
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
    """A tactile picture that is felt, as a page draws it behind the array.

    Parameters
    ----------
    title, description
        What the picture shows.
    width_mm, height_mm
        Size of the canvas, whose upper left corner is the origin.
    image
        Address of its deflection map, as a rule with the PNG in it (``data:``); white is rest, and
        black is full deflection. Empty where there is none.
    left_mm, top_mm
        Place of the canvas where the carriage is at 0, 0.
    off
        Names of the layers that its switches hide, each with what hides it.
    off_image
        Address of a map of these layers alone; empty where none is hidden.
    """

    title: str
    description: str
    width_mm: float
    height_mm: float
    image: str = ""
    left_mm: float = 0.0
    top_mm: float = 0.0
    off: list[str] = []
    off_image: str = ""


class BesideShown(msgspec.Struct, frozen=True):
    """The line under the hand in another mapping, which a page draws beside the array.

    All actuators of a row do the same at one place, so that a row of values tells of all of them.

    Parameters
    ----------
    mapping
        Words for the mapping, as in `ViewState`.
    rows_shown
        Rows of dots that it shows, as in `ViewState`.
    first_mm, step_mm
        First of the places, and the distance from each to the next.
    rows
        For each row of actuators the deflections at these places, in base64: a byte each, 0 for
        rest and 255 for full swing.
    """

    mapping: str
    rows_shown: list[tuple[int, int]]
    first_mm: float
    step_mm: float
    rows: list[str]


class SignalShown(msgspec.Struct, frozen=True):
    """A signal of a picture; frames have its value at its place in the list.

    Parameters
    ----------
    name
        Name of the signal.
    words
        Words for when it is 1 and when it is 0.
    """

    name: str
    words: str


class CommandShown(msgspec.Struct, frozen=True):
    """A command that a page offers, as `PagePress` calls it.

    Parameters
    ----------
    name, words
        Name of the command, and what it does.
    """

    name: str
    words: str


class CardShown(msgspec.Struct, frozen=True):
    """A place on the table of a memory game.

    Parameters
    ----------
    place
        Words for the place, such as "row 1, card 2".
    side
        How its card lies: "face down", "turned up" or "empty".
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
        Kind: "line", "trial", "cue", "answer", "fault", "tuning", "pause" or "note".
    text
        Sentence on what happened.
    right
        Whether an answer was right; None where nothing is right or wrong.
    condition
        Condition of the trial in which it happened; empty for none.
    """

    at_s: float
    kind: str
    text: str
    right: bool | None = None
    condition: str = ""


class Welcome(msgspec.Struct, frozen=True, tag_field="tell", tag="welcome"):
    """The server's answer to `PageHello`.

    Parameters
    ----------
    version
        `VERSION`.
    steers
        Whether this page may steer.
    playback
        Whether a recording is played back, so that `Next` and `Map` name a time.
    length_s
        Length of the recording in seconds; 0 without one.
    moments
        What happened in the recording, by time.
    """

    version: int
    steers: bool
    playback: bool = False
    length_s: float = 0.0
    moments: list[PlayedEvent] = []


class ViewState(msgspec.Struct, frozen=True, tag_field="tell", tag="state"):
    """All that a page shows beside the frames, and that changes seldom.

    Parameters
    ----------
    number
        Number of the state, which grows with each.
    title
        Title of what is read.
    array
        The actuators; None before the device is known.
    geometry
        Distances of the braille in mm: `dot_width_mm`, `dot_spacing_mm`, `cell_gap_mm`,
        `row_spacing_mm` and `line_pitch_mm`.
    rows_shown
        For each row of actuators, from row 0, which dots it shows: (dot row of the left dot
        column, dot row of the right one), from 0; -1 for none. Empty where that is not shown.
    lines
        The line under the hand and some around it, from top to bottom; empty in a blind session.
    place
        Sentence that says where the reader is, such as "line 12, page 3".
    knobs
        Knobs of the braille style; empty where nothing may be turned.
    mapping
        Words for the mapping, such as "mapping: sheared".
    paused
        Whether the array rests because the reader said so.
    simulated
        Whether a simulated hand moves the carriage, so that a page may be the hand.
    held
        Whether a page is the hand now.
    device
        Sentence on the state of the device, such as "reading", "place: known" or a fault.
    said
        The last sentences that the reader was told, oldest first.
    said_before
        Number of sentences that were said before those.
    facts
        Name and value of whatever else is shown, such as the trial of a session.
    blind
        Whether stimuli are hidden, since a participant is to answer about them.
    done
        Whether reading is over.
    scene
        Tactile picture that is felt; None where lines are read, and in a blind session.
    beside
        The line under the hand in another mapping, where that was asked for.
    figures
        Tactile pictures that stand on the page of a text, at their places.
    signals
        Signals of the picture that is felt.
    commands
        Commands that a page with the right to steer offers.
    cards
        Rows of the table of a memory game; a card is turned by the command "POINT" and its place.
    """

    number: int
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
    beside: BesideShown | None = None
    figures: list[SceneShown] = []
    signals: list[SignalShown] = []
    commands: list[CommandShown] = []
    cards: list[list[CardShown]] = []


class Refused(msgspec.Struct, frozen=True, tag_field="tell", tag="refused"):
    """The server's answer to a request that it cannot do; the connection may end after it.

    Parameters
    ----------
    why
        Sentence that says what is wrong and what to do.
    """

    why: str
