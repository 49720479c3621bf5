"""A protocol: all that a session shows, in one file, so that another lab can repeat it.

`docs/session-format.md` and the files in ``protocols/`` describe the format.
"""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Literal

import numpy as np
from msgspec import field, structs

from vbraille.render import MODELS
from vbraille.sessions.planning.analysis import CONDITION, ITEM, PlannedAnalysis, Task
from vbraille.sessions.planning.design import (
    BlockOrder,
    Choice,
    Combinations,
    Design,
    Item,
    ItemList,
    Practice,
    StringList,
)
from vbraille.sessions.planning.factors import (
    Cross,
    Factor,
    between,
    combined,
    condition,
    crossed,
    groups,
    within,
)
from vbraille.sessions.planning.items import ItemRow, Items, OrderRow
from vbraille.sessions.planning.pace import (
    FaultRules,
    MarkerCodes,
    ParticipantField,
    SessionPace,
    SignalSound,
    TrialPace,
    check_line,
)
from vbraille.sessions.planning.procedures import FixedProcedure, ProcedureTable
from vbraille.sessions.planning.questionnaire import AnyItem
from vbraille.sessions.planning.questions import AnyQuestion, ReadQuestion, usual_question
from vbraille.sessions.planning.questiontable import CellSpelling
from vbraille.sessions.planning.sequencing import Rules
from vbraille.sessions.planning.spellings import SpellingKeys, WrittenText, cells_of
from vbraille.sessions.planning.stimuli import Stimuli, Stimulus, broken, with_value
from vbraille.sessions.planning.style import (
    CONVENTIONAL,
    Condition,
    ConventionalTable,
    DisplayStyle,
    mapping_named,
)
from vbraille.tomlfile import Table, which

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.braille.geometry import Geometry
    from vbraille.render import BrailleStyle, Mapping, Model, Tuning
    from vbraille.render.program import Program
    from vbraille.sessions.planning.pictures import PictureScene

FORMAT = 1
ONLY_CONDITION = "all"
_ALL_DOTS = 0xFF  # what a conventional display shows
_NAME = re.compile(r"[a-z0-9-]{1,40}")


class ProtocolFile(Table, frozen=True, kw_only=True):
    """The keys of a protocol's file."""

    format: int
    name: str
    title: str
    source: str
    model_name: str = field(name="model")
    medium: Literal["device", "paper"] = "device"
    display: DisplayStyle = DisplayStyle()
    keys: SpellingKeys = field(default_factory=SpellingKeys)
    design: Combinations | StringList | Choice | ItemList
    items: Items | None = None
    listed: tuple[Condition, ...] = field(name="conditions", default=())
    factors: tuple[Factor, ...] = ()
    cross: Cross = "all"
    conventional: ConventionalTable = ConventionalTable()
    order: BlockOrder | None = None
    rules: Rules = Rules()
    procedure: ProcedureTable = FixedProcedure()
    question: AnyQuestion | None = None
    practice: Practice = Practice()
    trial: TrialPace = TrialPace()
    session: SessionPace = SessionPace()
    faults: FaultRules = FaultRules()
    sound: SignalSound = SignalSound()
    markers: MarkerCodes = MarkerCodes()
    fields: tuple[ParticipantField, ...] = ()
    questionnaire: tuple[AnyItem, ...] = ()
    analysis: PlannedAnalysis | None = None

    @property
    def pictures(self) -> bool:
        """True if elements of scenes are shown, and not cells."""
        looks = (self.display, *self.listed, *(f.levels[0] for f in self.factors))
        return any(look.scene is not None for look in looks)


