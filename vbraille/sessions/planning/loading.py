"""Reads protocols, with the files beside them, and checks that their tables agree."""

from __future__ import annotations

import itertools
import unicodedata
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random
from typing import Any

from msgspec import structs

from vbraille.braille.spelling import LETTERS, name_dots, spell, to_braille
from vbraille.errors import InputError
from vbraille.sessions.planning.design import Compared, ItemList, Setting, StringList
from vbraille.sessions.planning.items import read_items, read_orders
from vbraille.sessions.planning.procedures import QuestPlus, quest_of
from vbraille.sessions.planning.protocol import (
    MEASURES_OF,
    Analysis,
    Condition,
    Protocol,
    ProtocolFile,
)
from vbraille.sessions.planning.trial import Stimulus
from vbraille.toml import WrongValue, located, read_toml, which

FOLDER = Path(__file__).parents[1] / "protocols"
OWN_FILE = "protocol.toml"
MOST_TRIALS = 100_000
# Numbers along which thresholds are found.
NUMBERS = {"contrast", "texture", "dot_width_mm", "dot_spacing_mm", "cell_gap_mm", "row_spacing_mm"}


def shipped() -> list[str]:
    """Return the names of the protocols that come with the program."""
    return sorted(path.stem for path in FOLDER.glob("*.toml"))


def load_protocol(name: str) -> Protocol:
    """Read a protocol that comes with the program, or that of a TOML file.

    Raises
    ------
    InputError
        If there is no such protocol, or it cannot be used.
    """
    path = Path(name) if name.endswith(".toml") or "/" in name else FOLDER / f"{name}.toml"
    if path.parent == FOLDER and not path.exists():
        said = f"unknown protocol {name!r}{which(name, shipped())}"
        raise InputError(f"{said}; that of a file ends in .toml")
    files: dict[str, bytes] = {}
    reads = name
    try:
        files[OWN_FILE] = path.read_bytes()
        for beside in _tables(files, name)[1].beside:
            reads = f"{name} names {beside}"
            files[beside] = (path.parent / beside).read_bytes()
    except OSError as error:
        raise InputError(f"{reads}: {error.strerror}") from None
    return parse_protocol(files, name)


def parse_protocol(files: dict[str, bytes], where: str, *, planned: bool = False) -> Protocol:
    """Read a protocol of the content of its file and of those beside it.

    Parameters
    ----------
    where
        Name of the protocol's file, for messages.
    planned
        Whether it is that of a session, whose plan has the cells of all texts: no braille table is
        asked for them again.

    Raises
    ------
    InputError
        If it cannot be used; the line is named.
    """
    text, tables = _tables(files, where)
    try:
        protocol = _resolved(tables, files)
        if not planned:
            check(protocol)
    except WrongValue as error:
        raise located(text, where, error) from None
    return protocol


