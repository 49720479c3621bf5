"""Pages without a browser: what a page says and hears, in Python, and a server in a thread."""

from __future__ import annotations

import asyncio
import json
import threading
from contextlib import contextmanager
from http.client import HTTPConnection
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from websockets.sync.client import connect

from tests.live.headers import FRAME, MAP
from vbraille.live.server import LiveServer

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray
    from websockets.sync.client import ClientConnection

    from vbraille.live.sources import LiveSource


class FrameRead(NamedTuple):
    """A frame as a page reads it."""

    header: np.void
    deflections: NDArray[np.float32]
    samples: NDArray[np.float32]
    signals: NDArray[np.float32]


def read_frame(frame: bytes) -> FrameRead:
    """Read a frame by its header alone, as a page does; nothing may be left over."""
    header = np.frombuffer(frame, FRAME, 1)[0]
    rows, columns, samples = int(header["rows"]), int(header["columns"]), int(header["samples"])
    numbers = np.frombuffer(frame, "<f4", offset=FRAME.itemsize)
    assert numbers.size == rows * columns + 3 * samples + header["signals"]
    deflections, of_samples, signals = np.split(
        numbers, [rows * columns, rows * columns + 3 * samples]
    )
    return FrameRead(
        header, deflections.reshape(rows, columns), of_samples.reshape(samples, 3), signals
    )


class TestPage:
    """A page's WebSocket.

    Parameters
    ----------
    connection
        The connection.
    """

    __test__ = False

    def __init__(self, connection: ClientConnection) -> None:
        self.connection = connection
        self.state: dict = {}
        self.states = 0

    def say(self, ask: str, **what: object) -> None:
        """Send a request."""
        self.connection.send(json.dumps({"ask": ask, **what}))

    def hear(self) -> dict:
        """Receive an answer that is no frame."""
        said = self.connection.recv(20)
        assert isinstance(said, str)
        return json.loads(said)

    def hello(self, token: str = "") -> dict:
        """Greet the server; what it answers."""
        self.say("hello", token=token)
        return self.hear()

    def frame(self, **request: object) -> FrameRead:
        """Pull a frame, and whatever state comes before it."""
        return read_frame(self.bytes_of_frame(**request))

    def bytes_of_frame(self, **request: object) -> bytes:
        self.say("next", **request)
        said = self.connection.recv(20)
        if isinstance(said, str):
            self.state = json.loads(said)
            assert self.state["tell"] == "state", said
            self.states += 1
            said = self.connection.recv(20)
        assert isinstance(said, bytes)
        return said

    def map(self, form: str = "png") -> tuple[bool, bytes]:
        """Ask for a map; whether it is an SVG, and its bytes."""
        self.say("map", form=form)
        said = self.connection.recv(20)
        assert isinstance(said, bytes), said
        (header,) = np.frombuffer(said, MAP, 1)
        file = said[MAP.itemsize :]
        assert len(file) == header["bytes"]
        return bool(header["svg"]), file


def parts_of(address: str) -> tuple[str, int, str]:
    """Host, port and token of an address as the program says it."""
    base, _, token = address.partition("#")
    host, _, port = base.removeprefix("http://").rstrip("/").rpartition(":")
    return host, int(port), token


@contextmanager
def page(
    address: str, *, origin: str | None = "", host: str = "", greets: bool = True
) -> Iterator[TestPage]:
    """Open a page at an address, with its token; the origin is the server's own if it is ""."""
    name, port, token = parts_of(address)
    with connect(
        f"ws://{host or f'{name}:{port}'}/live",
        sock=None if not host else _connected(name, port),
        origin=f"http://{name}:{port}" if origin == "" else origin,  # type: ignore[arg-type]
        compression=None,
        max_size=None,
    ) as connection:
        opened = TestPage(connection)
        if greets:
            assert opened.hello(token)["tell"] == "welcome"
        yield opened


def _connected(name: str, port: int):
    import socket

    return socket.create_connection((name, port))


def get(address: str, path: str = "/", method: str = "GET", **headers: str):
    """Ask for a file; the answer, its bytes, and its headers."""
    host, port, _ = parts_of(address)
    asking = HTTPConnection(host.strip("[]"), port, timeout=20)
    asking.request(method, path, headers=headers)
    answer = asking.getresponse()
    body = answer.read()
    asking.close()
    return answer.status, body.decode(errors="replace"), answer.headers


@contextmanager
def served(source: LiveSource, **options) -> Iterator[LiveServer]:
    """Run a server in a thread of its own."""
    started, ended = threading.Event(), asyncio.Event()
    found: list[LiveServer | BaseException] = []
    loops: list[asyncio.AbstractEventLoop] = []

    async def serve() -> None:
        loops.append(asyncio.get_running_loop())
        try:
            async with LiveServer(source, **options) as server:
                found.append(server)
                started.set()
                await ended.wait()
        except BaseException as error:
            found.append(error)
            started.set()

    thread = threading.Thread(target=asyncio.run, args=(serve(),))
    thread.start()
    started.wait()
    try:
        if isinstance(found[0], BaseException):
            raise found[0]
        yield found[0]
    finally:
        if len(found) == 1 and isinstance(found[0], LiveServer):
            loops[0].call_soon_threadsafe(ended.set)
        thread.join()
