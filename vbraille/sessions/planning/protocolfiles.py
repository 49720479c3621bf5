"""Reading of protocols, from the program's own folder or from a file."""

from __future__ import annotations

from contextlib import contextmanager
from importlib import resources
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
from msgspec import field

from vbraille.braille.spelling import name_dots, to_braille
from vbraille.errors import InputError
from vbraille.files import read_text
from vbraille.render import Profile
from vbraille.sessions.planning.analysis import CONDITION
from vbraille.sessions.planning.design import MOST_TRIALS, UNFELT, Choice, ItemList, StringList
from vbraille.sessions.planning.factors import check_factors
from vbraille.sessions.planning.items import read_items, read_orders, read_words
from vbraille.sessions.planning.protocol import FORMAT, Protocol, ProtocolFile
from vbraille.sessions.planning.spellings import (
    SpellingKeys,
    cells_of,
    problem_of,
    read_keys,
    spelled,
)
from vbraille.sessions.planning.stimuli import GAP, KNOBS, with_value
from vbraille.sessions.planning.style import CONVENTIONAL, LENGTHS, Condition
from vbraille.tomlfile import TomlFile, which

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


_FOLDER = resources.files("vbraille.sessions.planning").joinpath("protocols")


def builtin_names() -> list[str]:
    """Names of the protocols that come with the program."""
    files = _FOLDER.iterdir()
    return sorted(f.name.removesuffix(".toml") for f in files if f.name.endswith(".toml"))


def builtin_text(name: str) -> str:
    """TOML text of a protocol that comes with the program, or text of a file beside it by its name.

    Raises
    ------
    InputError
        If there is no such protocol or file; the message suggests the nearest name.
    """
    names = builtin_names()
    if name in {file.name for file in _FOLDER.iterdir()}:
        return shipped_text(name)
    if name not in names:
        raise InputError(
            f"there is no protocol {name!r}{which(name, names)}; "
            f"that of a file ends in .toml, or has a / in it"
        )
    return shipped_text(f"{name}.toml")


def shipped_text(name: str) -> str:
    """Text of a file that comes with the program's protocols, such as "shapes.csv"."""
    return _FOLDER.joinpath(name).read_bytes().decode("utf-8")


def load_protocol(spec: str) -> Protocol:
    """Read a protocol.

    Parameters
    ----------
    spec
        Name of a protocol that comes with the program; or the path of a file, if it ends in
        ``.toml`` or has a ``/`` in it.

    Raises
    ------
    InputError
        If there is no such protocol, or it cannot be used.
    """
    if spec.endswith(".toml") or "/" in spec:
        folder = Path(spec).parent

        def beside(name: str) -> str:
            return read_text(str(folder / name), "file beside the protocol")

        return parse_protocol(read_text(spec, "protocol"), spec, beside=beside)

    return parse_protocol(builtin_text(spec), f"{spec}.toml", beside=shipped_text)


def parse_protocol(
    text: str,
    where: str,
    *,
    planned: bool = False,
    beside: Callable[[str], str] | None = None,
) -> Protocol:
    """Make a protocol from the text of its file, and check it.

    Parameters
    ----------
    text
        TOML text of the protocol.
    where
        Name of the file, for messages.
    planned
        Whether the protocol belongs to a session, whose plan has the cells of all texts: no
        braille table is asked for them again.
    beside
        Function that reads a file which stands beside the protocol, by its name; None if there is
        none.

    Raises
    ------
    InputError
        If the protocol cannot be used. One sentence says where, why, and what to do.
    """
    file = TomlFile(text, where)
    file.read(_Format)  # this comes first, since another format may have other keys
    keys = file.read(_Keyed, read_keys).keys
    written = _names_texts(file)
    tables = file.read(ProtocolFile, spelled(keys, written=written))
    files = _files(file, tables, beside)
    with file.checking():
        protocol = _resolved(tables, text, files, keys, written=written)
        check_protocol(protocol, planned=planned)
        if protocol.practice.trials and not protocol.practice.items(protocol.design):
            raise ValueError(
                f"[practice] has no items of its own, and those of the test would be given away; "
                f"give {'values' if protocol.parameter else 'strings'} that the test does not "
                f"have, or trials = 0"
            )
    return protocol


