"""Scripts, and the languages that are written in them."""

from __future__ import annotations

import unicodedata
from collections import Counter
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable


@dataclass(frozen=True, slots=True)
class Script:
    """A script.

    Parameters
    ----------
    name
        Name of its letters, such as "Cyrillic letters".
    languages
        Tags and names of languages that are written in it, those with most readers first.
    """

    name: str
    languages: dict[str, str]


# Scripts by the first word of their characters' names in Unicode.
_SCRIPTS = {
    "CYRILLIC": Script(
        "Cyrillic letters",
        {
            "ru": "Russian",
            "uk": "Ukrainian",
            "bg": "Bulgarian",
            "sr": "Serbian",
            "be": "Belarusian",
            "kk": "Kazakh",
            "tt": "Tatar",
            "mn": "Mongolian",
        },
    ),
    "GREEK": Script("Greek letters", {"el": "Greek", "grc": "Ancient Greek"}),
    "LATIN": Script("Latin letters", {"en": "English", "fr": "French", "de": "German"}),
    "HEBREW": Script("Hebrew letters", {"he": "Hebrew"}),
    "ARABIC": Script(
        "Arabic letters", {"ar": "Arabic", "fa": "Persian", "ur": "Urdu", "ckb": "Kurdish"}
    ),
    "DEVANAGARI": Script(
        "Devanagari letters", {"hi": "Hindi", "mr": "Marathi", "ne": "Nepali", "sa": "Sanskrit"}
    ),
    "BENGALI": Script("Bengali letters", {"bn": "Bengali", "as": "Assamese"}),
    "GURMUKHI": Script("Gurmukhi letters", {"pa": "Punjabi"}),
    "GUJARATI": Script("Gujarati letters", {"gu": "Gujarati"}),
    "ORIYA": Script("Odia letters", {"or": "Odia"}),
    "TAMIL": Script("Tamil letters", {"ta": "Tamil"}),
    "TELUGU": Script("Telugu letters", {"te": "Telugu"}),
    "KANNADA": Script("Kannada letters", {"kn": "Kannada"}),
    "MALAYALAM": Script("Malayalam letters", {"ml": "Malayalam"}),
    "SINHALA": Script("Sinhala letters", {"si": "Sinhala"}),
    "THAI": Script("Thai letters", {"th": "Thai"}),
    "TIBETAN": Script("Tibetan letters", {"bo": "Tibetan"}),
    "MYANMAR": Script("Burmese letters", {"my": "Burmese"}),
    "KHMER": Script("Khmer letters", {"km": "Khmer"}),
    "GEORGIAN": Script("Georgian letters", {"ka": "Georgian"}),
    "ARMENIAN": Script("Armenian letters", {"hy": "Armenian"}),
    "ETHIOPIC": Script("Ethiopic letters", {"am": "Amharic", "gez": "Ge'ez"}),
    "CHEROKEE": Script("Cherokee letters", {"chr": "Cherokee"}),
    "COPTIC": Script("Coptic letters", {"cop": "Coptic"}),
    "CANADIAN": Script("syllabics", {"iu": "Inuktitut"}),
    "HANGUL": Script("Hangul", {"ko": "Korean"}),
    "HIRAGANA": Script("Japanese characters", {"ja": "Japanese"}),
    "CJK": Script("Chinese characters", {"cmn": "Chinese", "yue": "Cantonese", "ja": "Japanese"}),
}
_SCRIPTS["KATAKANA"] = _SCRIPTS["HIRAGANA"]


def script_of(letters: Iterable[str]) -> Script | None:
    """Script of most of these letters; None if that script is not known here."""
    counts = Counter(unicodedata.name(letter, "").partition(" ")[0] for letter in letters)
    if counts["HIRAGANA"] or counts["KATAKANA"]:  # as many Chinese characters stand beside them
        return _SCRIPTS["HIRAGANA"]
    commonest = counts.most_common(1)
    return _SCRIPTS.get(commonest[0][0]) if commonest else None


@cache
def native_letters() -> str:
    """Letters of the alphabets from Greek to Arabic, for what a table's metadata leave open."""
    return "".join(c for c in map(chr, range(0x370, 0x700)) if c.isalpha())


def all_letters() -> str:
    """Letters of every script in use today but Latin; some letters only of large scripts."""
    codes = (*range(0x370, 0x2000), *range(0x3041, 0x3100), *range(0x4E00, 0xD7A4, 64))
    return "".join(c for c in map(chr, codes) if c.isalpha())
