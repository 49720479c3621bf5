"""Tables of a protocol's TOML → values that check themselves."""

from __future__ import annotations

from dataclasses import replace
from itertools import permutations
from typing import TYPE_CHECKING

from vbraille.braille.geometry import BOUNDS_MM
from vbraille.braille.spelling import UNREAD, spell, spell_string
from vbraille.render import MAPPINGS, Mapping, Model, Profile, single_row
from vbraille.sessions.planning.conduct import Question, SessionPace, SignalSound, Tone, TrialPace
from vbraille.sessions.planning.design import (
    PARAMETERS,
    Choice,
    Combinations,
    Condition,
    Design,
    Rules,
    StringList,
)
from vbraille.sessions.planning.practice import Item, Practice
from vbraille.sessions.planning.section import quote

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.braille.geometry import Geometry
    from vbraille.render import Tuning
    from vbraille.sessions.planning.section import Section

    _Spelled = Callable[[str, dict[str, int]], tuple[int, ...]]

ORDERS = ("balanced", "listed", "shuffled")
PER_CONDITION = "conditions"
ONLY_CONDITION = "all"

# Keys of the file, and what `Tuning` calls them.
_TUNING = {"texture": "texture", "contrast": "contrast", "texture_cycles": "cycles"}
_COUNTS = ("each_letter", "each_letter_at_least")
_KINDS = {
    "combinations": ("characters", "length", "before", "after"),
    "list": ("strings", "reorder"),
    "choice": ("parameter", "values", "string"),
}


# One cell: at the left stop the array's right column then stands well before the first dot.
LEAD_CELLS = 1


def read_display(root: Section, model: Model) -> tuple[Mapping, Geometry, int, Tuning]:
    """What ``[display]`` has, and for what it leaves out the model's own."""
    known = (*_TUNING, "dot_row", "mapping", "lead_cells", *BOUNDS_MM)
    display = root.table("display", known)
    mapping = model.style.mapping
    if "dot_row" in display:
        if model.style.mapping.rows > 1:
            display.fail(f"dot_row is of the VBD; the {model.title} shows all, leave dot_row out")
        with display.checking():
            mapping = single_row(display.whole("dot_row"))
    if "mapping" in display:
        if model.style.mapping.rows == 1:
            display.fail(f"mapping is of the STReSS²; for the {model.title} give dot_row")
        mapping = MAPPINGS[display.one_of("mapping", MAPPINGS)]
    lengths = {name: display.number(name) for name in BOUNDS_MM if name in display}
    with display.checking():
        geometry = replace(model.style.geometry, **lengths)
        lead_cells = display.whole("lead_cells", LEAD_CELLS)
        return mapping, geometry, lead_cells, _tuning(display, model, model.style.tuning)


def read_keys(root: Section) -> dict[str, int]:
    """Dot mask of each key in ``[keys]``."""
    table = root.table("keys", None)
    keys = {}
    for key in table:
        if len(key) != 1 or not key.isprintable() or key in f"{UNREAD} -0123456789":
            table.fail(
                f"has the key {quote(key)}; a key must be one character, "
                f"and no digit, hyphen, question mark or white space"
            )
        with table.checking(f"{key}: "):
            masks = spell(table.text(key), {})
        if len(masks) != 1:
            table.fail(f"{key} is {len(masks)} cells; it must be the dot numbers of one, such as 4")
        keys[key] = masks[0]
    return keys


def read_design(
    root: Section, keys: dict[str, int], *, planned: bool
) -> tuple[Design, int | None, str]:
    """What ``[design]`` has: the design, its blocks (None: one a condition) and their order.

    With `planned`, strings are spelled as version 0.1 took them.
    """
    every = {key for own in _KINDS.values() for key in own}
    # First of all: another kind may have other keys.
    kind = root.table("design", None).one_of("kind", _KINDS)
    design = root.table("design", ("kind", "repeats", "blocks", "order", *sorted(every)))
    for key in sorted(every - set(_KINDS[kind])):
        if key in design:
            others = " or ".join(repr(other) for other in _KINDS if key in _KINDS[other])
            design.fail(f"{key} is of kind = {others}; leave it out of kind = {kind!r}")
    with design.checking():
        return (_READERS[kind](design, keys, spell if planned else spell_string), *_blocks(design))


def read_conditions(root: Section, model: Model, tuning: Tuning) -> tuple[Condition, ...]:
    """All ``[[conditions]]``, or the only one that there is without them."""
    conditions = []
    for table in root.tables("conditions", ("name", *_TUNING)):
        own = frozenset(value for key, value in _TUNING.items() if key in table)
        with table.checking():
            tuned = _tuning(table, model, tuning)
            conditions.append(Condition(table.text("name"), tuned, own))
    return tuple(conditions) or (Condition(ONLY_CONDITION, tuning),)


