"""Findings, in sentences made of the tables' rows, for the head of a report."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.analysis.input.trials import UNREAD, times
from vbraille.analysis.results import NOTE, Kind, to_print
from vbraille.analysis.statistics.intervals import FEWEST_PARTICIPANTS, SEEN
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from vbraille.analysis.results import ResultTable, Row

SURE = 0.05  # p below which two things are called different
_TOLD = ("legibility of strings", "duration (s)", "score")  # measures told; the tables have all
_MOST = 6  # sentences about pairs of levels, or conditions in one sentence; the tables have all
_NO_INTERVAL = "no interval"
# Tables with a row or more of each participant.
_OWN = (
    "legibility", "level_scores", "choices_participants", "sensitivity", "thresholds",
)  # fmt: skip


def findings(tables: Iterable[ResultTable]) -> tuple[str, ...]:
    """Sentences about the tables, in the order of the report.

    Of fewer than `FEWEST_PARTICIPANTS` no test and no mean of people is told as a finding: the
    sentences describe who was there, and the first of them says so.

    Parameters
    ----------
    tables
        All tables of the report.
    """
    of = {table.name: table for table in tables if len(table)}
    found = [
        *_averages(of),
        *_thresholds(of),
        *_effects(of),
        *_differences(of),
        *_characters(of),
        *_confusions(of),
        *_information(of),
        *_over_time(of),
        *_preferred(of),
    ]
    people = _people(of)
    if found and 0 < len(people) < FEWEST_PARTICIPANTS:
        found.insert(
            0,
            f"What follows describes {_and(people)} alone: of fewer than {FEWEST_PARTICIPANTS} "
            f"participants nothing is known of how people differ, and no finding is about others.",
        )
    return tuple(found)


def _people(of: Mapping[str, ResultTable]) -> list[str]:
    """Pseudonyms of all participants, in the order of the tables."""
    rows = [row for table in of.values() if table.name in _OWN for row in table.records()]
    return list(dict.fromkeys(str(row["participant"]) for row in rows))


def interval_words(
    row: Row, kind: Kind, unit: str = "", ends: Sequence[str] = ("low", "high")
) -> str:
    """Words for a row's 95 % interval; if it has none, the reason that its note gives."""
    low, high = (row.get(end) for end in ends)
    if low is None or high is None:
        # A note may be about the interval of something else too: "no interval of d_z: …".
        own = tuple(ends) == ("low", "high")
        reasons = [
            part
            for part in _parts(row)
            if part.startswith(_NO_INTERVAL) and part.startswith(f"{_NO_INTERVAL} of ") != own
        ]
        return reasons[0] if reasons else f"{_NO_INTERVAL} is known"
    return f"95 % interval {to_print(low, kind)} to {to_print(high, kind)}{unit}"


def _averages(of: Mapping[str, ResultTable]) -> Iterator[str]:
    if "averages" not in of:
        return
    rows = [row for row in of["averages"].records() if row["legibility"] is not None]
    many = max(row["participants"] for row in rows) >= FEWEST_PARTICIPANTS
    told = []
    for row in rows[:_MOST]:
        which = interval_words(row, Kind.PERCENT, " %")
        people = f" ({count(row['participants'], 'participant')}, {which})" if many else ""
        share = to_print(row["legibility"], Kind.PERCENT)
        told.append(f"{share} % of strings in {row['condition']}{people}")
    more = f"; {len(rows) - _MOST} more conditions are in the table" if len(rows) > _MOST else ""
    who = _people(of)
    whose = "On average participants" if many else _and(who)
    mean = ", on average," if not many and len(who) > 1 else ""
    yield f"{whose} read right{mean} {_and(told, ';')}{more}."
    single = [row for row in of["legibility"].records() if row["trials"]]
    if len(single) > 1:
        yield extremes(single)
    timed = [row for row in rows if row["duration_mean_s"] is not None]
    if timed:
        told = [
            f"{to_print(row['duration_mean_s'], Kind.TENTHS)} s in {row['condition']}"
            for row in timed[:_MOST]
        ]
        yield f"On average a string took {_and(told)}."


def _thresholds(of: Mapping[str, ResultTable]) -> Iterator[str]:
    rows = of["thresholds"].records() if "thresholds" in of else []
    for row in [row for row in rows if row["threshold"] is not None][:_MOST]:
        name, unit = parameter_words(row["level"])
        what = "a difference of " if row["question"] == "which" else ""
        yield (
            f"{row['participant']} felt {what}{name} from "
            f"{to_print(row['threshold'], Kind.NUMBER)}{unit} on in half of the trials, without "
            f"guesses and lapses ({interval_words(row, Kind.NUMBER, unit)})."
        )


