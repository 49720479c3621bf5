"""Formulas of MathML and of Word as TeX, by which readers know them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from vbraille.translate.trees import Element

_FUNCTIONS = frozenset(
    [
        "sin",
        "cos",
        "tan",
        "cot",
        "sec",
        "csc",
        "sinh",
        "cosh",
        "tanh",
        "arcsin",
        "arccos",
        "arctan",
        "log",
        "ln",
        "lg",
        "exp",
        "lim",
        "max",
        "min",
        "sup",
        "inf",
        "det",
        "dim",
        "ker",
        "gcd",
        "mod",
        "arg",
    ]
)
_INVISIBLE = dict.fromkeys(map(ord, "\u2061\u2062\u2063\u2064\u200b"))
_SIGNS = {"∑": "\\sum", "∏": "\\prod", "∫": "\\int", "⋃": "\\bigcup", "⋂": "\\bigcap"}
_ACCENTS = {"¯": "\\bar", "‾": "\\bar", "^": "\\hat", "ˆ": "\\hat", "→": "\\vec", "~": "\\tilde"}
_NO_TEXT = ("annotation", "annotation-xml")


def formula_text(math: Element) -> str:
    """Text of a formula in MathML: what its author says of it, its TeX, or TeX of its signs."""
    annotations = list(math.iter("annotation"))
    in_tex = [each for each in annotations if "tex" in each.get("encoding").lower()]
    told = math.get("alttext") or math.get("aria-label")
    if not told.strip() and in_tex:
        told = in_tex[0].text
    return " ".join((told if told.strip() else _tex(math)).split())


def _tex(element: Element) -> str:
    """TeX of an element of MathML."""
    children = [child for child in element.elements if child.name not in _NO_TEXT]
    match element.name:
        case "mi" | "mn" | "mo" | "ms" | "mtext" | "none" | "mprescripts":
            return _sign(element)
        case "msup" | "msub" | "msubsup" | "mover" | "munder" | "munderover" if len(children) > 1:
            return _scripts(element.name, [_tex(child) for child in children])
        case "mfrac" if len(children) == 2:
            return f"\\frac{{{_tex(children[0])}}}{{{_tex(children[1])}}}"
        case "mroot" if len(children) == 2:
            return f"\\sqrt[{_tex(children[1])}]{{{_tex(children[0])}}}"
        case "msqrt":
            return f"\\sqrt{{{_row(children)}}}"
        case "mfenced":
            opening, closing = element.get("open", "("), element.get("close", ")")
            between = element.get("separators", ",")[:1]
            return f"{opening}{between.join(map(_tex, children))}{closing}"
        case "mtable":
            return matrix([[_tex(cell) for cell in row.elements] for row in children])
    return _row(children)


def _row(children: list[Element]) -> str:
    text = ""
    for child in children:
        part = _tex(child)
        if child.name == "mi" and part.startswith("\\"):
            text += f"{' ' if text[-1:].isalnum() else ''}{part} "
        else:
            text += part
    return text.rstrip(" ") if not text.endswith("\\ ") else text


def _sign(element: Element) -> str:
    text = element.text.translate(_INVISIBLE).strip()
    if text in _FUNCTIONS:
        return f"\\{text}"
    return _SIGNS.get(text, text)


def _scripts(name: str, parts: list[str]) -> str:
    """TeX of a base with what is above and below it."""
    base = parts[0]
    if name == "mover" and parts[1] in _ACCENTS:
        return f"{_ACCENTS[parts[1]]}{{{base}}}"
    signs = {"msup": "^", "mover": "^", "msub": "_", "munder": "_"}.get(name, "_^")
    return base + "".join(
        f"{sign}{{{part}}}" for sign, part in zip(signs, parts[1:], strict=False) if part
    )


def matrix(rows: list[list[str]]) -> str:
    """TeX of a matrix."""
    lines = " \\\\ ".join(" & ".join(row) for row in rows)
    return f"\\begin{{matrix}} {lines} \\end{{matrix}}"


# Word's own formulas (OMML), by the names of their elements and parts.
_FORMS = {
    "f": "\\frac{{{num}}}{{{den}}}",
    "sSup": "{e}^{{{sup}}}",
    "sSub": "{e}_{{{sub}}}",
    "sSubSup": "{e}_{{{sub}}}^{{{sup}}}",
    "sPre": "{{}}_{{{sub}}}^{{{sup}}}{e}",
    "func": "{fName} {e}",
    "limLow": "{e}_{{{lim}}}",
    "limUpp": "{e}^{{{lim}}}",
    "bar": "\\overline{{{e}}}",
}
_PARTS = dict.fromkeys(("num", "den", "e", "sup", "sub", "fName", "lim", "deg"), "")


def omml_text(element: Element) -> str:
    """TeX of a formula of Word, or of a part of one."""
    if element.name == "t":
        return element.text
    inner = [child for child in element.elements if not child.name.endswith("Pr")]
    texts = [omml_text(child) for child in inner]
    parts = _PARTS | {child.name: text for child, text in zip(inner, texts, strict=True)}
    sign = {
        each.name: each.get("val") for each in element.iter("begChr", "sepChr", "endChr", "chr")
    }
    match element.name:
        case "d":
            between = sign.get("sepChr", "|").join(texts)
            return f"{sign.get('begChr', '(')}{between}{sign.get('endChr', ')')}"
        case "m":
            return matrix([[omml_text(cell) for cell in row.elements] for row in inner])
        case "eqArr":
            return " \\\\ ".join(texts)
        case "rad":
            degree = f"[{parts['deg']}]" if parts["deg"] else ""
            return f"\\sqrt{degree}{{{parts['e']}}}"
        case "nary":
            own = sign.get("chr", "∫")
            return (
                f"{_scripts('', [_SIGNS.get(own, own), parts['sub'], parts['sup']])} {parts['e']}"
            )
        case "acc":
            own = sign.get("chr", "\u0302")
            return f"{_ACCENTS[own]}{{{parts['e']}}}" if own in _ACCENTS else parts["e"] + own
        case name if name in _FORMS:
            return _FORMS[name].format(**parts)
    return "".join(texts)
