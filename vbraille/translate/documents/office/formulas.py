"""Formulas of Office's own markup (OMML) as TeX."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lxml.etree import _Element as Element

_DEEPEST = 60
_NARY = {"∑": "\\sum", "∫": "\\int", "∏": "\\prod", "": "\\int"}
# What is made of the parts of an element, by the names of these.
_FORMS = {
    "f": "\\frac{{{num}}}{{{den}}}",
    "sSup": "{e}^{{{sup}}}",
    "sSub": "{e}_{{{sub}}}",
    "sSubSup": "{e}_{{{sub}}}^{{{sup}}}",
    "sPre": "{{}}_{{{sub}}}^{{{sup}}}{e}",
    "limLow": "{e}_{{{lim}}}",
    "limUpp": "{e}^{{{lim}}}",
    "func": "{fName} {e}",
    "bar": "\\overline{{{e}}}",
    "groupChr": "\\underbrace{{{e}}}",
}
_PARTS = ("num", "den", "e", "sup", "sub", "lim", "fName", "deg")


def tex_of(element: Element, depth: int = 0) -> str:
    """TeX of a formula or a part of one; what has no form of its own is the text in it."""
    name = _name(element)
    if name == "t" or depth > _DEEPEST:
        return "".join(map(str, element.itertext()))
    inner = [child for child in element if _name(child) and not _name(child).endswith("Pr")]
    if name == "d":
        first, last, between = (
            _sign(element, what, usual)
            for what, usual in (("begChr", "("), ("endChr", ")"), ("sepChr", "|"))
        )
        return f"{first}{between.join(tex_of(child, depth + 1) for child in inner)}{last}"
    if name == "m":
        rows = (" & ".join(tex_of(cell, depth + 1) for cell in row) for row in inner)
        return "\\begin{matrix} " + " \\\\ ".join(rows) + " \\end{matrix}"
    if name == "eqArr":
        return " \\\\ ".join(tex_of(child, depth + 1) for child in inner)
    parts = dict.fromkeys(_PARTS, "")
    if name in _FORMS or name in ("rad", "nary", "acc"):
        parts |= {_name(child): tex_of(child, depth + 1) for child in inner}
    if name == "rad":
        degree = f"[{parts['deg']}]" if parts["deg"] else ""
        return f"\\sqrt{degree}{{{parts['e']}}}"
    if name == "nary":
        sign = _sign(element, "chr", "∫")
        below = f"_{{{parts['sub']}}}" if parts["sub"] else ""
        above = f"^{{{parts['sup']}}}" if parts["sup"] else ""
        return f"{_NARY.get(sign, sign)}{below}{above} {parts['e']}"
    if name == "acc":
        return parts["e"] + _sign(element, "chr", "\u0302")
    if name in _FORMS:
        return _FORMS[name].format(**parts)
    return "".join(tex_of(child, depth + 1) for child in inner)


def _name(element: Element) -> str:
    return element.tag.rpartition("}")[2] if isinstance(element.tag, str) else ""


def _sign(element: Element, what: str, usual: str) -> str:
    """Sign that the properties of an element name, or the usual one."""
    for found in element.iterfind(f"{{*}}{_name(element)}Pr/{{*}}{what}"):
        return next((str(value) for key, value in found.items() if str(key).endswith("}val")), "")
    return usual
