"""Functions of commands whose modules are loaded when the first of them is called.

What the commands are called and what their keys do is asked for by help, which shall not wait for
all that reading needs.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, ParamSpec

if TYPE_CHECKING:
    from collections.abc import Callable

Given = ParamSpec("Given")


class Deferred:
    """A module beside this one, of which only functions are known that load it when called.

    Parameters
    ----------
    name
        Name of the module, such as "moving".
    """

    def __init__(self, name: str) -> None:
        self._module = f"{__package__}.{name}"

    def __getattr__(self, name: str) -> Callable[..., Any]:
        """Give the function of a name, whether or not there is one."""

        def function(*given: Any, **named: Any) -> Any:
            return getattr(import_module(self._module), name)(*given, **named)

        return function


def made(
    make: Callable[Given, Callable[[Any], None]], *given: Given.args, **named: Given.kwargs
) -> Callable[[Any], None]:
    """Give a command that is made, of a function and what it is given, when it is called."""

    def handler(reader: Any) -> None:
        make(*given, **named)(reader)

    return handler