def _files(
    file: TomlFile, tables: ProtocolFile, beside: Callable[[str], str] | None
) -> dict[str, str]:
    """Texts of all files that a protocol names, by their names."""
    texts: dict[str, str] = {}
    named = [((n, "file"), getattr(getattr(tables, n), "file", None)) for n in _WITH_FILES]
    named += [(("display", "scene"), tables.display.scene)]
    named += [(("conditions", n, "scene"), each.scene) for n, each in enumerate(tables.listed)]
    named += [
        (("factors", n, "levels", m, "scene"), level.scene)
        for n, factor in enumerate(tables.factors)
        for m, level in enumerate(factor.levels)
    ]
    for place, name in named:
        if name is None or name in texts:
            continue
        if beside is None:
            file.fail(place, f"is {name!r}, and nothing stands beside this protocol")
        try:
            texts[name] = beside(name)
        except (InputError, FileNotFoundError) as error:
            why = error if isinstance(error, InputError) else "there is no such file"
            file.fail(place, f"is {name!r}, which cannot be read: {why}")
    return texts


_WITH_FILES = ("items", "practice", "order")  # tables that may name a file


def _names_texts(file: TomlFile) -> bool:
    """True if a protocol names braille tables or scenes, so that its strings are texts."""
    looks = file.read(_Looks)
    levels = [level for factor in _tables(looks.factors) for level in _tables(factor.get("levels"))]
    return any(
        not look.keys().isdisjoint(("table", "scene"))
        for look in (*_tables([looks.display]), *_tables(looks.conditions), *levels)
    )


def _tables(values: object) -> list[dict[str, Any]]:
    """Tables among the values of a list; none if it is no list."""
    return [each for each in values if isinstance(each, dict)] if isinstance(values, list) else []


def _resolved(
    tables: ProtocolFile,
    text: str,
    files: dict[str, str],
    keys: SpellingKeys,
    *,
    written: bool,
) -> Protocol:
    """Protocol with the items and orders of its files.

    Raises
    ------
    ValueError
        If tables do not go together.
    InputError
        If a file cannot be used.
    """
    design, items, practice, rows, orders = tables.design, tables.items, tables.practice, (), ()
    if isinstance(design, ItemList) != (items is not None):
        raise ValueError(
            "[items] is of kind = 'items' in [design]; give that, or leave it out"
            if items is not None
            else "[design] kind is 'items', and there is no table [items]; add it"
        )
    if isinstance(design, ItemList) and items is not None:
        if items.rule is None:
            assert items.file is not None
            rows = read_items(files[items.file], items.file, keys, written=written)
            strings = tuple(row.masks for row in rows)
        else:
            name, words = items.file, ()
            if name is not None:
                words = read_words(files[name], name, keys, written=written)
            elif written:
                raise ValueError(
                    "[items] rule is 'strings', which draws cells, and table makes cells of texts; "
                    "give words or a list, or leave table out"
                )
            with _naming("[items]"):
                strings = items.draw(words)
        design = design.strings_of(strings)
    assert not isinstance(design, ItemList)
    if tables.pictures and practice.trials and not practice.items(design) and not practice.file:
        # A picture is learnt before it is asked for; nothing of it is given away.
        practice = msgspec.structs.replace(practice, strings=tuple(dict.fromkeys(design.items())))
    if practice.file is not None:
        practised = read_items(files[practice.file], practice.file, keys, written=written)
        own = tuple(row.masks for row in practised)
        practice = msgspec.structs.replace(practice, file=None, strings=own)
    check_factors(tables.factors, tables.cross, listed=bool(tables.listed))
    fields = msgspec.structs.asdict(tables) | {"design": design, "practice": practice}
    protocol = Protocol(**fields, text=text, files=files, item_rows=rows)
    if tables.order is not None and tables.order.file is not None:
        names = [condition.name for condition in protocol.conditions]
        file = tables.order.file
        orders = read_orders(files[file], file, names, protocol.groups)
        protocol = msgspec.structs.replace(protocol, order_rows=orders)
    return protocol


class _Format(msgspec.Struct):
    """The one key that files of every format have."""

    format: int

    def __post_init__(self) -> None:
        if self.format != FORMAT:
            raise ValueError(
                f"format is {self.format}, and this vbraille knows format {FORMAT}; "
                f"use a vbraille that knows it"
            )


class _Looks(msgspec.Struct):
    """The tables that may name a braille table, whatever they hold: it is not checked yet."""

    display: object = None
    conditions: object = None
    factors: object = None


