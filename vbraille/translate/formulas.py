"""Formulas of MathML and of Word (OMML) as TeX, by which readers know them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from vbraille.translate.trees import names

if TYPE_CHECKING:
    from vbraille.translate.trees import Element

_FUNCTION = re.compile(
    "(arc|)(sin|cos|tan)|(sin|cos|tan)h|cot|sec|csc|log|ln|lg|exp|lim|max|min|sup|inf|det|dim|ker"
    "|gcd|mod|arg"
)
_ASIDE = re.compile("annotation|.*pr$")
_INVISIBLE = dict.fromkeys(map(ord, "\u2061\u2062\u2063\u2064\u200b"))
_NAMES = names("formulas")
_SIGNS, _ACCENTS, _FORMS = _NAMES["signs"], _NAMES["accents"], _NAMES["forms"]


def formula_text(math: Element) -> str:
    """Text of a formula: what its author says of it, its TeX, or TeX of its signs."""
    told = math.get("alttext").strip() or math.get("aria-label").strip()
    for annotation in math.iter("annotation"):
        if not told and "tex" in annotation.get("encoding").lower():
            told = annotation.text
    return " ".join((told or _tex(math)).split())


def _tex(element: Element) -> str:
    name = element.name
    if name in _NAMES["letters"]:
        text = element.text.translate(_INVISIBLE).strip()
        return f"\\{text}" if _FUNCTION.fullmatch(text) else _SIGNS.get(text, text)
    if name == "t":
        return element.text
    parts = [each for each in element.elements if not _ASIDE.match(each.name)]
    properties = (each for each in element.elements if each.name.endswith("pr"))
    said = {each.name: each.get("val") for holder in properties for each in holder.elements}
    texts = [_tex(part) for part in parts]
    if name in ("mtable", "m"):
        rows = " \\\\ ".join(" & ".join(map(_tex, row.elements)) for row in parts)
        return f"\\begin{{matrix}} {rows} \\end{{matrix}}"
    if name == "eqarr":
        return " \\\\ ".join(texts)
    if name in ("mfenced", "d"):
        between = said.get("sepchr", "|") if name == "d" else element.get("separators", ",")[:1]
        opening = said.get("begchr", element.get("open", "("))
        return opening + between.join(texts) + said.get("endchr", element.get("close", ")"))
    accent = texts[1] if name == "mover" and len(texts) > 1 else said.get("chr", "\u0302")
    if name in ("mover", "acc") and accent in _ACCENTS:
        return f"{_ACCENTS[accent]}{{{''.join(texts[:1])}}}"
    if name == "acc":
        return "".join(texts) + accent
    if name == "nary":
        sign = said.get("chr", "∫")
        texts.insert(0, _SIGNS.get(sign, sign))
    if name in _FORMS:
        text = _FORMS[name].format(*texts, "", "", "")
        return text.replace("_{}", "").replace("^{}", "").replace("\\sqrt[]", "\\sqrt")
    row = ""
    for part, text in zip(parts, texts, strict=True):
        if part.name == "mi" and text.startswith("\\"):
            row += f"{' ' if row[-1:].isalnum() else ''}{text} "
        else:
            row += text
    row = row.removesuffix(" ") if not row.endswith("\\ ") else row
    return f"\\sqrt{{{row}}}" if name == "msqrt" else row
