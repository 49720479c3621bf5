"""The server of the live view: the files of its page, and what its pages ask."""

from __future__ import annotations

import asyncio
import email.utils
import errno
import logging
import socket
from concurrent.futures import ThreadPoolExecutor
from http import HTTPStatus
from pathlib import Path
from typing import TYPE_CHECKING, Final

from websockets.asyncio.server import Server as Serving
from websockets.asyncio.server import ServerConnection, serve
from websockets.datastructures import Headers
from websockets.http11 import Request as HttpRequest
from websockets.http11 import Response

from vbraille.errors import InputError
from vbraille.live.admission import LOOPBACK, Admission, owner_of
from vbraille.live.connection import MOST_QUEUED, HandHolder, Talk
from vbraille.live.messages import MOST_BYTES
from vbraille.wording import setting

if TYPE_CHECKING:
    from typing import Self

    from vbraille.live.sources import LiveSource

_TYPES: Final = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".json": "application/json",
}
HEADERS: Final = (
    ("Cache-Control", "no-store"),
    ("X-Content-Type-Options", "nosniff"),
    ("Referrer-Policy", "no-referrer"),
    ("Cross-Origin-Resource-Policy", "same-origin"),
    ("Cross-Origin-Opener-Policy", "same-origin"),
    (
        "Content-Security-Policy",
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
        "img-src 'self' blob: data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
)


def page_files() -> dict[str, tuple[str, bytes]]:
    """Read the files of the page.

    Returns
    -------
    dict[str, tuple[str, bytes]]
        Content type and bytes of each, by its path; ``/`` is the page itself.
    """
    folder = Path(__file__).parent / "page"
    found = {
        f"/{path.relative_to(folder)}": (kind, path.read_bytes())
        for path in folder.rglob("*")
        if (kind := _TYPES.get(path.suffix))
    }
    return found | {"/": found["/index.html"]}


SOCKET_PATH: Final = "/live"
# Pages at a time; more are told so.
MOST_PAGES: Final = 32
# Connections at a time, whatever they are for; more are not even listened to.
MOST_CONNECTIONS: Final = 256
_OPEN_S: Final = 5.0
_PING_S: Final = 20.0
_CLOSE_S: Final = 1.0
_log = logging.getLogger(__name__)
# What one connection too many is told, whatever it wants.
_TOO_MANY: Final = (
    b"HTTP/1.1 503 Service Unavailable\r\nConnection: close\r\nContent-Type: text/plain\r\n\r\n"
    b"there are too many connections; close some of them, and load this page again\n"
)
# Bytes that wait to be sent to a page; nothing more is made for it meanwhile.
_WRITE_LIMIT: Final = 1 << 16
_TEXT: Final = "text/plain; charset=utf-8"
_FULL: Final = f"{MOST_PAGES} pages are open already; close one of them, and load this page again\n"


class LiveServer:
    """A server of one source; an asynchronous context manager, in which it serves.

    Parameters
    ----------
    source
        What it shows.
    host
        Name or address to listen at; this machine's loopback alone if it is None.
    port
        Port to listen at; a free one if it is None.
    steers
        Whether pages may steer at all.

    Attributes
    ----------
    admission : Admission
        Rules and addresses, once it serves.
    pages : int
        Number of pages that are connected.

    Raises
    ------
    InputError
        If no server can listen there; when it is entered.
    """

    admission: Admission

    def __init__(
        self,
        source: LiveSource,
        *,
        host: str | None = None,
        port: int | None = None,
        steers: bool = True,
    ) -> None:
        self.source = source
        self.pages = 0
        self._drawer = ThreadPoolExecutor(1)
        self._held = HandHolder()
        self._host = LOOPBACK if host in (None, "localhost") else host
        self._port = port or 0
        self._steers = steers
        self._files = page_files()

    async def __aenter__(self) -> Self:
        asyncio.get_running_loop().set_exception_handler(_say_nothing)
        try:
            self._serving = await self._serve(_address(self._host))
        except (OSError, OverflowError, UnicodeError) as error:
            raise InputError(_why_not(self._host, self._port, error)) from None
        port = int(next(iter(self._serving.sockets)).getsockname()[1])
        self.admission = Admission(self._host, port, self._steers)
        return self

    async def __aexit__(self, *_: object) -> None:
        self._drawer.shutdown(wait=False, cancel_futures=True)
        self._serving.close()
        await self._serving.wait_closed()

    def _serve(self, address: str) -> Serving:
        return serve(
            self._talk,
            address,
            self._port,
            compression=None,
            process_request=self._answer,
            process_response=_secure,
            server_header=None,
            open_timeout=_OPEN_S,
            ping_interval=_PING_S,
            ping_timeout=_PING_S,
            close_timeout=_CLOSE_S,
            max_size=MOST_BYTES,
            max_queue=MOST_QUEUED,
            write_limit=_WRITE_LIMIT,
            logger=_silent(),
            create_connection=_counted(),
        )

    def _answer(self, connection: ServerConnection, request: HttpRequest) -> Response | None:
        """Answer a request for a file, or refuse one; None lets a page's WebSocket begin."""
        # Older releases of websockets know no other method, and refuse the rest themselves.
        if getattr(request, "method", "GET") != "GET":
            return _response(HTTPStatus.METHOD_NOT_ALLOWED, "this server answers GET only\n")
        try:
            hosts, origins = request.headers.get_all("Host"), request.headers.get_all("Origin")
            host = hosts[0] if len(hosts) == 1 else ""
            local = str(connection.local_address[0])
            owner = owner_of(connection.remote_address, connection.local_address)
        except (TypeError, IndexError):  # it is gone already
            return _response(HTTPStatus.BAD_REQUEST, "the connection is gone\n")
        if not self.admission.is_ours(host, local):
            return _response(
                HTTPStatus.MISDIRECTED_REQUEST,
                "this server has another name; open the address that vbraille said\n",
            )
        if not self.admission.is_for(owner):
            return _response(
                HTTPStatus.FORBIDDEN,
                "another user of this machine reads here; --host lets others watch by a token\n",
            )
        if request.path != SOCKET_PATH:
            found = self._files.get(request.path)
            if found is None:
                return _response(HTTPStatus.NOT_FOUND, "there is no such page; open /\n")
            return _response(HTTPStatus.OK, found[1], found[0])
        if origins and origins != [f"http://{host}"]:
            return _response(HTTPStatus.FORBIDDEN, "a page of another server may not watch here\n")
        if self.pages >= MOST_PAGES:
            return _response(HTTPStatus.SERVICE_UNAVAILABLE, _FULL)
        return None

    async def _talk(self, connection: ServerConnection) -> None:
        """Talk with a page until it is gone."""
        if self.pages >= MOST_PAGES:  # several have come at once
            await connection.close(1013, _FULL.strip())
            return
        self.pages += 1
        try:
            await Talk(connection, self.source, self.admission, self._drawer, self._held).run()
        finally:
            self.pages -= 1


def _secure(_connection: ServerConnection, _request: HttpRequest, response: Response) -> None:
    """Give an answer the headers of safety; a WebSocket that begins is no page."""
    if response.status_code != HTTPStatus.SWITCHING_PROTOCOLS:
        for name, value in HEADERS:
            response.headers[name] = value


def _response(status: HTTPStatus, body: str | bytes, kind: str = _TEXT) -> Response:
    content = body.encode() if isinstance(body, str) else body
    headers = Headers(
        Date=email.utils.formatdate(usegmt=True),
        Connection="close",
    )
    headers["Content-Type"] = kind
    headers["Content-Length"] = str(len(content))
    return Response(status.value, status.phrase, headers, content)


def _counted() -> type[ServerConnection]:
    """Make the class of a server's connections, which has only so many at a time."""
    there: set[ServerConnection] = set()

    class Counted(ServerConnection):
        """A connection; one too many is told so, and ended."""

        def connection_made(self, transport: asyncio.BaseTransport) -> None:
            if len(there) < MOST_CONNECTIONS:
                there.add(self)
                super().connection_made(transport)
                return
            assert isinstance(transport, asyncio.Transport)
            transport.set_protocol(asyncio.Protocol())  # which hears nothing
            transport.write(_TOO_MANY)
            transport.close()

        def connection_lost(self, exc: Exception | None) -> None:
            there.discard(self)
            super().connection_lost(exc)

    return Counted


def _address(host: str) -> str:
    """Address of a name: one alone, for each would have a port of its own.

    Raises
    ------
    OSError, UnicodeError
        If the name is unknown.
    """
    if not host:  # the system would listen everywhere
        raise OSError("no name")
    return str(socket.getaddrinfo(host, None, type=socket.SOCK_STREAM)[0][4][0])


def _silent() -> logging.Logger:
    """Make a logger that says nothing: a browser that goes away in mid-frame is no news."""
    logger = logging.Logger("vbraille.live.websockets")
    logger.disabled = True
    return logger


def _say_nothing(_loop: asyncio.AbstractEventLoop, context: dict[str, object]) -> None:
    """Note for developers what asyncio would print a traceback of."""
    _log.info("the event loop says: %s", context.get("exception") or context.get("message"))


def _why_not(host: str, port: int, error: Exception) -> str:
    """Sentence on why no server can listen at a place."""
    where = f"port {port}"
    match getattr(error, "errno", None):
        case errno.EADDRINUSE:
            return f"{where} is in use; give {setting('port')} another, or leave it out"
        case errno.EACCES | errno.EPERM:
            return f"{where} is not for everybody; give {setting('port')} one above 1023"
        case errno.EADDRNOTAVAIL:
            return f"{host} is not an address of this machine; give {setting('host')} one that is"
    if isinstance(error, OverflowError):
        return f"there is no {where}; give {setting('port')} a number from 1 to 65535"
    return f"{host!r} is no name or address of this machine; give {setting('host')} one that is"