class _Keyed(msgspec.Struct):
    """The table ``[keys]``, which is read first because strings are spelled with it."""

    keys: SpellingKeys = field(default_factory=SpellingKeys)


def check_protocol(protocol: Protocol, *, planned: bool = False) -> None:
    """Check that the tables of a protocol agree with each other, for each group.

    Parameters
    ----------
    protocol
        The protocol.
    planned
        Whether it belongs to a session, whose plan has been made. The plan then has the cells of
        all texts, and no braille table is asked for them again.

    Raises
    ------
    ValueError
        If values contradict each other.
    """
    check_factors(protocol.factors, protocol.cross, listed=bool(protocol.listed))
    tables = (
        ("conditions", protocol.conditions),
        ("fields", protocol.fields),
        ("questionnaire", protocol.questionnaire),
    )
    for table, named in tables:
        names = [value.name for value in named]
        for number, name in enumerate(names, 1):
            if name in names[: number - 1]:
                raise ValueError(
                    f"[[{table}]] number {number} name is {name!r} again; give each its own"
                )
    for number, item in enumerate(protocol.questionnaire, 1):
        with _naming(f"[[questionnaire]] number {number}"):
            item.check(protocol.item_columns)
    with _naming("[markers]"):
        protocol.marker_codes  # noqa: B018
    _check_names(protocol)
    _check_styles(protocol)
    _check_procedure(protocol)
    _check_conventional(protocol)
    _check_question(protocol)
    with _naming("[practice]"):
        protocol.practice.check(protocol.design, pictures=protocol.pictures)
    _check_trials(protocol)
    if protocol.order is not None:
        with _naming("[order]"):
            protocol.order.check(protocol.design, len(protocol.conditions))
    _check_tables(protocol, planned=planned)
    _check_varies(protocol)
    if protocol.pictures:
        _check_pictures(protocol)
    elif not protocol.written or not (planned or _ungrouped(protocol)):
        check_cells(protocol)
        check_lines(protocol)
    with _naming("[rules]"):
        protocol.rules.check(
            protocol.design, protocol.conditions, protocol.levels_of, adaptive=protocol.adaptive
        )
    with _naming("[analysis]"):
        protocol.planned_analysis  # noqa: B018
    if not protocol.group:
        _check_groups(protocol, planned=planned)


@contextmanager
def _naming(place: str) -> Iterator[None]:
    """Begin the message of a ValueError with a place of the file."""
    try:
        yield
    except ValueError as error:
        raise ValueError(f"{place} {error}") from None


def _check_names(protocol: Protocol) -> None:
    """Check that factors and columns of items can be told apart."""
    taken = {CONDITION, *protocol.item_columns}
    for number, factor in enumerate(protocol.factors, 1):
        if factor.name in taken:
            raise ValueError(
                f"[[factors]] number {number} name is {factor.name!r}, which already stands for "
                f"the conditions or for a column of the items; give another"
            )


def _ungrouped(protocol: Protocol) -> bool:
    """True if the groups of a protocol have tables of their own, and none is chosen."""
    own = any(f.between and f.levels[0].table is not None for f in protocol.factors)
    return own and not protocol.group


def _check_tables(protocol: Protocol, *, planned: bool) -> None:
    """Check that each condition has a braille table or none has, and that there are texts."""
    if not protocol.written:
        return
    design = protocol.design
    if not isinstance(design, StringList):
        kind = "choice" if isinstance(design, Choice) else "combinations"
        raise ValueError(
            f"[design] kind is {kind!r}, which shows cells, and table makes cells of texts; give "
            f"'list' or 'items', or leave table out"
        )
    for wrong, words in (
        (design.reorder, "[design] reorder is of cells"),
        (protocol.keys, "[keys] spell cells"),
        (
            (protocol.rules.each_letter, protocol.rules.each_letter_at_least) != (None, None),
            "[rules] each_letter counts cells",
        ),
    ):
        if wrong:
            raise ValueError(f"{words}, and where table is given strings are texts; leave it out")
    for condition in () if _ungrouped(protocol) else protocol.conditions:
        table, place = protocol.table_of(condition), _place(protocol, condition)
        if table is None:
            raise ValueError(f"{place} has no table, and others have; give it one, or [display]")
        if problem := "" if planned else problem_of(table):
            raise ValueError(f"{place} table: {problem}")


