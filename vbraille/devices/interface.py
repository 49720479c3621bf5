"""What the members of a driver must be, told from `Device` itself."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property

from vbraille.devices.base import Device, Particulars
from vbraille.devices.events import Placing, is_known

# Arguments that a member is given, if it is given any.
_ARGUMENTS = {"write": 1, "_send": 1}
_METHODS = (
    "read",
    "write",
    "rest",
    "close",
    "_send",
    "_release",
    "set_zero",
    "take_events",
    "counts",
)
_VALUES: dict[str, tuple[type, ...]] = {
    "rested": (int,),
    "placing": (Placing,),
    "taking": (bool,),
    "acknowledges": (bool,),
    "acknowledged_ns": (int, type(None)),
    "watchdog_trips": (int, type(None)),
    "particulars": (Particulars, type(None)),
}


def misfits(device: Device) -> Iterator[str]:
    """Members of a device that differ in kind from those of `Device`, a sentence for each.

    A property in place of a method would be called, and a method in place of a property would
    always count as true; neither shows before somebody reads on the device. Nothing of the device
    is called here.
    """
    for name in _METHODS:
        method = _plain(inspect.getattr_static(device, name))
        if not callable(method):
            kind = "a property" if isinstance(method, property | cached_property) else f"{method!r}"
            yield f"{name} must be a method, and is {kind}"
        elif not _takes(method, _given(device, name)):
            given = ", ".join(["self", *["value"] * _ARGUMENTS.get(name, 0)])
            yield f"{name} must be a method that can be called as {name}({given})"
    if hasattr(device, "take_notes"):
        yield "take_notes is not asked any more; take_events must give Notice(code, text) instead"
    for name in ("display", *_VALUES):
        if callable(_plain(inspect.getattr_static(device, name))):
            yield f"{name} must be a property or a value, and is a method"


def wrong_values(device: Device) -> Iterator[str]:
    """Values of an opened device that differ in kind from what `Device` says, a sentence each."""
    for name, kinds in _VALUES.items():
        value = getattr(device, name)
        if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds):
            wanted = " or ".join("None" if kind is type(None) else kind.__name__ for kind in kinds)
            yield f"{name} must be {wanted}, and is {value!r}"
    events = device.take_events()
    if not isinstance(events, Sequence):
        yield f"take_events must give a list of events, and gives {events!r}"
    elif wrong := next((each for each in events if not is_known(each)), None):
        yield f"take_events must give events of vbraille.devices.events, and gives {wrong!r}"
    counts = device.counts()
    if not isinstance(counts, Mapping) or not all(
        isinstance(name, str) and isinstance(count, int) for name, count in counts.items()
    ):
        yield f"counts must give whole numbers by name, and gives {counts!r}"


def _plain(member: object) -> object:
    return member.__func__ if isinstance(member, staticmethod | classmethod) else member


def _given(device: Device, name: str) -> int:
    """Number of arguments that a member gets, including the device if the class has the member."""
    static = isinstance(inspect.getattr_static(device, name), staticmethod)
    return _ARGUMENTS.get(name, 0) + (name not in vars(device) and not static)


def _takes(method: Callable[..., object], given: int) -> bool:
    """Whether a method can be called with a number of arguments."""
    try:
        inspect.signature(method).bind(*[None] * given)
    except TypeError:
        return False
    except ValueError:  # it is compiled, and has no signature
        return True
    return True
