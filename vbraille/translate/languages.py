"""Braille tables of languages: those that their readers use today.

liblouis's own order of preference does not know that: asked for French it gives eight-dot computer
braille. The rule here is six dots before eight, literary braille before computer braille, the
standard in force before a dated one, uncontracted before contracted. What is customary otherwise is
listed in `USUAL`. `docs/languages.md` has the outcome for every language.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.translate.liblouis import BrailleTable, list_tables
from vbraille.wording import nearest, setting

if TYPE_CHECKING:
    from vbraille.translate.liblouis import TableInfo
    from vbraille.translate.scripts import Script


@dataclass(frozen=True, slots=True)
class Usual:
    """Tables of a language that its readers expect.

    Parameters
    ----------
    uncontracted, contracted
        Names of tables; empty where there is no table, or the general rule finds it.
    customary
        Whether books in the language are contracted as a rule.
    """

    uncontracted: str = ""
    contracted: str = ""
    customary: bool = False


# Languages with contracted tables here: books of general interest are contracted in English and
# German, Danish (the standard of 2022) and Korean. French, Spanish, Portuguese, Hungarian, Arabic
# and Turkish books are not as a rule; contractions are for those who ask for them. For Chinese it
# is the common scheme of 2018.
USUAL = {
    "ar": Usual("ar.tbl", "ar-ar-g2.ctb"),
    "cmn": Usual("zhcn-cbs.ctb"),
    "cmn-hans": Usual("zhcn-cbs.ctb"),
    "cmn-hant": Usual("zh-tw.ctb"),
    "da": Usual("da-dk-g16.ctb", "da-dk-g26.ctb", customary=True),
    "de": Usual("de-g1.ctb", "de-g2.ctb", customary=True),
    "en": Usual("en-ueb-g1.ctb", "en-ueb-g2.ctb", customary=True),
    "es": Usual("es.tbl", "es-g2.ctb"),
    "fr": Usual("fr-bfu-comp6.utb", "fr-bfu-g2.ctb"),
    "hu": Usual("hu.tbl", "hu-hu-g2.ctb"),
    "ko": Usual("ko-g1.ctb", "ko-g2.ctb", customary=True),
    "mn": Usual("mn-MN-g1.utb", "mn-MN-g2.ctb"),  # six dots, whatever their metadata say
    "no": Usual("no-no-g0.utb", "no-no-g2.ctb"),
    "pt": Usual("pt-pt-g1.utb", "pt.tbl"),
    "ru": Usual("ru-litbrl.ctb", "ru-ru-g1.ctb"),
    "sv": Usual("sv-g0.utb", "sv-g2.ctb"),
    "tr": Usual("tr-g1.ctb", "tr-g2.ctb"),  # the first has no metadata
    "vi": Usual("vi-vn-g0.utb", "vi-vn-g2.ctb"),
}
# Tags that people write, and the tags that liblouis has instead.
_SAME = {
    "iw": "he",
    "ku": "kmr",
    "nb": "no",
    "nn": "no",
    "prs": "fa",
    "zh": "cmn",
    "zh-cn": "cmn-hans",
    "zh-hans": "cmn-hans",
    "zh-hant": "cmn-hant",
    "zh-hk": "yue",
    "zh-mo": "yue",
    "zh-sg": "cmn-hans",
    "zh-tw": "cmn-hant",
}
# Three letters that older books have (ISO 639-2) for two.
_SAME |= {
    three: two
    for two, codes in {
        "ar": "ara",
        "cs": "cze ces",
        "da": "dan",
        "de": "ger deu",
        "el": "gre ell",
        "en": "eng",
        "es": "spa",
        "fi": "fin",
        "fr": "fre fra",
        "he": "heb",
        "hu": "hun",
        "it": "ita",
        "nl": "dut nld",
        "no": "nor nob nno",
        "pl": "pol",
        "pt": "por",
        "ru": "rus",
        "sv": "swe",
        "tr": "tur",
        "cmn": "chi zho",
    }.items()
    for three in codes.split()
}
# Tables of a standard that is no longer in force, or with signs that books leave out.
_DATED = re.compile(r"_\d{4}\b|-\d{4}[-.]|-detailed\b")


def tables_of(language: str) -> tuple[str, tuple[TableInfo, ...]]:
    """Tag that liblouis has for a language, in lower case, and the tables that it lists for it.

    Parameters
    ----------
    language
        BCP 47 tag, with hyphens or underscores; for "fr-CA" the tables for French are taken,
        unless there are some for Canada.

    Raises
    ------
    InputError
        If there are no tables; the message names the nearest languages.
    """
    wanted = language.strip().lower().replace("_", "-")
    if not wanted:
        raise InputError(
            f"the language is empty; give a tag such as fr, or leave {setting('language')} out"
        )
    tag = wanted
    while tag:
        tag = _SAME.get(tag, tag)
        found = tuple(table for table in list_tables() if table.speaks(tag))
        if found or tag in USUAL:
            return tag, found
        tag = tag.rpartition("-")[0]
    tags = sorted({table.language for table in list_tables() if table.language})
    raise InputError(
        f"there is no table for language {language!r}{nearest(wanted, tags, 3)} "
        f"(vbraille tables lists all)"
    )


def has_tables(language: str) -> bool:
    """Tell whether there is a table for a language, whatever its grade."""
    try:
        tables_of(language)
    except InputError:
        return False
    return True


def find_table(language: str = "en", grade: int | None = None) -> str:
    """Name of the table for a language and grade.

    Parameters
    ----------
    language
        BCP 47 tag; a region may follow ("en-GB").
    grade
        0 or 1 for uncontracted, 2 and up for contracted braille; None for what is usual in the
        language. Where a language numbers its grades otherwise, as German does, its numbers count.

    Raises
    ------
    InputError
        If there is no such table; the message names the nearest.
    """
    tag, tables = tables_of(language)
    usual = USUAL.get(tag, Usual())
    if grade is None:
        chosen = usual.contracted if usual.customary else usual.uncontracted
    else:
        chosen = _graded(usual, tables, grade)
    if chosen:
        return chosen
    fitting = [table for table in tables if grade is None or not _is_contracted(table)]
    if not fitting or (grade is not None and grade > 1):
        there = ", ".join(_grades(usual, tables))
        raise InputError(
            f"there is no grade {grade} for language {language!r}; there is {there} "
            f"(vbraille tables {setting('language')} {language})"
        )
    return min(fitting, key=_preference).name


def six_dot_table(language: str) -> str | None:
    """Name of the most usual six-dot table of a language; None if there is none."""
    try:
        _, tables = tables_of(language)
    except InputError:
        return None
    names = [find_table(language), *(table.name for table in sorted(tables, key=_preference))]
    return next((name for name in names if not BrailleTable(name).eight_dots), None)


def table_note(table: BrailleTable) -> str | None:
    """Note on what a table cannot translate that is due: endless texts, a script; each once."""
    if table.take_endless():
        return (
            f"liblouis does not come to an end with this passage by the table {table.name}; such "
            f"passages are translated word by word, and words of that kind marked {table.marker}"
        )
    script = table.take_foreign()
    if script is None:
        return None
    return (
        f"most of this passage is in {script.name}, which the table {table.name} does not "
        f"know; {tables_for(script)}"
    )


def tables_for(script: Script) -> str:
    """End of a sentence that says which languages and tables there are for a script."""
    there = {table.language for table in list_tables()}
    found = [
        f"{tag} ({name}, {find_table(tag)})"
        for tag, name in script.languages.items()
        if tag in there
    ]
    if not found:
        return f"liblouis has no table for {script.name}"
    return f"give its language: {setting('language')} {', '.join(found)}"


def _graded(usual: Usual, tables: tuple[TableInfo, ...], grade: int) -> str:
    """Name of the table of a grade; empty if no table has that grade."""
    if grade == 1 and usual.uncontracted:
        return usual.uncontracted
    if grade == 2 and usual.contracted:
        return usual.contracted
    named = [table for table in tables if table.grade == str(grade) and table.kind != "computer"]
    if named:
        return min(named, key=_preference).name
    return usual.uncontracted if grade == 0 else ""


def _grades(usual: Usual, tables: tuple[TableInfo, ...]) -> list[str]:
    """Grades that a language has, as `find_table` takes them."""
    listed = {table.grade for table in tables if table.grade.isdecimal()}
    if usual.uncontracted or not all(map(_is_contracted, tables)):
        listed.add("1")
    return sorted(listed | ({"2"} if usual.contracted else set()))


def _is_contracted(table: TableInfo) -> bool:
    return table.grade not in ("", "0", "1")


def _preference(table: TableInfo) -> tuple[bool, bool, bool, bool, int, str]:
    dated = _DATED.search(table.name) is not None
    computer, contracted = table.kind == "computer", _is_contracted(table)
    return computer, table.dots == 8, dated, contracted, len(table.language), table.name
