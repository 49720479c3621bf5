"""Reads protocols, with the files beside them, and checks that their tables agree."""

from __future__ import annotations

import unicodedata
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from random import Random

from msgspec import structs

from vbraille.braille.spelling import LETTERS, name_dots, spell, spell_string, to_braille
from vbraille.errors import InputError
from vbraille.sessions.planning.analysis import MEASURES, Analysis
from vbraille.sessions.planning.design import Combinations, Compared, ItemList, Setting, StringList
from vbraille.sessions.planning.factors import crossed
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
    items, name = protocol.items, protocol.items.file
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
    """Check that the tables of a protocol agree, so that a session shows and keeps what it should.

    Raises
    ------
    WrongValue
        If they do not.
    """
    _items(protocol)
    _check_names(protocol)
    _check_design(protocol)
    _check_question(protocol)
    _check_procedure(protocol)
    _check_rules(protocol)
    _check_practice(protocol)
    for group in protocol.groups or ("",):
        for condition in protocol.conditions:
            _check_shown(protocol.of_group(group), condition)


def _check_names(protocol: Protocol) -> None:
    if protocol.listed and any(not factor.between for factor in protocol.factors):
        raise WrongValue("conditions", "are made by [[factors]]; leave one of the two out")
    for key, tables in (
        ("conditions", protocol.listed),
        ("factors", protocol.factors),
        ("fields", protocol.fields),
    ):
        _check_once(key, [table.name for table in tables])
    for n, factor in enumerate(protocol.factors):
        _check_once(f"factors.{n}.levels", [level.name for level in factor.levels], "")
        if len({frozenset(level.given) for level in factor.levels}) > 1:
            raise WrongValue(f"factors.{n}.levels", "must all change the same")
    known = {level.name for factor in protocol.factors for level in factor.levels}
    for listed in protocol.cross if protocol.cross != "all" else ():
        if len(listed) != len(protocol.factors) or not set(listed) <= known:
            raise WrongValue("cross", f"has {listed}; give a level of each factor, in their order")
    if not crossed(protocol.factors, protocol.cross, between=False):
        raise WrongValue("cross", "leaves no condition")
    # The column of a question, and that of whether its answer is right.
    columns: list[str] = []
    for n, item in enumerate(protocol.questionnaire):
        own = [item.name, *([f"{item.name}_correct"] if item.right else [])]
        if taken := [name for name in own if name in columns]:
            raise WrongValue(f"questionnaire.{n}.name", f"the column {taken[0]} is there already")
        columns += own
        unknown = item.columns - set(protocol.item_columns if item.when == "trial" else ())
        if unknown:
            raise WrongValue(f"questionnaire.{n}.ask", f"no item has a column {min(unknown)!r}")
    names = [condition.name for condition in protocol.conditions]
    for name in protocol.markers.codes:
        if name not in names:
            raise WrongValue("markers.codes", f"{name!r} is no condition{which(name, names)}")
    codes = protocol.marker_codes
    if protocol.markers.codes and len(set(codes.values())) < len(codes):
        raise WrongValue("markers.codes", "give two conditions the same; name all of them")


def _check_once(key: str, names: list[str], last: str = ".name") -> None:
    for n, name in enumerate(names):
        if name in names[:n]:
            raise WrongValue(f"{key}.{n}{last}" if last else key, f"{name!r} is there twice")


def _check_design(protocol: Protocol) -> None:
    design, conditions = protocol.design, len(protocol.conditions)
    cells = isinstance(design, StringList) and not protocol.has_texts
    if protocol.has_texts and not isinstance(design, StringList):
        raise WrongValue("design.kind", "shows cells, and table or scene make strings of texts")
    if not cells and (getattr(design, "reorder", False) or (protocol.keys and protocol.has_texts)):
        raise WrongValue("design.reorder", "and [keys] are of cells; leave them out")
    if design.passage and (not protocol.has_texts or protocol.shows_pictures or design.catch):
        raise WrongValue("design.passage", "is of texts with a braille table, without catch trials")
    if design.blocks != "conditions" and (protocol.order or design.order):
        raise WrongValue(
            "order" if protocol.order else "design.order", "is for blocks = 'conditions'"
        )
    if protocol.order and design.order:
        raise WrongValue("design.order", "is in the table [order]; leave it out here")
    trials = (
        len(protocol.items_shown) * design.repeats * (1 if design.counterbalanced else conditions)
    )
    if not 0 < trials + protocol.practice.most <= MOST_TRIALS:
        raise WrongValue("design.repeats", f"makes {trials} trials of at most {MOST_TRIALS}")
    if design.counterbalanced and len(protocol.items_shown) % conditions:
        raise WrongValue("design.counterbalanced", f"needs as many items for each of {conditions}")
    if isinstance(design.blocks, int) and design.blocks > trials:
        raise WrongValue("design.blocks", f"is more than the {trials} trials")
    if design.catch is not None:
        blank = design.catch.show == "blank"
        if (
            isinstance(design, Compared)
            or protocol.shows_pictures
            or (protocol.procedure and not blank)
        ):
            raise WrongValue(
                "design.catch", "is of strings, which no procedure repeats; leave it out"
            )
        if trials < design.catch.stretch:
            raise WrongValue("design.catch", f"would be none among {trials} trials")


