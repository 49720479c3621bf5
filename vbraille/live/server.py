"""The server of the live view: the files of its page, and what its pages ask, in one thread."""

from __future__ import annotations

import asyncio
import errno
import logging
import os
import socket
import sys
import threading
import webbrowser
from concurrent.futures import Future
from contextlib import suppress
from http import HTTPStatus
from pathlib import Path
from typing import TYPE_CHECKING, Final

import msgspec
from websockets.asyncio.server import ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from vbraille.errors import InputError, VbrailleError
from vbraille.live.admission import LOOPBACK, Admission, is_stranger, owner_of
from vbraille.live.messages import (
    Hello,
    LetGo,
    Next,
    Point,
    Refused,
    Welcome,
    to_json,
    to_request,
)
from vbraille.wording import setting, spelled

if TYPE_CHECKING:
    from typing import Self

    from vbraille.live.frames import Source
    from vbraille.live.messages import Steering

_TYPES: Final = {".html": "text/html", ".css": "text/css", ".js": "text/javascript",
                 ".svg": "image/svg+xml"}  # fmt: skip
_HEADERS: Final = {
    "Cache-Control": "no-store",
    "Connection": "close",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "connect-src 'self'; img-src 'self' data:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'",
}
_SOCKET: Final = "/live"
MOST_PAGES: Final = 32
MOST_CONNECTIONS: Final = 256
_MOST_BYTES: Final = 4096  # of a request
_MOST_AHEAD: Final = 8  # requests that wait to be looked at
_HELLO_S: Final = 5.0
_PING_S: Final = 20.0
_CLOSE_S: Final = 1.0
# How often to look for a frame that a page waits for. Other requests wait as long as a frame does.
_LOOK_S: Final = 0.002
_MOST_WAIT_S: Final = 0.1
_BROKEN_RULE: Final = 1008
_log = logging.getLogger(__name__)


class Server:
    """Serves the page and one source; a context manager, whose thread serves while it is open.

    Parameters
    ----------
    source
        What pages show.
    host
        Name or address to listen at; loopback if it is None.
    port
        Port to listen at; a free one if it is None.
    steers
        Whether pages may steer.

    Attributes
    ----------
    admission : Admission
        Rules and addresses, once it serves.
    fault : str
        Why it has ended by itself; empty while it has not.

    Raises
    ------
    InputError
        If it cannot listen there; when it is entered.
    """

    admission: Admission

    def __init__(
        self,
        source: Source,
        *,
        host: str | None = None,
        port: int | None = None,
        steers: bool = True,
    ) -> None:
        self.fault = ""
        self._source = source
        self._host, self._port = LOOPBACK if host in (None, "localhost") else host, port or 0
        self._steers = steers
        self._pages: set[ServerConnection] = set()
        self._holder: ServerConnection | None = None  # page that is the hand
        folder = Path(__file__).parent / "page"
        self._files = {f"/{path.name}": path for path in folder.iterdir()}
        self._files["/"] = folder / "index.html"

    def __enter__(self) -> Self:
        started: Future[None] = Future()
        self._thread = threading.Thread(
            target=asyncio.run, args=(self._run(started),), name="live view", daemon=True
        )
        self._thread.start()
        started.result()
        return self

    def __exit__(self, *_: object) -> None:
        with suppress(RuntimeError):  # it has ended by itself
            self._loop.call_soon_threadsafe(self._stop.set)
        self._thread.join(2 * _CLOSE_S)

    async def _run(self, started: Future[None]) -> None:
        self._loop, self._stop = asyncio.get_running_loop(), asyncio.Event()
        # A browser that goes away in mid-frame is no news.
        silent = logging.Logger("websockets", logging.CRITICAL)
        self._loop.set_exception_handler(lambda _, context: _log.info("%s", context["message"]))
        try:
            if not self._host:  # the system would listen everywhere
                raise OSError("no name")
            # One address alone: each would have a port of its own.
            found = socket.getaddrinfo(self._host, None, type=socket.SOCK_STREAM)
            async with serve(
                self._talk,
                str(found[0][4][0]),
                self._port,
                process_request=self._answer,
                process_response=_secure,
                create_connection=_limited(),
                compression=None,
                server_header=None,
                open_timeout=_HELLO_S,
                ping_interval=_PING_S,
                ping_timeout=_PING_S,
                close_timeout=_CLOSE_S,
                max_size=_MOST_BYTES,
                max_queue=_MOST_AHEAD,
                logger=silent,
            ) as serving:
                port = serving.sockets[0].getsockname()[1]
                self.admission = Admission(self._host, port, self._steers)
                started.set_result(None)
                await self._stop.wait()
        except Exception as error:
            if not started.done():
                started.set_exception(_cannot_listen(self._host, self._port, error))
                return
            _log.exception("the live view has ended")
            self.fault = repr(error)

    def _answer(self, connection: ServerConnection, request: Request) -> Response | None:
        """Answer a request for a file, or refuse one; None lets a page's WebSocket begin."""
        hosts, origins = (request.headers.get_all(name) for name in ("Host", "Origin"))
        peer, local = connection.remote_address, connection.local_address
        if request.method != "GET":
            return _response(HTTPStatus.METHOD_NOT_ALLOWED, "this server answers GET only")
        if not peer or len(hosts) != 1 or not self.admission.is_called(hosts[0], local[0]):
            return _response(
                HTTPStatus.MISDIRECTED_REQUEST,
                "this server has another name; open the address that vbraille said",
            )
        if self.admission.on_loopback and is_stranger(owner_of(peer, local)):
            return _response(
                HTTPStatus.FORBIDDEN,
                "another user of this machine reads here; --host lets others watch by a token",
            )
        if request.path != _SOCKET:
            file = self._files.get(request.path)
            if file is None:
                return _response(HTTPStatus.NOT_FOUND, "there is no such page; open /")
            return _response(HTTPStatus.OK, file.read_bytes(), _TYPES[file.suffix])
        if origins and origins != [f"http://{hosts[0]}"]:
            return _response(HTTPStatus.FORBIDDEN, "a page of another server may not watch here")
        if len(self._pages) >= MOST_PAGES:
            return _response(
                HTTPStatus.SERVICE_UNAVAILABLE,
                f"{MOST_PAGES} pages are open; close one of them, and load this page again",
            )
        return None

    async def _talk(self, page: ServerConnection) -> None:
        """Talk with a page until it is gone, or has to go."""
        self._pages.add(page)
        try:
            await self._serve(page)
        except (msgspec.MsgspecError, RecursionError, ValueError, VbrailleError) as error:
            await _end(page, str(error))
        except ConnectionClosed:
            pass
        except Exception as error:
            _log.exception("a page could not be served")
            await _end(page, f"a fault of vbraille's own: {error!r}")
        finally:
            self._pages.discard(page)
            if self._holder is page:
                self._holder = None
                with suppress(VbrailleError):
                    self._source.ask(LetGo())

    async def _serve(self, page: ServerConnection) -> None:
        try:
            async with asyncio.timeout(_HELLO_S):
                hello = to_request(await page.recv())
        except TimeoutError:
            hello = None
        if not isinstance(hello, Hello):
            raise InputError(f"the first message is hello, within {_HELLO_S:g} s")
        assert page.request is not None
        ours = owner_of(page.remote_address, page.local_address) is not None
        from_page = ours and "Origin" in page.request.headers
        steers = self.admission.may_steer(hello.token, known=from_page)
        if steers is None:
            raise InputError(
                "the token of this address is not that of the live view that runs now; "
                "open the address that vbraille said"
            )
        source = self._source
        moments = list(source.moments)
        welcome = Welcome(steers, source.playback, source.length_s, moments)
        await page.send(to_json(welcome), text=True)
        viewer, told = source.viewer(), None
        async for said in page:
            request = to_request(said)
            if isinstance(request, Hello):
                raise InputError("hello is said once")
            if not isinstance(request, Next):
                if why := self._steer(page, request, may=steers):
                    await page.send(to_json(Refused(spelled(why))), text=True)
                continue
            late_s, known = self._loop.time() + _MOST_WAIT_S, told
            while (found := viewer.look(request, known)) is None:
                await asyncio.sleep(_LOOK_S)
                if self._loop.time() > late_s:
                    known = None
            number, state, frame = found
            if number != told:
                await page.send(state, text=True)
                told = number
            await page.send(frame)

    def _steer(self, page: ServerConnection, request: Steering, *, may: bool) -> str:
        """Do what a page asks; a sentence if it cannot be done."""
        try:
            if not may and not self._source.playback:
                raise InputError("this page may only watch; steering needs the other address")
            self._source.ask(request)
        except VbrailleError as error:
            return str(error)
        if isinstance(request, Point | LetGo):
            self._holder = page if isinstance(request, Point) else None
        return ""