def _differences(of: Mapping[str, ResultTable]) -> Iterator[str]:
    for measure, rows in _by_measure(of, "t_tests"):
        tested = [row for row in rows if row["p"] is not None and _enough(row)]
        differ = [row for row in tested if row["p_corrected"] < SURE]
        for row in tested if len(tested) <= _MOST else differ[:_MOST]:
            yield _difference(measure, row)
        if len(tested) > _MOST:
            yield (
                f"Of {len(tested)} pairs of levels {len(differ)} differ in {measure} with p below "
                f"{SURE:g}, corrected for their number if it is."
            )


def _difference(measure: str, row: Row) -> str:
    differ = row["p_corrected"] < SURE
    first, second = row["first"], row["second"]
    share = measure.startswith("legibility")
    kind, unit = (Kind.PERCENT, " percentage points") if share else (Kind.NUMBER, _unit(measure))
    corrected = "" if row["p_corrected"] == row["p"] else f", corrected {_p(row['p_corrected'])}"
    effect = (
        ""
        if row["d_low"] is None
        else f", {to_print(row['d_low'], Kind.NUMBER)} to {to_print(row['d_high'], Kind.NUMBER)}"
    )
    numbers = (
        f"{interval_words(row, kind)}; t({row['df']}) = {to_print(row['t'], Kind.NUMBER)}, "
        f"{_p(row['p'])}{corrected}; d_z {to_print(row['d_z'], Kind.NUMBER)}{effect}"
    )
    size = to_print(abs(row["mean_difference"]), kind)
    name = _plain(measure)
    if differ:
        way = "higher" if row["mean_difference"] > 0 else "lower"
        return f"{name} was {size}{unit} {way} in {first} than in {second} ({numbers})."
    difference = to_print(row["mean_difference"], kind)
    return (
        f"That {name[0].lower()}{name[1:]} differs between {first} and {second} is not shown: "
        f"the difference is {difference}{unit} ({numbers})."
    )


def _effects(of: Mapping[str, ResultTable]) -> Iterator[str]:
    for measure, rows in _by_measure(of, "anova"):
        for row in rows:
            if row["f"] is None or not _enough(row):
                continue
            sure = row["p_corrected"] < SURE
            said = "changed with" if sure else "is not shown to change with"
            corrected = (
                ""
                if row["epsilon"] == 1
                else f", by Greenhouse and Geisser {_p(row['p_corrected'])}"
            )
            numbers = (
                f"F({row['df1']}, {row['df2']}) = {to_print(row['f'], Kind.NUMBER)}, "
                f"{_p(row['p'])}{corrected}; partial eta² "
                f"{to_print(row['partial_eta2'], Kind.NUMBER)}, "
                f"{interval_words(row, Kind.NUMBER, ends=('partial_low', 'partial_high'))}"
            )
            yield f"{_plain(measure)} {said} {row['effect']} ({numbers})."


def _characters(of: Mapping[str, ResultTable]) -> Iterator[str]:
    if "characters" not in of or len(of["characters"]) < 2:
        return
    rows = of["characters"].records()
    shares = [row["legibility"] for row in rows]
    ends = []
    for end in (max, min):
        names = [row["name"] for row in rows if row["legibility"] == end(shares)]
        who = _and(names) if len(names) <= _MOST else f"{len(names)} of them"
        ends.append(f"{who} ({to_print(end(shares), Kind.PERCENT)} %)")
    if min(shares) < max(shares):
        were = "was" if shares.count(max(shares)) == 1 else "were"
        yield f"Of {len(rows)} characters the most legible {were} {ends[0]}, the least {ends[1]}."


def _confusions(of: Mapping[str, ResultTable]) -> Iterator[str]:
    if "errors" in of:
        first = of["errors"].records()[0]
        total = sum(row["count"] for row in of["errors"].records())
        yield (
            f"Of {count(total, 'place')} answered wrongly the most frequent kind is "
            f"“{first['error']}”: {first['count']}, {to_print(first['share'], Kind.PERCENT)} %."
        )
    if "confusion_characters" in of:
        wrong = [each for each in of["confusion_characters"].wrong() if each[2] != UNREAD]
        if wrong:
            most = max(number for number, *_ in wrong)
            alike = [(row, column) for number, row, column in wrong if number == most]
            if len(alike) <= _MOST:
                told = _and([f"{row} was taken for {column}" for row, column in alike])
                yield f"Most often {told}: {times(most)}{' each' if len(alike) > 1 else ''}."