class Protocol(ProtocolFile, frozen=True, kw_only=True, dict=True):
    """A session's stimuli, and the way in which it is conducted.

    Parameters
    ----------
    format
        Format of the file, which is 1.
    name, title, source
        Name of the protocol in options, what participants do, and where the protocol comes from.
    model_name
        Name of the display's model.
    medium
        "device"; or "paper" for strings that are read on paper or on a conventional display, and
        timed by a key.
    display
        How strings are shown on the display.
    keys
        Dot masks of the characters that may spell a cell beside a to z.
    design
        What is shown in each condition.
    listed
        Conditions that the file lists; empty if there is only one, which has no name there.
    items
        Where the strings come from; None if the design has them.
    factors, cross
        Factors that conditions and groups are named from, and which combinations are shown.
    conventional
        What stands on a conventional display, and where on it.
    order
        Order of the blocks of conditions; None if the design says it.
    rules
        Rules that the finished plan is checked for, beside its design.
    procedure
        Which trial comes next, and when enough was asked.
    question
        What is asked of each trial; None to identify a string, or to choose one of two.
    practice
        Practice before the first block.
    trial, session
        Pace of each trial, and of the whole session.
    faults
        What is done about a trial in which the device failed.
    sound
        Sounds that the participant hears.
    markers
        Codes of the conditions for other recorders.
    fields
        Questions about the participant.
    questionnaire
        Questions beside the trials.
    analysis
        Analysis that is planned; None for the usual one of the task.
    text
        The file's TOML text, as it was read.
    files
        Texts of the files that stand beside it, by name.
    item_rows, order_rows
        What these files hold: items, and orders of participants; empty without such files.
    group
        Group whose share of the protocol this is; empty for the protocol of all.
    cells
        Dot masks of texts that are known already, by the text and its table; those of others are
        made by the tables.

    Raises
    ------
    ValueError
        If values are out of range. `vbraille.sessions.planning.protocolfiles` checks whether the
        tables agree.
    """

    design: Design
    text: str
    files: dict[str, str] = {}  # noqa: RUF012  (msgspec copies an empty default)
    item_rows: tuple[ItemRow, ...] = ()
    order_rows: tuple[OrderRow, ...] = ()
    group: str = ""
    cells: dict[tuple[str, str], tuple[int, ...]] = {}  # noqa: RUF012

    def __post_init__(self) -> None:
        if not _NAME.fullmatch(self.name):
            raise ValueError(
                f"name is {self.name!r}; it must be 1 to 40 small letters a to z, digits or hyphens"
            )
        check_line("title", self.title)
        check_line("source", self.source)
        if self.model_name not in MODELS:
            raise ValueError(f"model is {self.model_name!r}{which(self.model_name, MODELS)}")

    @property
    def model(self) -> Model:
        """Model of the display."""
        return MODELS[self.model_name]

    @cached_property
    def style(self) -> BrailleStyle:
        """Style in which strings are shown on the display."""
        return self.display.style(self.model)

    @property
    def mapping(self) -> Mapping:
        """Mapping of dots to the rows of the display's array."""
        return self.style.mapping

    @property
    def geometry(self) -> Geometry:
        """Distances between the dots of a line, and the length of the carriage's travel."""
        return self.style.geometry

    @cached_property
    def conditions(self) -> tuple[Condition, ...]:
        """Conditions of the protocol, at least one."""
        own = within(self.factors)
        made = crossed(self.factors, self.cross)
        if made:
            return tuple(condition(name, combined(own, levels)) for name, levels in made.items())
        return self.listed or (Condition(name=ONLY_CONDITION),)

    @property
    def groups(self) -> tuple[str, ...]:
        """Names of the groups of participants; none if all take part in the same."""
        return tuple(groups(self.factors))

    def assigned(self, group: str) -> Protocol:
        """Protocol as a group has it: with the display changed by the levels of the group.

        Parameters
        ----------
        group
            Name of the group; empty if there are none.

        Raises
        ------
        ValueError
            If there is no such group, or values contradict each other.
        """
        if group not in (self.groups or ("",)):
            names = self.groups
            raise ValueError(
                f"group is {group!r}{which(group, names)}"
                if names
                else f"group is {group!r}, and {self.name} has no groups; leave it out"
            )
        if not group or group == self.group:
            return self
        changes = combined(between(self.factors), groups(self.factors)[group])
        return structs.replace(self, group=group, display=structs.replace(self.display, **changes))

    def levels(self, name: str) -> dict[str, str]:
        """Level of each factor in a condition of this group, by the factors' names.

        A factor between participants has an empty level if no group is chosen.
        """
        found = dict.fromkeys((factor.name for factor in self.factors), "")
        for factors, levels in (
            (within(self.factors), crossed(self.factors, self.cross).get(name, ())),
            (between(self.factors), groups(self.factors).get(self.group, ())),
        ):
            found |= dict(zip([factor.name for factor in factors], levels, strict=False))
        return found

    @property
    def levels_of(self) -> dict[str, Callable[[tuple[Item, Condition]], str]]:
        """Names that ``at_most_running`` may have, with the level of an item in a condition."""
        levels = {c.name: self.levels(c.name) for c in self.conditions}

        def level(name: str, shown: tuple[Item, Condition]) -> str:
            return levels[shown[1].name][name]

        def told(name: str, shown: tuple[Item, Condition]) -> str:
            return self.columns_of(tuple(map(int, shown[0])))[name]

        return {
            CONDITION: lambda shown: shown[1].name,
            **{factor.name: partial(level, factor.name) for factor in within(self.factors)},
            **{column: partial(told, column) for column in self.item_columns},
        }

    @property
    def written(self) -> bool:
        """True if strings are texts, whose cells are made by the tables of the conditions."""
        looks = (self.display, *self.listed, *(f.levels[0] for f in self.factors))
        return any(look.table is not None for look in looks)

    def table_of(self, condition: Condition) -> str | None:
        """Braille table that makes the cells of texts in a condition; None if none does."""
        return condition.table or self.display.table

    @property
    def block_order(self) -> str | None:
        """Order of the blocks of conditions: "balanced", "listed", "shuffled", "table" or None."""
        if self.order is None:
            return self.design.order
        return "table" if self.order.kind == "table" else self.order.of_blocks

    @property
    def balanced(self) -> bool:
        """True if participants differ in the order of the conditions."""
        by_blocks = self.design.blocks == "conditions" and self.block_order in ("balanced", None)
        return by_blocks and len(self.conditions) > 1

    @property
    def task(self) -> str:
        """Task of the participant: "strings" for reading strings, "choice" for comparing two."""
        return "choice" if isinstance(self.design, Choice) else "strings"

    @property
    def parameter(self) -> str | None:
        """Parameter compared, such as "dot_width_mm" or "contrast"; None if strings are read."""
        return self.design.parameter if isinstance(self.design, Choice) else None

    @property
    def standard(self) -> float | None:
        """Value that all others are compared with; None if there is none."""
        return self.design.reference if isinstance(self.design, Choice) else None

    @property
    def asks(self) -> AnyQuestion:
        """Question that is asked of each trial."""
        usual = ReadQuestion() if self.passages else usual_question(self.intervals)
        return self.question or usual

    @property
    def passages(self) -> bool:
        """True if each trial shows a passage, line by line."""
        return isinstance(self.design, StringList) and self.design.passage

    def broken(self, stimulus: Stimulus) -> Stimuli:
        """Lines of a passage, of which the first has its text."""
        room = stimulus.geometry.cells_per_line(self.model.display.span_mm) - self.lead_cells
        lines = broken(stimulus.masks, room)
        first = replace(stimulus, masks=lines[0])
        return Stimuli([first, *(replace(stimulus, masks=m, text=None) for m in lines[1:])])

    @property
    def intervals(self) -> int:
        """Number of stimuli in a trial."""
        return self.design.stimuli if isinstance(self.design, Choice) else 1

    def cell_spelling(self, stimulus: Stimulus) -> CellSpelling:
        """Spelling of cells in answers about a stimulus."""
        if stimulus.conventional:
            return CellSpelling(self.keys, _ALL_DOTS)
        return CellSpelling(self.keys, self.mapping_of(stimulus).shown_dots())

    @cached_property
    def planned_analysis(self) -> PlannedAnalysis:
        """Analysis that is planned, with the usual choices of the task where none is made."""
        factors = {factor.name: frozenset(factor.changes) for factor in self.factors}
        if not within(self.factors) and len(self.conditions) > 1:
            changes = frozenset().union(*(each.changes for each in self.conditions))
            factors = {CONDITION: changes, **factors}
        right = getattr(self.asks, "right", None)
        task = Task(
            question=self.asks.name,
            scored=right in ("more", "less"),
            adaptive=self.adaptive,
            catch=self.design.catch is not None,
            factors=factors,
            items=tuple(f"{ITEM}{name}" for name in self.item_columns),
        )
        return (self.analysis or PlannedAnalysis()).resolved(task)

    @property
    def marker_codes(self) -> dict[str, int]:
        """Byte of a marker for each condition, by its name."""
        return self.markers.of([condition.name for condition in self.conditions])

    @property
    def adaptive(self) -> bool:
        """True if it depends on the answers which trials there are."""
        return not isinstance(self.procedure, FixedProcedure)

    @property
    def trials(self) -> int:
        """Number of trials, practice left out; the most if answers decide."""
        table, trials = self.procedure, self.design.trials
        most = trials if isinstance(table, FixedProcedure) else table.trials or trials
        catch, trials = self.design.catch, min(most, trials) * len(self.conditions)
        return trials if catch is None else trials + catch.number(trials)

    @property
    def lead_cells(self) -> int:
        """Number of blank cells before each string, which keep it clear of the left stop."""
        return self.display.lead_cells

    def style_of(self, condition: Condition) -> BrailleStyle:
        """Style in which strings are shown in a condition.

        Raises
        ------
        ValueError
            If values contradict each other, or the model has no use for them.
        """
        style = self._styles.get(condition)
        if style is None:
            style = self._styles[condition] = condition.over(self.model, self.style)
        return style

    @cached_property
    def _styles(self) -> dict[Condition, BrailleStyle]:
        """Styles of the conditions that were asked for."""
        return {}

    def place_of(self, condition: Condition) -> str:
        """Place of a condition's strings: "device", or "brlapi"."""
        return condition.on or self.display.on or "device"

    @property
    def needs_conventional(self) -> bool:
        """True if a conventional display is needed."""
        return bool(self.conventional.reference) or any(
            self.place_of(condition) == CONVENTIONAL for condition in self.conditions
        )

    def shown(
        self, condition: Condition, masks: tuple[int, ...], value: float | None = None
    ) -> Stimulus:
        """Stimulus that shows some cells in a condition.

        Parameters
        ----------
        condition, masks
            The condition, and the dot masks of all cells with their delimiters; or a text, or
            the name of a picture.
        value
            Value of the parameter that is compared; None if none is.

        Raises
        ------
        ValueError
            If the value gives a number out of bounds, or the condition's table cannot make cells
            of the text.
        """
        style = self.style_of(condition)
        text = table = None
        scene = condition.scene or self.display.scene
        if scene is not None:
            picture = str(masks)
            right = self.asks.right_of(picture, self.columns_of(masks))
            shown = {"scene": scene, "picture": picture, "answer": right}
            return Stimulus((), style.tuning, style.geometry, **shown)
        if isinstance(masks, WrittenText):
            table = self.table_of(condition)
            if table is None:
                raise ValueError(f"the condition {condition.name} has no table; give it one")
            text = str(masks)
            masks = self.cells.get((text, table)) or cells_of(text, table)
        if self.place_of(condition) == CONVENTIONAL:
            return Stimulus(
                masks, style.tuning, style.geometry, text=text, table=table, on=CONVENTIONAL
            )
        own = condition.mapping is not None or condition.dot_row is not None
        mapping = style.mapping.name if own else None
        stimulus = Stimulus(masks, style.tuning, style.geometry, value, mapping)
        if text is not None:
            stimulus = replace(stimulus, text=text, table=table)
        if value is None or self.parameter is None:
            return stimulus
        return with_value(stimulus, self.parameter, value)

    def mapping_of(self, stimulus: Stimulus) -> Mapping:
        """Mapping of dots to the array's rows while a stimulus is felt."""
        return self.mapping if stimulus.mapping is None else mapping_named(stimulus.mapping)

    def scene_of(self, stimulus: Stimulus) -> PictureScene:
        """Scene that the picture of a stimulus is of."""
        # This loads numba, by what compiles pictures; protocols of strings need none of it.
        from vbraille.sessions.planning.pictures import picture_scene

        assert stimulus.scene is not None, "cells are of no scene"
        return picture_scene(self.files[stimulus.scene], stimulus.scene)

    def program(self, stimulus: Stimulus, tuning: Tuning) -> Program:
        """Picture of a stimulus for the compiled code, by places of the array's centre."""
        if stimulus.picture is not None:
            scene = self.scene_of(stimulus)
            return scene.compile(stimulus.picture, self.model.display, tuning.contrast)
        style = replace(
            self.model.style,
            mapping=self.mapping_of(stimulus),
            geometry=stimulus.geometry,
            tuning=tuning,
        )
        return style.render(np.array(self.line(stimulus.masks), np.uint8), self.model.display)

    def columns_of(self, item: tuple[int, ...]) -> dict[str, str]:
        """Cells of an item in the file of items, by column; see `Trial.item`."""
        return self._item_cells.get(self.design.content(item), dict.fromkeys(self.item_columns, ""))

    @cached_property
    def item_columns(self) -> tuple[str, ...]:
        """Columns that the file of items has beside the strings."""
        return tuple(self.item_rows[0].columns) if self.item_rows else ()

    @cached_property
    def _item_cells(self) -> dict[Item, dict[str, str]]:
        return {self.design.content(row.masks): dict(row.columns) for row in self.item_rows}

    def line(self, masks: tuple[int, ...]) -> tuple[int, ...]:
        """Cells of the line on which a string is shown, with the blank ones before it."""
        return (0,) * self.lead_cells + masks
