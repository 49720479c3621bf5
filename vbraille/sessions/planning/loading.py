"""Reads protocols, with the files beside them, and checks that their tables agree."""

from __future__ import annotations

import unicodedata
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from random import Random
from typing import Any

from msgspec import structs

from vbraille.braille.spelling import LETTERS, name_dots, spell, spell_string, to_braille
from vbraille.errors import InputError
from vbraille.sessions.planning.analysis import MEASURES, Analysis
from vbraille.sessions.planning.design import Compared, ItemList, Setting, StringList
from vbraille.sessions.planning.items import read_items, read_orders, read_words
from vbraille.sessions.planning.procedures import QuestPlus, quest_of
from vbraille.sessions.planning.protocol import Condition, Protocol, ProtocolFile
from vbraille.sessions.planning.questions import Pick, Which
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
    try:
        files = {OWN_FILE: path.read_bytes()}
    except OSError as error:
        if path.parent == FOLDER:
            said = f"there is no protocol {name!r}{which(name, shipped())}"
            raise InputError(f"{said}; that of a file ends in .toml") from None
        raise InputError(f"{name}: {error.strerror}") from None
    text, tables = _tables(files, name)
    for key, beside in _named_files(tables):
        try:
            files[beside] = (path.parent / beside).read_bytes()
        except OSError as error:
            wrong = WrongValue(key, f"is {beside!r}: {error.strerror}")
            raise located(text, name, wrong) from None
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


def _named_files(tables: ProtocolFile) -> Iterable[tuple[str, str]]:
    """Go through the files that a protocol names, each with the path of its key."""
    named: list[tuple[str, str | None]] = [
        ("items.file", tables.items and tables.items.file),
        ("practice.file", tables.practice.file),
        ("order.file", tables.order and tables.order.file),
        ("display.scene", tables.display.scene),
    ]
    named += [(f"conditions.{n}.scene", each.scene) for n, each in enumerate(tables.listed)]
    for n, factor in enumerate(tables.factors):
        named += [(f"factors.{n}.levels", level.scene) for level in factor.levels]
    return [(key, name) for key, name in named if name]


def _resolved(tables: ProtocolFile, files: dict[str, bytes]) -> Protocol:
    """Return the protocol with the items and orders of its files."""
    protocol = Protocol(**{n: getattr(tables, n) for n in tables.__struct_fields__}, files=files)
    if isinstance(tables.design, ItemList) != (tables.items is not None):
        raise WrongValue("items", "and [design] kind = 'items' go together; give both or neither")
    if isinstance(tables.design, ItemList):
        strings, columns = _listed(protocol)
        design = tables.design.listed(strings)
        protocol = structs.replace(protocol, design=design, columns=columns)
    practice = protocol.practice
    if practice.file is not None:
        strings = tuple(read_items(files[practice.file], practice.file))
        practice = structs.replace(practice, strings=strings)
    if protocol.shows_pictures and practice.most and not practice.strings:
        # A picture is learnt before it is asked for, and nothing of it is given away.
        practice = structs.replace(practice, strings=tuple(protocol.items_shown))
    protocol = structs.replace(protocol, practice=practice)
    if protocol.order is not None and protocol.order.file is not None:
        name, conditions = protocol.order.file, [each.name for each in protocol.conditions]
        orders = read_orders(files[name], name, conditions, protocol.groups)
        protocol = structs.replace(protocol, orders=orders)
    return structs.replace(protocol, analysis=_planned(protocol))


def _listed(protocol: Protocol) -> tuple[list[str], dict[str, dict[str, str]]]:
    """Return the strings of [items], and the other columns of each by the item."""
    items = protocol.items
    assert items is not None, "it is checked"
    name = items.file or ""
    if items.rule == "strings" and protocol.has_texts:
        raise WrongValue("items.rule", "draws cells, and strings are texts or pictures")
    if items.rule is None:
        rows = read_items(protocol.files[name], name)
        if protocol.has_texts:
            return list(rows), rows
        return list(rows), {_cells(s, protocol, name): row for s, row in rows.items()}
    words = read_words(protocol.files[name]) if name else []
    if protocol.has_texts:
        return items.draw(words, list(items.characters)), {}
    cells = [to_braille(spell(text, protocol.masks)) for text in items.characters]
    return items.draw([_cells(word, protocol, name) for word in words], cells), {}