def _information(of: Mapping[str, ResultTable]) -> Iterator[str]:
    rows = of["information"].records() if "information" in of else []
    for row in rows:
        if row["condition"] != "all" or row["of"] != "characters":
            continue
        if row["corrected_bits"] is None:
            reasons = [part for part in _parts(row) if "corrected bits" in part] or _parts(row)
            yield f"How much information answers carried is not known: {reasons[0]}."
        else:
            yield (
                f"In these trials an answer carried {to_print(row['corrected_bits'], Kind.NUMBER)}"
                f" of the {to_print(row['presented_bits'], Kind.NUMBER)} bits of a character "
                f"({interval_words(row, Kind.NUMBER)}, for the people who answered, and no others)."
            )


def _over_time(of: Mapping[str, ResultTable]) -> Iterator[str]:
    rows = of["slopes"].records() if "slopes" in of else []
    known = [row for row in rows if row["p"] is not None]
    if known:
        up, down = (
            sum(row["p"] < SURE and (row["slope"] > 0) == rose for row in known)
            for rose in (True, False)
        )
        yield (
            f"Of {len(known)} series of a participant's trials in a session and "
            f"condition, legibility rose in {up} and fell in {down} with p below {SURE:g}, not "
            f"corrected for their number."
        )


def _preferred(of: Mapping[str, ResultTable]) -> Iterator[str]:
    for row in of["preferred"].records() if "preferred" in of else []:
        words, unit = parameter_words(row["parameter"])
        who = (
            f"{count(row['comparisons'], 'comparison')} of "
            f"{count(row['participants'], 'participant')}"
        )
        if row["preferred"] is None:
            yield f"No {words} is known to be preferred ({who}): {_parts(row)[0]}."
            continue
        more = [part for part in _parts(row) if not part.startswith((_NO_INTERVAL, "no p:"))]
        note = "".join(f"; {part}" for part in more)
        whose = f"The preferred {words} is"
        if not _enough(row):
            whose = f"The {words} that {_and(_people(of)) or 'they'} preferred is"
        yield (
            f"{whose} {to_print(row['preferred'], Kind.NUMBER)}{unit} "
            f"({interval_words(row, Kind.NUMBER, unit)}; {who}){note}."
        )


def _by_measure(of: Mapping[str, ResultTable], name: str) -> Iterator[tuple[str, list[Row]]]:
    rows = of[name].records() if name in of else []
    for measure in _TOLD:
        found = [row for row in rows if row["measure"] == measure]
        if found:
            yield measure, found


def _parts(row: Row) -> list[str]:
    """Clauses of a row's note that say something by themselves; none of an empty one."""
    return [part for part in str(row.get(NOTE, "")).split("; ") if part not in ("", SEEN)]


def _enough(row: Row) -> bool:
    """Tell if a row is of so many people that it can be a finding about others."""
    return row["participants"] >= FEWEST_PARTICIPANTS


def parameter_words(name: str) -> tuple[str, str]:
    """Words for a parameter or a level, and its unit after a space."""
    return name.removesuffix("_mm").replace("_", " "), " mm" if name.endswith("_mm") else ""


def extremes(rows: Sequence[Row]) -> str:
    """Sentence on the least and the most legible of participants and conditions."""
    told = [
        f"{to_print(row['legibility'], Kind.PERCENT)} % by {row['participant']} in "
        f"{row['condition']}"
        for row in (end(rows, key=lambda row: row["legibility"]) for end in (min, max))
    ]
    return f"The least was {told[0]}, the most {told[1]}."


def _plain(measure: str) -> str:
    """Name of a measure without its unit, to begin a sentence with."""
    name = measure.removesuffix(" (s)")
    return name[:1].upper() + name[1:]


def _unit(measure: str) -> str:
    return " s" if measure.endswith("(s)") else ""


def _p(p: float) -> str:
    text = to_print(p, Kind.P)
    return f"p {text}" if text.startswith("<") else f"p = {text}"


def _and(parts: Sequence[str], comma: str = ",") -> str:
    """List in words: "a, b and c"."""
    if len(parts) < 2:
        return "".join(parts)
    return f"{f'{comma} '.join(parts[:-1])}{comma * (comma != ',')} and {parts[-1]}"