def _check_question(protocol: Protocol) -> None:
    asks, design = protocol.asks, protocol.design
    form = "passages" if design.passage else "pictures" if protocol.shows_pictures else "strings"
    if isinstance(design, Compared):
        form = design.form
    if form not in asks.asks_of and not (form == "passages" and asks.kind == "free"):
        raise WrongValue("question.kind", f"{asks.kind!r} is not asked of {form}")
    if isinstance(asks, Which) and isinstance(design, Compared):
        if asks.right is None and design.form == "one" and design.intervals > 2:
            raise WrongValue(
                "question.right", "is missing, and there are more than two to choose from"
            )
        if design.same or design.reference in design.values:
            raise WrongValue("design.values", "have two that are the same, of which none is chosen")
    if isinstance(asks, Pick):
        for n, choice in enumerate(asks.choices):
            named = {row.get(choice.of or "") for row in protocol.columns.values()}
            if choice.of and choice.of not in protocol.item_columns:
                raise WrongValue("question.choices", f"number {n + 1}: no item has a {choice.of!r}")
            if choice.of and named - {*choice.names.values()}:
                raise WrongValue("question.choices", f"{choice.of} lacks a name that an item has")
    off_device = protocol.medium == "paper" or any(look.on == "pins" for look in protocol.looks)
    if off_device and (
        protocol.trial.exposure_s
        or protocol.procedure
        or asks.kind == "adjust"
        or protocol.shows_pictures
        or design.passage
        or isinstance(design, Compared)
    ):
        raise WrongValue("medium", "paper and pins show strings that do not change, for any time")
    if protocol.pins.reference and off_device:
        raise WrongValue("pins.reference", "stands beside the device; leave it out")
    if protocol.trial.end and protocol.medium == "paper":
        raise WrongValue("trial.end", "is of a device; on paper Enter ends reading")
    if getattr(asks, "buttons", None) and protocol.trial.button:
        raise WrongValue(
            "trial.end", "is a button, which answers already; leave one of the two out"
        )


def _check_procedure(protocol: Protocol) -> None:
    table, design, asks = protocol.procedure, protocol.design, protocol.asks
    if table is None:
        return
    if not asks.scores or protocol.shows_pictures or design.passage:
        raise WrongValue("procedure", f"does not go by answers to {asks.kind!r}")
    if protocol.trial.late == "missed":
        raise WrongValue("trial.late", "leaves trials without an answer, which [procedure] goes by")
    if isinstance(design, Compared):
        if protocol.rules.never_twice_running:
            raise WrongValue(
                "rules.never_twice_running", "is of fixed values, which [procedure] chooses"
            )
        if table.parameter or table.least is not None or table.most is not None:
            raise WrongValue("procedure.parameter", "and its bounds are those of [design]")
        if design.reference is None and (not isinstance(table, QuestPlus) or asks.right):
            raise WrongValue(
                "procedure.kind", "of preferences is 'quest', and [question] right is left out"
            )
        if design.reference is not None:
            aside = {value > design.reference for value in design.values}
            if design.form in ("standard", "single") or len(aside) > 1 or len(design.values) < 2:
                raise WrongValue("design.values", "must be the nearest and furthest on one side")
            if isinstance(asks, Which) and asks.right not in ("more", "less"):
                raise WrongValue("question.right", "must be 'more' or 'less' for [procedure]")
    elif (
        not table.parameter
        or table.least is None
        or table.most is None
        or table.least >= table.most
    ):
        raise WrongValue("procedure.parameter", "is needed, with least below most")
    least, most = table.bounds(design)
    for start in getattr(table, "start", ()):
        if not least <= start <= most:
            raise WrongValue("procedure.start", f"{start:g} is not from {least:g} to {most:g}")
    if isinstance(table, QuestPlus):
        if asks.kind == "detect" and not any(table.guess or ()):
            raise WrongValue("procedure.guess", "is missing, and people say yes at nothing too")
        quest_of(table, design)


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
    if not isinstance(design, StringList) or protocol.has_texts:
        raise WrongValue("rules.each_letter", "is of lists of cells; leave it out")
    counts = Counter("".join(protocol.items_shown * design.repeats))
    for letter, mask in LETTERS.items():
        count = counts[to_braille((mask,))]
        if exactly not in (None, count) or count < least:
            key = "each_letter" if exactly is not None else "each_letter_at_least"
            raise WrongValue(f"rules.{key}", f"{letter} is shown {count} times")