def _cells(text: str, protocol: Protocol, where: str | None) -> str:
    try:
        return to_braille(spell_string(text, protocol.masks))
    except ValueError as error:
        raise InputError(f"{where}: {error}") from None


def _planned(protocol: Protocol) -> Analysis:
    """Return the analysis with the usual measure and factors where the file has none."""
    given, asks = protocol.analysis, protocol.asks
    changed = {name: set() for name in (factor.name for factor in protocol.factors)}
    for factor in protocol.factors:
        changed[factor.name] = {key for level in factor.levels for key in level.given}
    if len(protocol.listed) > 1:
        changed["condition"] = {key for each in protocol.listed for key in each.given}
    along = [name for name, keys in changed.items() if keys & NUMBERS]
    measure = given.measure
    if measure is None:
        known = (name for name, each in MEASURES.items() if asks.kind in each.questions)
        measure = next(known, None)
        if asks.kind == "detect":
            measure = "threshold" if protocol.procedure or along else "d_prime"
        elif asks.kind == "which":
            measure = "threshold" if asks.right else "preferred"
        elif protocol.procedure is not None:
            measure = "threshold"
    factors = given.factors
    if factors is None:
        found_along = measure == "threshold" and protocol.procedure is None
        factors = tuple(name for name in changed if not (found_along and name in along))
    if measure is not None and asks.kind not in MEASURES[measure].questions:
        known = [name for name, each in MEASURES.items() if asks.kind in each.questions]
        raise WrongValue("analysis.measure", f"{measure!r} is not of {asks.kind}{which('', known)}")
    for factor in factors:
        known = [*changed, *(f"item_{column}" for column in protocol.item_columns)]
        if factor not in known:
            raise WrongValue("analysis.factors", f"{factor!r} does not vary{which(factor, known)}")
    if given.catch_right is not None and protocol.design.catch is None:
        raise WrongValue("analysis.catch_right", "is of catch trials, and [design] has none")
    return structs.replace(given, measure=measure, factors=factors)


def check(protocol: Protocol) -> None:
    """Check that a session of a protocol shows what it should, keeps it, and is as long as it says.

    Raises
    ------
    WrongValue
        If it does not.
    """
    _check_keys(protocol)
    for rules in (_conditions, _designs, _questions, _procedures, _practice):
        for where, wrong, why in rules(protocol):
            if wrong:
                raise WrongValue(where, why)
    _check_columns(protocol)
    _check_rules(protocol)
    for group in protocol.groups or ("",):
        for condition in protocol.conditions:
            _check_shown(protocol.of_group(group), condition)


Rules = Iterator[tuple[str, object, str]]  # key, whether something is wrong with it, and why


def _check_keys(protocol: Protocol) -> None:
    """Check that all spellings can be read."""
    for key, dots in protocol.keys.items():
        if len(key) != 1 or len(_told(f"keys.{key}", lambda dots=dots: spell(dots, {}))) != 1:
            raise WrongValue(f"keys.{key}", "a key is one character, and stands for one cell")
    listed = isinstance(protocol.design, StringList)
    _told("design.strings" if listed else "design.characters", lambda: protocol.items_shown)
    _told("practice.strings", lambda: protocol.practised)


def _told(where: str, made: Callable[[], Any]) -> Any:
    try:
        return made()
    except ValueError as error:
        raise WrongValue(where, str(error)) from None


def _conditions(protocol: Protocol) -> Rules:
    within = any(not factor.between for factor in protocol.factors)
    yield "conditions", within and protocol.listed, "are made by [[factors]]; leave one out"
    names = [condition.name for condition in protocol.conditions]
    for where, own in (
        ("conditions", [each.name for each in protocol.listed]),
        ("factors", [each.name for each in protocol.factors]),
        ("fields", [each.name for each in protocol.fields]),
        ("factors", names),
    ):
        for n, name in enumerate(own):
            yield f"{where}.{n}.name", name in own[:n], f"{name!r} is there twice"
    yield "cross", not names, "leaves no condition"
    for name in protocol.markers.codes:
        known = which(name, names)
        yield "markers.codes", name not in names, f"{name!r} is no condition{known}"
    codes = list(protocol.marker_codes.values())
    doubled = protocol.markers.codes and len(set(codes)) < len(codes)
    yield "markers.codes", doubled, "give two conditions the same; name all of them"