def read_rules(root: Section) -> Rules:
    """What ``[rules]`` has."""
    table = root.table("rules", (*_COUNTS, "never_twice_running"))
    with table.checking():
        return Rules(
            **{name: table.maybe_whole(name) for name in _COUNTS},
            never_twice_running=table.flag("never_twice_running", False),
        )


def read_practice(
    root: Section, keys: dict[str, int], design: Design, *, planned: bool
) -> Practice:
    """What ``[practice]`` has; with `planned` it may lack items, as in version 0.1."""
    given = "values" if isinstance(design, Choice) else "strings"
    table = root.table("practice", ("trials", given))
    items: tuple[Item, ...] = ()
    if given in table and isinstance(design, Choice):
        items = tuple(permutations(table.numbers(given), 2))
    elif given in table:
        with table.checking(f"{given}: "):
            items = tuple(spell_string(text, keys) for text in table.texts(given))
    with table.checking():
        practice = Practice(table.whole("trials", 0), items)
    if problem := practice.problem(design):
        table.fail(problem)
    if practice.trials and not items and not planned:
        table.fail(
            f"has no items of its own, and those of the test would be given away; "
            f"give {given} that the test does not have, or trials = 0"
        )
    return practice


def read_paces(root: Section) -> tuple[TrialPace, SessionPace]:
    """What ``[trial]`` and ``[session]`` have."""
    trial = root.table("trial", ("gap_s", "warning_s"))
    with trial.checking():
        trial_pace = TrialPace(
            trial.number("gap_s", TrialPace().gap_s), trial.maybe_number("warning_s")
        )
    session = root.table("session", ("limit_s", "break_every"))
    with session.checking():
        return trial_pace, SessionPace(
            session.maybe_number("limit_s"), session.maybe_whole("break_every")
        )


def read_sound(root: Section) -> SignalSound:
    """What ``[sound]`` has."""
    table = root.table("sound", ("cue", "warning"))
    tones = {}
    for name in ("cue", "warning"):
        if name in table:
            numbers = table.numbers(name)
            if len(numbers) != 2:
                table.fail(f"{name} has {len(numbers)} numbers; give two, of Hz and of ms")
            with table.checking(f"{name}: "):
                tones[name] = Tone(*numbers)
    return SignalSound(**tones)


def read_fields(root: Section) -> tuple[Question, ...]:
    """All ``[[fields]]``."""
    questions = []
    for table in root.tables("fields", ("name", "ask", "choices")):
        choices = table.texts("choices") if "choices" in table else ()
        with table.checking():
            questions.append(Question(table.text("name"), table.text("ask"), choices))
    return tuple(questions)


def _tuning(table: Section, model: Model, tuning: Tuning) -> Tuning:
    if "texture_cycles" in table and model.style.profile is Profile.HALF_SINE:
        table.fail(
            f"texture_cycles is of the STReSS²; the texture of the {model.title} has a fixed "
            f"wavelength, leave it out"
        )
    numbers = {key: table.number(key) for key in ("texture", "contrast") if key in table}
    if "texture_cycles" in table:
        return replace(tuning, **numbers, cycles=table.whole("texture_cycles"))
    return replace(tuning, **numbers)


def _blocks(design: Section) -> tuple[int | None, str]:
    if "blocks" not in design or design.is_text("blocks"):
        design.one_of("blocks", (PER_CONDITION,), PER_CONDITION)
        return None, design.one_of("order", ORDERS, ORDERS[0])
    if "order" in design:
        design.fail(
            "order is of a block each condition; leave it out, or give blocks = 'conditions'"
        )
    return design.whole("blocks"), "shuffled"


def _combinations(design: Section, keys: dict[str, int], spelled: _Spelled) -> Combinations:
    characters = []
    for text in design.texts("characters"):
        masks = spell(text, keys)
        if len(masks) != 1:
            design.fail(f"characters have {quote(text)}, {len(masks)} cells; give one each")
        characters += masks
    around: dict[str, tuple[int, ...]] = {}
    for key in ("before", "after"):
        with design.checking(f"{key}: "):
            around[key] = spelled(design.text(key, ""), keys)
    return Combinations(
        tuple(characters), design.whole("length"), repeats=design.whole("repeats", 1), **around
    )


def _string_list(design: Section, keys: dict[str, int], spelled: _Spelled) -> StringList:
    strings = []
    for number, text in enumerate(design.texts("strings"), 1):
        with design.checking(f"strings, number {number}: "):
            strings.append(spelled(text, keys))
    return StringList(tuple(strings), design.flag("reorder", False), design.whole("repeats", 1))


def _choice(design: Section, keys: dict[str, int], spelled: _Spelled) -> Choice:
    parameter, values = design.one_of("parameter", PARAMETERS), design.numbers("values")
    with design.checking("string: "):
        string = spelled(design.text("string"), keys)
    return Choice(parameter, values, string, design.whole("repeats", 1))


_READERS = {"combinations": _combinations, "list": _string_list, "choice": _choice}
