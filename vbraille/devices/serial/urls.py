"""URLs of ports: what can be wrong with them, in our own words.

pyserial opens them; of what it says when it cannot, little is for its users.
"""

from __future__ import annotations

import errno
import importlib.util
import re
import socket
from pathlib import Path
from typing import TYPE_CHECKING, Final
from urllib.parse import parse_qsl, urlsplit

from vbraille.errors import DeviceError, InputError, VbrailleError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_LOGGING: Final = ("debug", "info", "warning", "error")
# What pyserial can open, with an example, and the options that go behind a question mark.
_EXAMPLES: Final = {
    "socket": "socket://192.168.1.5:7000",
    "rfc2217": "rfc2217://192.168.1.5:7000",
    "spy": "spy:///dev/ttyACM0?file=bytes.txt",
    "alt": "alt:///dev/ttyACM0?class=PosixPollSerial",
    "loop": "loop://",
    "hwgrep": "hwgrep://Arduino",
    "cp2110": "cp2110://0001:004a:00",
}
_OPTIONS: Final = {
    "socket": ("logging",),
    "rfc2217": ("logging", "ign_set_control", "poll_modem", "timeout"),
    "spy": ("file", "color", "raw", "all"),
    "alt": ("class",),
    "loop": ("logging",),
}
_CLASSES: Final = ("Serial", "PosixPollSerial", "VTIMESerial")


def check_url(url: str) -> None:
    """Check that a URL can be one, before it is opened.

    Raises
    ------
    InputError
        If it cannot; the message says what is wrong in it, and gives an example.
    """
    scheme = url.partition("://")[0].lower()
    if scheme not in _EXAMPLES:
        raise InputError(
            f"{url} cannot be opened, for there is no kind of port {scheme}://; give a path such "
            f"as /dev/ttyACM0, or {', '.join(_EXAMPLES.values())}"
        )
    for fault in _CHECKS.get(scheme, _check_options)(url, scheme):
        raise InputError(f"{url} cannot be opened, for {fault}; an example is {_EXAMPLES[scheme]}")


def _check_host(url: str, scheme: str) -> Iterator[str]:
    try:
        parts = urlsplit(url)
        host, port = parts.hostname, parts.port
    except ValueError:
        yield "it needs a host and the number of a port from 1 to 65535"
        return
    if not host:
        yield "it names no host"
    if not port:
        yield "it needs the number of a port from 1 to 65535"
    if parts.path not in ("", "/"):
        yield f"nothing can follow the number of the port, as {parts.path!r} does"
    yield from _check_options(url, scheme)


def _check_path(url: str, scheme: str) -> Iterator[str]:
    parts = urlsplit(url)
    if not parts.netloc + parts.path:
        yield "it names no port"
    yield from _check_options(url, scheme)


def _check_options(url: str, scheme: str) -> Iterator[str]:
    known = _OPTIONS.get(scheme, ())
    for name, value in parse_qsl(urlsplit(url).query, keep_blank_values=True):
        if name not in known:
            there_is = f"there is {', '.join(known)}" if known else "it has none"
            yield f"{scheme}:// has no option {name!r} ({there_is})"
        if name == "logging" and value not in _LOGGING:
            yield f"logging is {value!r} and must be one of {', '.join(_LOGGING)}"
        if name == "timeout" and not re.fullmatch(r"\d+(\.\d+)?", value):
            yield f"timeout is {value!r} and must be a number of seconds"
        if name == "file" and not Path(value).absolute().parent.is_dir():
            yield f"there is no folder for the file {value!r}"
        if name == "class" and value not in _CLASSES:
            yield f"class is {value!r} and must be one of {', '.join(_CLASSES)}"


def _check_search(url: str, _scheme: str) -> Iterator[str]:
    pattern, *options = url.partition("://")[2].split("&")
    if not pattern:
        yield "it has nothing to look for"
    try:
        re.compile(pattern)
    except re.error:
        yield f"{pattern!r} is no regular expression"
    for option in options:
        name, _, value = option.partition("=")
        if name not in ("n", "skip_busy"):
            yield f"hwgrep:// has no option {name!r} (there is n, skip_busy)"
        if name == "n" and not re.fullmatch("[1-9][0-9]{0,2}", value):
            yield f"n is {value!r} and must be 1 for the first port found, 2 for the next"


def _check_usb(_url: str, _scheme: str) -> Iterator[str]:
    if importlib.util.find_spec("hid") is None:
        yield "the Python package hidapi is not installed, which it needs"


_CHECKS: Final[dict[str, Callable[[str, str], Iterator[str]]]] = {
    "socket": _check_host,
    "rfc2217": _check_host,
    "spy": _check_path,
    "alt": _check_path,
    "hwgrep": _check_search,
    "cp2110": _check_usb,
}


def explain_url(fault: BaseException, url: str) -> VbrailleError:
    """Sentence on why a valid URL was not opened, and on what to do."""
    scheme = url.partition("://")[0].lower()
    if scheme == "hwgrep":
        return InputError(
            f"no port fits {url}; 'vbraille device list' tells what is plugged in, and its names"
        )
    if scheme not in ("socket", "rfc2217"):
        return InputError(f"{url} is no serial port; choose another, such as {_EXAMPLES[scheme]}")
    parts = urlsplit(url)
    host, port = parts.hostname, parts.port
    for cause in _causes(fault):
        if isinstance(cause, socket.gaierror):
            return InputError(f"there is no computer {host}; see that its name is right")
        if isinstance(cause, TimeoutError) or _number(cause) == errno.ETIMEDOUT:
            return DeviceError(f"{host} does not answer; see that it is on and in this network")
        if _number(cause) in (errno.ENETUNREACH, errno.EHOSTUNREACH):
            return DeviceError(f"there is no way to {host}; see that it is on and in this network")
        if _number(cause) == errno.ECONNREFUSED:
            return DeviceError(
                f"{host} is there, but nothing answers at its port {port}; start what is to "
                f"answer, or give another number"
            )
    return DeviceError(
        f"{url} cannot be opened, for what answers there does not do what {scheme}:// needs; "
        f"see that host and port are right"
    )


def _causes(fault: BaseException | None) -> Iterator[BaseException]:
    """An exception and its causes: pyserial puts its own around those of the system."""
    while fault is not None:
        yield fault
        fault = fault.__cause__ or fault.__context__


def _number(fault: BaseException) -> int | None:
    return fault.errno if isinstance(fault, OSError) else None