def _check_pictures(protocol: Protocol) -> None:
    """Check that a protocol which shows pictures can show them."""
    design, display = protocol.design, protocol.model.display
    if protocol.written or protocol.keys or protocol.medium == "paper":
        raise ValueError(
            "scene shows pictures on a device, and table, [keys] and medium = 'paper' are of "
            "strings; leave one of the two out"
        )
    if not display.height_mm:
        raise ValueError(
            f"model is {protocol.model_name!r}, whose carriage goes along x only, and scene shows "
            f"pictures; give 'pantograph' or 'stress2-8x8'"
        )
    if not isinstance(design, StringList) or design.reorder or design.catch or protocol.adaptive:
        raise ValueError(
            "scene shows pictures of [design] kind = 'list' or 'items' in a fixed order; leave "
            "reorder, catch and [procedure] out"
        )
    if protocol.asks.asked_of == "cells":
        raise ValueError("scene shows pictures, which have no cells; give [question] kind = 'name'")
    if protocol.trial.exposure_from != "cue":
        raise ValueError("[trial] exposure_from is of dots; leave it out, as for all pictures")
    for condition in protocol.conditions:
        if protocol.display.scene is None and condition.scene is None:
            raise ValueError(f"{_place(protocol, condition)} has no scene, and others have; add it")
        for item in dict.fromkeys((*design.strings, *protocol.practice.strings)):
            stimulus = protocol.shown(condition, item)
            protocol.scene_of(stimulus).check(str(item), display)


def _check_groups(protocol: Protocol, *, planned: bool) -> None:
    """Check the protocol as each group has it."""
    for group in protocol.groups:
        number = 1 + next(n for n, factor in enumerate(protocol.factors) if factor.between)
        with _naming(f"[[factors]] number {number} group {group}:"):
            check_protocol(protocol.assigned(group), planned=planned)


def _place(protocol: Protocol, condition: Condition) -> str:
    """Table that a message about a condition begins with."""
    if condition in protocol.listed:
        return f"[[conditions]] number {protocol.listed.index(condition) + 1}"
    if condition.changes:
        own = next(n for n, factor in enumerate(protocol.factors, 1) if not factor.between)
        return f"[[factors]] number {own} condition {condition.name}:"
    return "[display]"


def _check_styles(protocol: Protocol) -> None:
    with _naming("[display]"):
        protocol.style  # noqa: B018
    for condition in protocol.conditions:
        with _naming(_place(protocol, condition)):
            protocol.style_of(condition)


def _check_varies(protocol: Protocol) -> None:
    """Check that what is compared or chosen can be felt."""
    chosen = getattr(protocol.procedure, "parameter", None)
    for table, name in (("design", protocol.parameter), ("procedure", chosen)):
        if name == "texture_cycles" and protocol.model.style.profile is Profile.HALF_SINE:
            raise ValueError(
                f"[{table}] parameter is {name!r}, and the texture of the {protocol.model.title} "
                f"has a fixed wavelength, so that nothing would vary; choose another"
            )
        if name in UNFELT:
            raise ValueError(
                f"[{table}] parameter is {name!r}, which no actuator shows in a line of its own; "
                f"give another"
            )
        same = {GAP: "dot_spacing_mm", "texture_cycles": "cycles"}
        for condition in protocol.conditions:
            if same.get(name or "", name) in condition.changes:
                raise ValueError(
                    f"[{table}] parameter is {name!r}, which the condition {condition.name} sets "
                    f"itself; leave it out there"
                )