def _check_practice(protocol: Protocol) -> None:
    practice, design = protocol.practice, protocol.design
    given, wanted = practice.strings, practice.values
    if isinstance(design, Compared):
        given, wanted = wanted, given
    if wanted:
        raise WrongValue("practice", "has strings where values are compared, or values of strings")
    if practice.most and not given:
        raise WrongValue(
            "practice", "has nothing of its own; give strings or values, or trials = 0"
        )
    if practice.until and protocol.asks.kind in ("rating", "magnitude", "free", "adjust", "read"):
        raise WrongValue("practice.until", "counts right answers, and none is right")
    if protocol.shows_pictures:
        return
    if isinstance(design, Compared):
        shown = {*design.values, design.reference}
        given_away = next((f"{value:g}" for value in practice.values if value in shown), "")
    elif isinstance(design, Combinations):
        items = set(protocol.items_shown)
        given_away = next((item for item in _practised(protocol) if item in items), "")
    else:
        order = sorted if getattr(design, "reorder", False) else list
        items = [order(item) for item in protocol.items_shown]
        given_away = next((item for item in _practised(protocol) if order(item) in items), "")
    if given_away:
        raise WrongValue("practice", f"has {given_away}, which the test shows; give another")


def _practised(protocol: Protocol) -> list[str]:
    try:
        return protocol.practised
    except ValueError as error:
        raise WrongValue("practice.strings", str(error)) from None


def _check_shown(protocol: Protocol, condition: Condition) -> None:
    """Check that the display can show all items of a condition, and make their cells."""
    look, key = condition.over(protocol.display), _key_of(protocol, condition)
    try:
        protocol.style(look)
    except ValueError as error:
        raise WrongValue(key, str(error)) from None
    if (look.table is None and look.scene is None) == protocol.has_texts:
        raise WrongValue(key, "has no table or scene, and others have; give it one, or [display]")
    compared = protocol.design.parameter or getattr(protocol.procedure, "parameter", None)
    if compared in condition.given:
        raise WrongValue(key, f"sets {compared}, which [design] or [procedure] varies")
    setting = Setting(protocol.masks, protocol.room, Random(0))
    for table, items in (("design", _items(protocol)), ("practice", _practised(protocol))):
        for item in items:
            try:
                for stimulus in protocol.design.stimuli(item, look, setting):
                    check_stimulus(protocol, stimulus)
                    _check_varied(protocol, stimulus)
            except ValueError as error:
                raise WrongValue(table, f"in {condition.name}: {error}") from None


def _items(protocol: Protocol) -> list[str]:
    for key, dots in protocol.keys.items():
        try:
            if len(key) != 1 or len(spell(dots, {})) != 1:
                raise ValueError("a key is one character, and stands for one cell")
        except ValueError as error:
            raise WrongValue(f"keys.{key}", str(error)) from None
    try:
        return protocol.items_shown
    except ValueError as error:
        key = "strings" if isinstance(protocol.design, StringList) else "characters"
        raise WrongValue(f"design.{key}", str(error)) from None


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


def _key_of(protocol: Protocol, condition: Condition) -> str:
    if condition in protocol.listed:
        return f"conditions.{protocol.listed.index(condition)}"
    return "factors.0" if protocol.factors else "display"
