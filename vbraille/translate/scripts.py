"""Scripts, the languages that are written in them, and the language that a text looks like."""

from __future__ import annotations

import re
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


_WORD = re.compile(r"[^\W\d_]+")
_LEAST_WORDS = 8
_LEAST_SHARE = 0.15  # of all words; texts in a language have 0.25 to 0.5
_AHEAD = 1.3  # times as many as the next language has
_LEAST_KINDS = 3  # of such words

# Names of languages that liblouis has tables for, and words that are frequent in each.
_LANGUAGES = {
    "en": ("English", "the of and to in a is that it was for on with he as you his her not be"),
    "de": (
        "German",
        "der die das und ist nicht ein eine ich zu den von mit sich auf dem es im des",
    ),
    "fr": ("French", "le la les et des un une est dans que qui pas pour sur au elle il ne en du"),
    "es": ("Spanish", "el la los las y que en un una es por con del se no lo su para como más"),
    "it": ("Italian", "il la di che è e un una per non sono del della con si le gli i nel era"),
    "pt": ("Portuguese", "o a os as e que de em um uma não é para com do da se por mais ao"),
    "ca": ("Catalan", "el la els les i que en un una és per amb del no al dels va ser molt però"),
    "ro": ("Romanian", "și în de la un o nu este cu care pe din mai să a fi era pentru ce al"),
    "nl": ("Dutch", "de het een en van is dat niet in op te zijn met voor hij ik er maar aan was"),
    "af": ("Afrikaans", "die en van is nie in het wat dat hy sy met vir op ek was om ons se n"),
    "da": ("Danish", "og i det at en den til er som på de med han af for ikke der var blev jeg"),
    "no": ("Norwegian", "og i det å en den til er som på de med han av for ikke var ble jeg fra"),
    "sv": ("Swedish", "och i det att en ett den som på är av för med inte han var jag om till"),
    "is": ("Icelandic", "og í að það á er sem ekki en við hann var ég til um með þá eins fyrir"),
    "fi": ("Finnish", "ja on ei se että hän oli mutta kun ovat joka niin ole tai myös olla kuin"),
    "et": ("Estonian", "ja on ei see et ta oli kui aga ka ning mis oma siis nii mida ma või"),
    "lv": ("Latvian", "un ir ka no ar par uz kas bija viņš bet tas kā lai pie es vai nav"),
    "lt": ("Lithuanian", "ir kad yra į iš su tai bet kaip jis buvo ne apie per jo aš kuris"),
    "pl": ("Polish", "i w nie na z się że do to jest jak o co za był po ale od tego przez"),
    "cs": ("Czech", "a v se na je že to z s do i o jsem ale jako který by jeho jsou byl"),
    "sk": ("Slovak", "a v sa na je že to z s do aj o som ale ako ktorý by jeho sú bol"),
    "sl": ("Slovenian", "in je v na se da za so ki pa z ne ni bil kot tudi sem po še kar"),
    "hr": ("Croatian", "i je u na se da za su što od nije sam kao bio ali koji ne to po bi"),
    "hu": ("Hungarian", "a az és hogy nem is egy ez volt de meg csak ha már mint el azt még"),
    "tr": ("Turkish", "ve bir bu da de için ile o ne gibi çok daha olarak var ama olan kadar"),
    "cy": ("Welsh", "y yr yn a i o ac ar mae wedi bod ei oedd am ond nid gan fel hi roedd"),
    "ga": ("Irish", "an na agus ar a i le do go is sé bhí nach mé ag ach sin tá níl siad"),
    "eo": ("Esperanto", "la de kaj en estas mi al ne ke por li kun oni sed kiu pli tiu sur"),
    "vi": ("Vietnamese", "và của là có không được cho một người trong với những các đã này"),
}
_WORDS = {tag: frozenset(words.split()) for tag, (_, words) in _LANGUAGES.items()}


def guess_language(text: str) -> tuple[str, str]:
    """Tag and name of the language that a text looks like; empty where it is not clear.

    A language is told by its most frequent words, Greek by its letters. Other scripts than these
    are told by what a table does not know.
    """
    words = _WORD.findall(text.lower())
    if len(words) < _LEAST_WORDS:
        return "", ""
    script = script_of("".join(words))
    if script is not None and "el" in script.languages:
        return "el", "Greek"
    counts = Counter({tag: sum(word in own for word in words) for tag, own in _WORDS.items()})
    (best, most), (_, next_most) = counts.most_common(2)
    kinds = len(_WORDS[best].intersection(words))
    if most < max(_LEAST_SHARE * len(words), _AHEAD * next_most) or kinds < _LEAST_KINDS:
        return "", ""
    return best, _LANGUAGES[best][0]