def _tables(files: dict[str, bytes], where: str) -> tuple[str, ProtocolFile]:
    try:
        text = unicodedata.normalize("NFC", files[OWN_FILE].decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise InputError(f"{where} is not UTF-8; save it as UTF-8") from None
    return text, read_toml(text, ProtocolFile, where)


def _resolved(tables: ProtocolFile, files: dict[str, bytes]) -> Protocol:
    """Return the protocol with the items and orders of its files, and what it leaves out."""
    protocol = Protocol(**structs.asdict(tables), files=files)
    design, items, practice = protocol.design, protocol.items, protocol.practice
    if isinstance(design, ItemList) != (items is not None):
        raise WrongValue("items", "and [design] kind = 'items' go together; give both or neither")
    if items is not None:
        rows = read_items(files[items.file], items.file)
        shown = _told("items.file", lambda: protocol.spelled(rows))
        columns = dict(zip(shown, rows.values(), strict=True))
        design = structs.replace(design, strings=tuple(rows))
        protocol = structs.replace(protocol, design=design, columns=columns)
    if protocol.shows_pictures and practice.most and not practice.strings:
        # A picture is learnt before it is asked for, and nothing of it is given away.
        practice = structs.replace(practice, strings=tuple(protocol.items_shown))
        protocol = structs.replace(protocol, practice=practice)
    if design.orders is not None:
        names = [each.name for each in protocol.conditions]
        orders = read_orders(files[design.orders], design.orders, names, protocol.groups)
        protocol = structs.replace(protocol, orders=orders)
    return structs.replace(protocol, analysis=_planned(protocol))


def _planned(protocol: Protocol) -> Analysis:
    """Return the analysis with the usual measure and factors where the file has none."""
    given, asks, procedure = protocol.analysis, protocol.asks, protocol.procedure
    varied = {factor.name: factor.levels for factor in protocol.factors}
    if len(protocol.listed) > 1:
        varied["condition"] = protocol.listed
    along = [n for n, looks in varied.items() if any(NUMBERS & look.given.keys() for look in looks)]
    measures = MEASURES_OF[asks.kind]
    thresholds = procedure or (asks.kind == "detect" and along)
    if asks.kind == "which":
        thresholds = asks.right
    measure = given.measure or ("threshold" if thresholds else next(iter(measures), None))
    if measure not in (*measures, None):
        wrong = f"{measure!r} is not of {asks.kind}{which('', measures)}"
        raise WrongValue("analysis.measure", wrong)
    factors = given.factors
    if factors is None:
        found_along = along if measure == "threshold" and procedure is None else []
        factors = tuple(name for name in varied if name not in found_along)
    known = [*varied, *(f"item_{column}" for column in protocol.item_columns)]
    for factor in factors:
        if factor not in known:
            raise WrongValue("analysis.factors", f"{factor!r} does not vary{which(factor, known)}")
    return structs.replace(given, measure=measure, factors=factors)


Faults = Iterator[tuple[str, object, str]]  # key, whether something is wrong with it, and why


def check(protocol: Protocol) -> None:
    """Check that a session of a protocol shows what it should, keeps it, and is as long as it says.

    Raises
    ------
    WrongValue
        If it does not.
    """
    for key, dots in protocol.keys.items():
        if len(key) != 1 or len(_told(f"keys.{key}", lambda dots=dots: spell(dots, {}))) != 1:
            raise WrongValue(f"keys.{key}", "a key is one character, and stands for one cell")
    strings = isinstance(protocol.design, StringList)
    _told("design.strings" if strings else "design.characters", lambda: protocol.items_shown)
    _told("practice.strings", lambda: protocol.practised)
    for rules in (_names, _shows, _asks, _chooses, _orders):
        for where, wrong, why in rules(protocol):
            if wrong:
                raise WrongValue(where, why)
    for group in protocol.groups or ("",):
        for condition in protocol.conditions:
            _check_shown(protocol.of_group(group), condition)


def _told(where: str, made: Callable[[], Any]) -> Any:
    try:
        return made()
    except ValueError as error:
        raise WrongValue(where, str(error)) from None


def _names(protocol: Protocol) -> Faults:
    """Find names and columns that two things share, and names of nothing."""
    within = any(not factor.between for factor in protocol.factors)
    yield "conditions", within and protocol.listed, "are made by [[factors]]; leave one out"
    for where, tables in (
        ("conditions", protocol.listed),
        ("factors", protocol.factors),
        ("factors", protocol.conditions),
        ("fields", protocol.fields),
    ):
        names = [each.name for each in tables]
        for n, name in enumerate(names):
            yield f"{where}.{n}.name", name in names[:n], f"{name!r} is there twice"
    conditions = [each.name for each in protocol.conditions]
    for name in protocol.markers.codes:
        known = which(name, conditions)
        yield "markers.codes", name not in conditions, f"{name!r} is no condition{known}"
    columns: set[str] = set()
    for n, item in enumerate(protocol.questionnaire):
        own = {item.name, f"{item.name}_correct"} if item.right else {item.name}
        taken = ", ".join(own & columns)
        yield f"questionnaire.{n}.name", taken, f"the column {taken} is there already"
        columns |= own
        unknown = item.columns - set(protocol.item_columns if item.when == "trial" else ())
        yield f"questionnaire.{n}.ask", unknown, "names a column that no item has"


def _shows(protocol: Protocol) -> Faults:
    """Find faults in how much is shown, and how."""
    design, practice = protocol.design, protocol.practice
    texts, pictures = protocol.has_texts, protocol.shows_pictures
    compared, catch = isinstance(design, Compared), design.catch
    strings = isinstance(design, StringList)
    yield "design.kind", texts and not strings, "shows cells; table and scene are of lists"
    reorders = texts and getattr(design, "reorder", False)
    yield "design.reorder", reorders, "is of cells, and strings are texts or pictures"
    unread = design.passage and (not texts or pictures or catch)
    yield "design.passage", unread, "is of texts with a table, without catch"
    ordered = design.order or design.orders
    yield "design.order", ordered and design.blocks != "conditions", "is for blocks = 'conditions'"
    shown = 1 if design.counterbalanced else len(protocol.conditions)
    trials = len(protocol.items_shown) * design.repeats * shown + practice.most
    yield "design.repeats", not 0 < trials <= MOST_TRIALS, f"makes {trials} trials"
    unfit = catch and (compared or pictures or (protocol.procedure and catch.show == "repeat"))
    yield "design.catch", unfit, "is of strings, which no procedure repeats; leave it out"
    own = practice.values if compared else practice.strings
    yield "practice", practice.most and not own, "has nothing of its own; give strings or values"


def _asks(protocol: Protocol) -> Faults:
    """Find faults in how a question is asked and answered."""
    asks, design = protocol.asks, protocol.design
    pictures = protocol.shows_pictures
    form = design.form or ("pictures" if pictures else "passages" if design.passage else "strings")
    fits = form in asks.asks_of or (form == "passages" and asks.kind == "free")
    yield "question.kind", not fits, f"{asks.kind!r} is not asked of {form}"
    for choice in getattr(asks, "choices", ()):
        named = {row.get(choice.of or "") for row in protocol.columns.values()}
        unnamed = choice.of and named - {*choice.names.values()}
        yield "question.choices", unnamed, f"lack a name in the column {choice.of!r} of the items"
    off_device = protocol.medium == "paper" or any(look.on == "pins" for look in protocol.looks)
    changes = protocol.trial.exposure_s or protocol.procedure or protocol.pins.reference
    changes = changes or form != "strings"
    yield "medium", off_device and changes, "paper and pins show strings for any time, alone"


def _chooses(protocol: Protocol) -> Faults:
    """Find faults in how a procedure chooses values, and goes by answers."""
    table, design, asks = protocol.procedure, protocol.design, protocol.asks
    if table is None:
        return
    scores = asks.scores and not protocol.shows_pictures and not design.passage
    yield "procedure", not scores, f"does not go by answers to {asks.kind!r}"
    right = getattr(asks, "right", "more")  # other questions have their own
    least, *_, most = table.levels(design)
    if not isinstance(design, Compared):
        named = table.parameter and least < most
        yield "procedure.parameter", not named, "is needed, and least below most"
    elif design.reference is None:
        preferred = isinstance(table, QuestPlus) and right is None
        yield "procedure.kind", not preferred, "of preferences is 'quest', without a right one"
    else:
        sides = {value > design.reference for value in design.values}
        fits = len(sides) == 1 < len(design.values) and design.form != "standard"
        yield "design.values", not fits, "must be the nearest and furthest on one side"
        unfit = right not in ("more", "less")
        yield "question.right", unfit, "must be 'more' or 'less' for [procedure]"
    for start in getattr(table, "start", ()):
        yield "procedure.start", not least <= start <= most, f"is not from {least:g} to {most:g}"
    if isinstance(table, QuestPlus):
        unguessed = asks.kind == "detect" and not any(table.guess or ())
        yield "procedure.guess", unguessed, "is missing, and people say yes at nothing too"
        quest_of(table, design)


def _orders(protocol: Protocol) -> Faults:
    """Find rules of what does not vary, and letters that are not shown as often as they should."""
    rules = protocol.rules
    within = [factor.name for factor in protocol.factors if not factor.between]
    known = ["condition", *within, *protocol.item_columns]
    for name in rules.at_most_running:
        said = f"{name!r} does not vary{which(name, known)}"
        yield "rules.at_most_running", name not in known, said
    exactly, least = rules.each_letter, rules.each_letter_at_least or 0
    counts = Counter("".join(protocol.items_shown * protocol.design.repeats))
    for letter, mask in LETTERS.items():
        count = counts[to_braille((mask,))]
        said = f"{letter} is shown {count} times"
        yield "rules.each_letter", exactly not in (None, count), said
        yield "rules.each_letter_at_least", count < least, said


def _check_shown(protocol: Protocol, condition: Condition) -> None:
    """Check that the display can show all items of a condition, and make their cells."""
    look, key = condition.over(protocol.display), "factors" if protocol.factors else "display"
    if condition in protocol.listed:
        key = f"conditions.{protocol.listed.index(condition)}"
    _told(key, lambda: protocol.style(look))
    if (look.table is None and look.scene is None) == protocol.has_texts:
        raise WrongValue(key, "has no table or scene, and others have; give it one, or [display]")
    if protocol.varied in condition.given:
        raise WrongValue(key, "sets what [design] or [procedure] varies; leave it out")
    looks, table = [look], protocol.procedure
    if table is not None and table.parameter is not None:  # strings are checked at both ends
        ends = table.levels(protocol.design)
        looks += [look.changed(table.parameter, end) for end in ends]
    setting = Setting(protocol.masks, protocol.room, Random(0))
    for where, items in (("design", protocol.items_shown), ("practice", protocol.practised)):
        for item, shown in itertools.product(items, looks):
            try:
                for stimulus in protocol.design.stimuli(item, shown, setting):
                    check_stimulus(protocol, stimulus)
            except ValueError as error:
                raise WrongValue(where, f"in {condition.name}: {error}") from None


def check_stimulus(protocol: Protocol, stimulus: Stimulus) -> None:
    """Check that the display has the room and the dots for a stimulus.

    Raises
    ------
    ValueError
        If it has not.
    """
    if stimulus.picture:
        # This loads what compiles pictures; protocols of strings need none of it.
        from vbraille.sessions.planning.pictures import check_picture

        check_picture(protocol, stimulus)
        return
    if stimulus.on == "pins":
        return
    shown = protocol.style(stimulus.look).mapping.shown_dots()
    masks = stimulus.masks(0)
    if not any(masks):
        raise ValueError("a string has no dots, and nothing can be felt of it")
    if hidden := next((mask for mask in masks if mask & ~shown), None):
        raise ValueError(
            f"{to_braille((hidden,))} has {name_dots(hidden)}; the display shows {name_dots(shown)}"
        )
    if len(masks) > (room := protocol.room(stimulus.look)):
        raise ValueError(f"a line has {len(masks)} cells, and there is room for {room}")