def _designs(protocol: Protocol) -> Rules:
    design, texts = protocol.design, protocol.has_texts
    compared, listed = isinstance(design, Compared), isinstance(design, StringList)
    yield "design.kind", texts and not listed, "shows cells; table and scene are of lists"
    yield "keys", texts and protocol.keys, "are of cells, and table makes them of texts"
    reordered = texts and getattr(design, "reorder", False)
    yield "design.reorder", reordered, "is of cells, and strings are texts or pictures"
    no_texts = not texts or protocol.shows_pictures or design.catch
    yield "design.passage", design.passage and no_texts, "is of texts with a table, without catch"
    ordered = protocol.order or design.order
    where = "order" if protocol.order else "design.order"
    yield where, ordered and design.blocks != "conditions", "is for blocks = 'conditions'"
    yield where, protocol.order and design.order, "is in [design] as well; leave one out"
    shown = 1 if design.counterbalanced else len(protocol.conditions)
    trials = len(protocol.items_shown) * design.repeats * shown + protocol.practice.most
    yield "design.repeats", trials > MOST_TRIALS, f"makes {trials} trials of {MOST_TRIALS} at most"
    catch = design.catch
    if catch is not None:
        chosen = protocol.procedure is not None and catch.show == "repeat"
        unfit = compared or protocol.shows_pictures or chosen
        yield "design.catch", unfit, "is of strings, which no procedure repeats; leave it out"


def _questions(protocol: Protocol) -> Rules:
    asks, design, pace = protocol.asks, protocol.design, protocol.trial
    form = "pictures" if protocol.shows_pictures else "strings"
    form = "passages" if design.passage else design.form or form
    fits = form in asks.asks_of or (form == "passages" and asks.kind == "free")
    yield "question.kind", not fits, f"{asks.kind!r} is not asked of {form}"
    if isinstance(asks, Which) and isinstance(design, Compared):
        several = asks.right is None and design.form == "one" and design.intervals > 2
        yield "question.right", several, "is missing, and there are more than two to choose from"
        same = design.same or design.reference in design.values
        yield "design.values", same, "have two that are the same, of which none is chosen"
    for choice in asks.choices if isinstance(asks, Pick) else ():
        named = {row.get(choice.of or "") for row in protocol.columns.values()}
        unnamed = choice.of and named - {*choice.names.values()}
        yield "question.choices", unnamed, f"lack a name in the column {choice.of!r} of the items"
    off_device = protocol.medium == "paper" or any(look.on == "pins" for look in protocol.looks)
    changes = pace.exposure_s or protocol.procedure or asks.kind == "adjust" or design.passage
    changes = changes or protocol.shows_pictures or isinstance(design, Compared)
    yield "medium", off_device and changes, "paper and pins show strings for any time"
    yield "pins.reference", off_device and protocol.pins.reference, "stands beside the device"
    yield "trial.end", pace.end and protocol.medium == "paper", "is Enter on paper; leave it out"
    yield "trial.end", pace.button and getattr(asks, "buttons", None), "answers already"


def _procedures(protocol: Protocol) -> Rules:
    table, design, asks = protocol.procedure, protocol.design, protocol.asks
    if table is None:
        return
    scores = asks.scores and not protocol.shows_pictures and not design.passage
    yield "procedure", not scores, f"does not go by answers to {asks.kind!r}"
    yield "trial.late", protocol.trial.late == "missed", "leaves trials without an answer"
    if isinstance(design, Compared):
        twice = protocol.rules.never_twice_running
        yield "rules.never_twice_running", twice, "is of fixed values, which [procedure] chooses"
        yield "procedure.parameter", table.parameter, "is that of [design]; leave it out"
        if design.reference is None:
            preferred = isinstance(table, QuestPlus) and asks.right is None
            yield "procedure.kind", not preferred, "of preferences is 'quest', without a right one"
        else:
            sides = {value > design.reference for value in design.values}
            apart = len(sides) == 1 and len(design.values) > 1
            fits = apart and design.form not in ("standard", "single")
            yield "design.values", not fits, "must be the nearest and furthest on one side"
            nearest = isinstance(asks, Which) and asks.right not in ("more", "less")
            yield "question.right", nearest, "must be 'more' or 'less' for [procedure]"
    else:
        bounds = table.least is not None and table.most is not None and table.least < table.most
        yield "procedure.parameter", not (table.parameter and bounds), "needs least below most"
    least, most = table.bounds(design)
    for start in getattr(table, "start", ()):
        yield "procedure.start", not least <= start <= most, f"is not from {least:g} to {most:g}"
    if isinstance(table, QuestPlus):
        unguessed = asks.kind == "detect" and not any(table.guess or ())
        yield "procedure.guess", unguessed, "is missing, and people say yes at nothing too"
        quest_of(table, design)


