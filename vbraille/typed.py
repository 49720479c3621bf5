"""Values of the wrong type, refused in one sentence by the annotations of what takes them.

Only annotations of plain types are looked at, such as ``int`` or ``str | None``; what has another
type checks itself.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import wraps
from numbers import Integral, Real
from os import PathLike
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar, cast

from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import FunctionType

_P = ParamSpec("_P")
_T = TypeVar("_T")

# What annotations may be made of: words for people, and the types; True is no number here.
_KINDS: dict[str, tuple[str, tuple[type, ...]]] = {
    "str": ("a string", (str,)),
    "int": ("a whole number", (Integral,)),
    "float": ("a number", (Real,)),
    "bool": ("True or False", (bool,)),
    "Path": ("a path", (PathLike,)),
    "PathLike[str]": ("a path", (PathLike,)),
    "Mapping[str, str]": ("a dictionary", (Mapping,)),
    "None": ("None", (type(None),)),
}
# Classes of rooms above, known by their names.
_CLASSES = ("Conditions", "Protocol", "Scene")
_SHOWN = 40  # characters of a value that a sentence has


def typed(function: Callable[_P, _T]) -> Callable[_P, _T]:
    """Have a function refuse arguments of the wrong type.

    Parameters
    ----------
    function
        Function whose module has its annotations as text, as the future import makes them.

    Returns
    -------
    function
        It raises `InputError`, which names the parameter, before anything else is done.
    """
    code = cast("FunctionType", function).__code__
    names = code.co_varnames[: code.co_argcount]
    wanted = _wanted(function.__annotations__)

    @wraps(function)
    def checked(*args: _P.args, **kwargs: _P.kwargs) -> _T:
        for name, value in (*zip(names, args, strict=False), *kwargs.items()):
            if name in wanted and (fault := _fault(value, wanted[name])):
                raise InputError(f"the {name} is {fault[0]}; give {fault[1]}")
        return function(*args, **kwargs)

    return cast("Callable[_P, _T]", checked)


def check_fields(value: Any) -> None:
    """Check the fields of a dataclass, in its ``__post_init__``.

    Raises
    ------
    ValueError
        If one of them has not the type of its annotation; the sentence names it.
    """
    for name, kinds in _wanted(type(value).__annotations__).items():
        if fault := _fault(getattr(value, name), kinds):
            raise ValueError(f"{name} is {fault[0]}; it must be {fault[1]}")


def _wanted(annotations: dict[str, Any]) -> dict[str, list[str]]:
    """Plain types by the names of parameters or fields that have no other."""
    found = {name: str(each).split(" | ") for name, each in annotations.items()}
    found.pop("return", None)
    return {name: kinds for name, kinds in found.items() if {*_KINDS, *_CLASSES}.issuperset(kinds)}


def _fault(value: object, kinds: list[str]) -> tuple[str, str] | None:
    """A value as a sentence has it, and words for the types of which it has none; or None."""
    for kind in kinds:
        types = _KINDS[kind][1] if kind in _KINDS else ()
        is_truth = type(value).__name__ in ("bool", "bool_")  # numpy's, too
        if is_truth if kind == "bool" else isinstance(value, types) and not is_truth:
            return None
        if kind in _CLASSES and any(base.__name__ == kind for base in type(value).__mro__):
            return None
    shown = " ".join(repr(value).split())
    words = (_KINDS[kind][0] if kind in _KINDS else f"a {kind}" for kind in kinds)
    return f"{shown[:_SHOWN]}{'…' * (len(shown) > _SHOWN)}", " or ".join(dict.fromkeys(words))