def _check_question(protocol: Protocol) -> None:
    there = any(protocol.place_of(c) == CONVENTIONAL for c in protocol.conditions)
    if protocol.passages and (not protocol.written or there or protocol.medium == "paper"):
        raise ValueError(
            "[design] passage is of texts with a braille table, read line by line on a device; "
            "leave it out, or give [display] table"
        )
    if protocol.passages and (protocol.design.catch is not None or protocol.adaptive):
        raise ValueError("[design] passage goes with neither catch nor [procedure]; leave it out")
    asks = protocol.asks
    asks.check(
        protocol.design,
        passages=protocol.passages,
        pictures=protocol.pictures,
        adaptive=protocol.adaptive,
    )
    asks.check_items(protocol.item_columns, [row.columns for row in protocol.item_rows])
    if getattr(asks, "buttons", False) and protocol.trial.button is not None:
        raise ValueError("[trial] end is a button, and [question] buttons takes all; leave one out")
    if asks.turns and protocol.medium == "paper":
        raise ValueError(
            f"[question] kind is {asks.name!r}, which turns what a device shows; leave it"
        )
    guess = getattr(protocol.procedure, "guess", (0.5,))
    if asks.of_catch and guess in (None, (0.0,)):
        # With a fifth of false alarms the threshold would be told far too low.
        raise ValueError(
            "[procedure] guess is 0, and people say yes at nothing too; give the shares that may "
            "be, such as guess = [0.01, 0.05, 0.1, 0.2, 0.3, 0.4]"
        )
    if protocol.trial.end is not None and protocol.medium == "paper":
        raise ValueError("[trial] end is of a device; on paper Enter ends reading, leave it out")
    if protocol.trial.exposure_s is not None and (there or protocol.medium == "paper"):
        raise ValueError(
            "[trial] exposure_s is of a device, and strings stand on paper or on a conventional "
            "display; leave it out"
        )


def _check_procedure(protocol: Protocol) -> None:
    with _naming("[procedure]"):
        protocol.procedure.check(protocol.design)
    if not protocol.adaptive:
        return
    if protocol.trial.late == "missed":
        raise ValueError(
            "[trial] late is 'missed', which leaves trials without an answer, and [procedure] goes "
            "by the answers; give 'kept'"
        )
    if protocol.medium == "paper":
        raise ValueError(
            "[procedure] varies what a device shows; with medium = 'paper' leave it out"
        )
    if protocol.task == "choice" and protocol.rules.never_twice_running:
        raise ValueError(
            "[rules] never_twice_running is of a fixed order of values; leave it out, since "
            "[procedure] chooses them"
        )


def _check_conventional(protocol: Protocol) -> None:
    """Check that a conventional display can show what stands on it."""
    table = protocol.conventional
    there = [c for c in protocol.conditions if protocol.place_of(c) == CONVENTIONAL]
    if table.reference and not any(table.reference):
        raise ValueError("[conventional] reference has no dots; give it some, or leave it out")
    if table.reference and protocol.medium == "paper":
        raise ValueError(
            "[conventional] reference stands beside a device; leave it out with medium = 'paper'"
        )
    if table.reference and there:
        raise ValueError(
            f"[conventional] reference needs the display on which {there[0].name} shows its "
            f"strings; leave one of the two out"
        )
    for condition in there:
        if own := sorted(condition.changes.keys() - {"on", "table"}):
            raise ValueError(
                f"the condition {condition.name} stands on a conventional display, which has no "
                f"{own[0]}; leave it out there"
            )
    if there and (protocol.task == "choice" or protocol.adaptive):
        what = "[design] compares" if protocol.task == "choice" else "[procedure] varies"
        raise ValueError(
            f"{what} what a conventional display cannot change; leave on = 'brlapi' out"
        )


def _check_trials(protocol: Protocol) -> None:
    design = protocol.design
    if design.catch is not None and protocol.task == "choice":
        raise ValueError("[design] catch is for strings, and values are compared; leave it out")
    if design.catch is not None and protocol.adaptive and design.catch.show == "repeat":
        raise ValueError(
            "[design] catch shows what the trial before it has shown, which [procedure] chooses; "
            "give show = 'blank'"
        )
    trials, blocks = design.trials * len(protocol.conditions), design.blocks
    catch = 0 if design.catch is None else design.catch.number(trials)
    if trials + catch + protocol.practice.trials > MOST_TRIALS:
        raise ValueError(
            f"[design] makes a session of more than {MOST_TRIALS} trials; make it smaller"
        )
    if design.catch is not None and not 1 <= catch <= trials:
        raise ValueError(
            f"[design] catch would be {catch} of {trials + catch} trials; make every smaller, or "
            f"the design larger"
        )
    if blocks != "conditions" and not 1 <= blocks <= trials:
        raise ValueError(
            f"[design] blocks is {blocks}; it must be 1 to {trials}, "
            f"since there are {trials} trials"
        )