def _practice(protocol: Protocol) -> Rules:
    practice, design = protocol.practice, protocol.design
    own = practice.values if isinstance(design, Compared) else practice.strings
    yield "practice", practice.most and not own, "has nothing of its own; give strings or values"
    if protocol.shows_pictures:
        return
    if isinstance(design, Compared):
        tested: list[Any] = [*design.values, design.reference]
        given = [value for value in practice.values if value in tested]
    else:
        order = sorted if getattr(design, "reorder", False) else list
        tested = [order(item) for item in protocol.items_shown]
        given = [item for item in protocol.practised if order(item) in tested]
    yield "practice", given, f"has {given[:1]}, which the test shows; give another"


def _check_columns(protocol: Protocol) -> None:
    """Check that each question of the questionnaire has columns of its own, and those it names."""
    columns: list[str] = []
    for n, item in enumerate(protocol.questionnaire):
        own = [item.name, *([f"{item.name}_correct"] if item.right else [])]
        if taken := [name for name in own if name in columns]:
            raise WrongValue(f"questionnaire.{n}.name", f"the column {taken[0]} is there already")
        columns += own
        if item.columns - set(protocol.item_columns if item.when == "trial" else ()):
            raise WrongValue(f"questionnaire.{n}.ask", "names a column that no item has")


def _check_rules(protocol: Protocol) -> None:
    rules, design = protocol.rules, protocol.design
    within = [factor.name for factor in protocol.factors if not factor.between]
    known = ["condition", *within, *protocol.item_columns]
    for name in rules.at_most_running:
        if name not in known:
            raise WrongValue("rules.at_most_running", f"{name!r} does not vary{which(name, known)}")
    exactly, least = rules.each_letter, rules.each_letter_at_least or 0
    if exactly is None and not least:
        return
    counts = Counter("".join(protocol.items_shown * design.repeats))
    for letter, mask in LETTERS.items():
        count = counts[to_braille((mask,))]
        if exactly not in (None, count) or count < least:
            key = "each_letter" if exactly is not None else "each_letter_at_least"
            raise WrongValue(f"rules.{key}", f"{letter} is shown {count} times")


def _check_shown(protocol: Protocol, condition: Condition) -> None:
    """Check that the display can show all items of a condition, and make their cells."""
    look, key = condition.over(protocol.display), "factors" if protocol.factors else "display"
    if condition in protocol.listed:
        key = f"conditions.{protocol.listed.index(condition)}"
    _told(key, lambda: protocol.style(look))
    if (look.table is None and look.scene is None) == protocol.has_texts:
        raise WrongValue(key, "has no table or scene, and others have; give it one, or [display]")
    compared = protocol.design.parameter or getattr(protocol.procedure, "parameter", None)
    if compared in condition.given:
        raise WrongValue(key, f"sets {compared}, which [design] or [procedure] varies")
    setting = Setting(protocol.masks, protocol.room, Random(0))
    for table, items in (("design", protocol.items_shown), ("practice", protocol.practised)):
        for item in items:
            try:
                for stimulus in protocol.design.stimuli(item, look, setting):
                    check_stimulus(protocol, stimulus)
                    _check_varied(protocol, stimulus)
            except ValueError as error:
                raise WrongValue(table, f"in {condition.name}: {error}") from None


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


def _check_varied(protocol: Protocol, stimulus: Stimulus) -> None:
    """Check a string at both ends of what a procedure varies."""
    table = protocol.procedure
    if table is None or table.parameter is None:
        return
    for value in table.bounds(protocol.design):
        look = stimulus.look.changed(table.parameter, value)
        check_stimulus(protocol, structs.replace(stimulus, look=look))