async def _end(page: ServerConnection, why: str) -> None:
    with suppress(ConnectionClosed):
        await page.send(to_json(Refused(spelled(why))), text=True)
        await page.close(_BROKEN_RULE)


def _response(status: HTTPStatus, body: str | bytes, kind: str = "text/plain") -> Response:
    content = body if isinstance(body, bytes) else f"{body}\n".encode()
    headers = Headers({"Content-Type": f"{kind}; charset=utf-8"})
    headers["Content-Length"] = str(len(content))
    return Response(status.value, status.phrase, headers, content)


def _secure(_connection: ServerConnection, _request: Request, response: Response) -> None:
    """Give an answer the headers of safety; a WebSocket that begins is no page."""
    if response.status_code != HTTPStatus.SWITCHING_PROTOCOLS:
        for name in _HEADERS:
            response.headers.pop(name, None)
        response.headers.update(_HEADERS)


def _limited() -> type[ServerConnection]:
    """Make a class of connections with a largest number; those beyond it end at once.

    They would take the descriptors that reading needs, for the server is in the same process.
    """
    there: set[ServerConnection] = set()

    class Limited(ServerConnection):
        """A connection."""

        def connection_made(self, transport: asyncio.BaseTransport) -> None:
            super().connection_made(transport)
            there.add(self)
            if len(there) > MOST_CONNECTIONS:
                self.transport.abort()

        def connection_lost(self, exc: Exception | None) -> None:
            there.discard(self)
            super().connection_lost(exc)

    return Limited


def _cannot_listen(host: str | None, port: int, error: Exception) -> Exception:
    """Say why no server can listen at a place."""
    match error:
        case OSError(errno=errno.EADDRINUSE | errno.EACCES | errno.EPERM):
            why = f"port {port} is in use, or is the system's; give {setting('port')} another"
        case OSError() | UnicodeError() | OverflowError():
            why = f"{host!r}, port {port} is no place of this machine; correct {setting('host')}"
        case _:
            return error
    return InputError(why)


def open_browser(address: str) -> None:
    """Open a page, if a person sits here who would see it; nothing is waited for."""
    desktop = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    if desktop and sys.stdin is not None and sys.stdin.isatty():
        # Some browsers run in the foreground.
        threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