def check_cells(protocol: Protocol) -> None:
    """Check that the display can show every dot of every cell used, in every condition.

    Raises
    ------
    ValueError
        If it cannot show a dot, or a braille table cannot make cells of a text.
    """
    model = protocol.model
    for condition in _on_device(protocol):
        mapping = protocol.style_of(condition).mapping
        shown = mapping.shown_dots()
        how = (
            f"'s row {mapping.left[0] + 1}"
            if mapping.rows == 1
            else f" with the mapping {mapping.name}"
        )
        only = f"the {model.title}{how} shows {name_dots(shown)} only"
        for table, (masks, _) in _cells(protocol, condition).items():
            for mask in sorted(masks):
                if mask & ~shown:
                    cell = f"{to_braille((mask,))} ({name_dots(mask)})"
                    raise ValueError(f"{table} has the cell {cell}, and {only}; leave the cell out")
        # Keys may spell what one condition shows and another does not.
        for key, mask in protocol.keys.items() if len(protocol.conditions) == 1 else ():
            if mask & ~shown:
                raise ValueError(
                    f"[keys] {key} is {name_dots(mask)}, and {only}; leave the key out"
                )


def check_lines(protocol: Protocol) -> None:
    """Check that the display has room for the longest line, at each value that is compared.

    Raises
    ------
    ValueError
        If a line is too long, or a value cannot be shown.
    """
    model, design, practice = protocol.model, protocol.design, protocol.practice
    values: tuple[float | None, ...] = (None,)
    unit = ""
    if isinstance(design, Choice):
        values = tuple(dict.fromkeys((*design.values, *protocol.procedure.values(design))))
        values += () if design.reference is None else (design.reference,)
        unit = KNOBS[design.parameter].unit
    compared = (*values, *sorted(set(practice.values)))
    longest = 0
    for condition, value in product(_on_device(protocol), compared):
        lengths = {table: length for table, (_, length) in _cells(protocol, condition).items()}
        whose = max(lengths, key=lambda table: lengths[table])
        longest = max(longest, lengths[whose])
        at = "" if value is None else f" at a value of {value:g}{unit}"
        if condition.changes.keys() & set(LENGTHS):
            at += f" in the condition {condition.name}"
        with _naming(f"[design]{at}:"):
            shown = protocol.shown(condition, (0,), value)
            room = shown.geometry.cells_per_line(model.display.span_mm)
        cells = protocol.lead_cells + lengths[whose]
        if cells > room:
            raise ValueError(
                f"{whose} has a line of {cells} cells{at}, lead_cells among them, and the "
                f"{model.title} has room for {room}; make it shorter, or travel_mm longer"
            )
    _check_varied(protocol, longest)


def _on_device(protocol: Protocol) -> list[Condition]:
    """Conditions whose strings are put under the hand on the device."""
    return [c for c in protocol.conditions if protocol.place_of(c) != CONVENTIONAL]


def _cells(protocol: Protocol, condition: Condition) -> dict[str, tuple[frozenset[int], int]]:
    """Cells that a condition shows, and length of its longest line, by the tables of the file.

    Raises
    ------
    ValueError
        If a braille table cannot make cells of a text.
    """
    design, practice = protocol.design, protocol.practice
    table = protocol.table_of(condition)
    if table is None or not isinstance(design, StringList):
        practised = practice.lines(design)
        masks = frozenset(mask for line in practised for mask in line)
        length = max(map(len, practised), default=0)
        return {"[design]": (design.masks, design.cells), "[practice]": (masks, length)}
    found = {}
    for name, strings in (("[design]", design.strings), ("[practice]", practice.strings)):
        with _naming(f"{name} in the condition {condition.name}:"):
            lines = [cells_of(str(text), table) for text in strings]
        masks = frozenset(mask for line in lines for mask in line)
        longest = max(map(len, lines), default=0)
        found[name] = (masks, min(longest, 1) if design.passage else longest)
    return found


def _check_varied(protocol: Protocol, longest: int) -> None:
    """Check that strings can be shown at both ends of what a procedure varies."""
    knob = getattr(protocol.procedure, "parameter", None)
    if knob is None or protocol.task == "choice":
        return
    for condition, value in product(
        protocol.conditions, protocol.procedure.values(protocol.design)
    ):
        with _naming(f"[procedure] parameter at {value:g}:"):
            shown = with_value(protocol.shown(condition, (0,)), knob, value)
        room = shown.geometry.cells_per_line(protocol.model.display.span_mm)
        if protocol.lead_cells + longest > room:
            raise ValueError(
                f"[procedure] parameter at {value:g} leaves room for {room} cells, and there are "
                f"{protocol.lead_cells + longest}; make it less, or travel_mm longer"
            )
