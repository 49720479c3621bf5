"""The talk with one page: its greeting, then what it asks for, each answered in its turn."""

from __future__ import annotations

import asyncio
import logging
from collections import deque
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import msgspec
from websockets.exceptions import ConnectionClosed

from vbraille.errors import VbrailleError
from vbraille.live.admission import Right, owner_of
from vbraille.live.framing import map_bytes
from vbraille.live.messages import (
    VERSION,
    AnyRequest,
    LetGo,
    Map,
    Next,
    PageHello,
    Point,
    Refused,
    Welcome,
)
from vbraille.wording import spelled

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from websockets.asyncio.server import ServerConnection

    from vbraille.live.admission import Admission
    from vbraille.live.sources import LiveSource, Steering, Viewer

# Messages of a page that wait to be looked at, and frames that it may ask for ahead.
MOST_QUEUED: Final = 8
_HELLO_S: Final = 5.0
# A page that asks for two frames at once has the second when the next tick is there. Then how often
# to look whether there is a frame that a page waits for, and how long at most.
_TICK_S: Final = 0.002
_LOOK_S: Final = 0.005
_MOST_WAIT_S: Final = 1.0
_POLICY: Final = 1008  # the code of a WebSocket that is closed since a rule was broken
_log = logging.getLogger(__name__)
_encode = msgspec.json.Encoder().encode
_decode = msgspec.json.Decoder(AnyRequest).decode


class _EndTalkError(Exception):
    """The page has to be told a sentence, and the talk ends."""


@dataclass(slots=True)
class HandHolder:
    """Owner of the simulated hand: the talk that moved it last, if any."""

    by: Talk | None = None


class Talk:
    """The talk with a page.

    Parameters
    ----------
    connection
        The page's WebSocket.
    source
        What is shown.
    admission
        Who may do what.
    drawer
        Thread that draws maps, one after the other.
    held
        Who has the simulated hand, for all talks of a server.
    """

    def __init__(
        self,
        connection: ServerConnection,
        source: LiveSource,
        admission: Admission,
        drawer: Executor,
        held: HandHolder,
    ) -> None:
        self._connection = connection
        self._source = source
        self._admission = admission
        self._viewer: Viewer = source.viewer()
        self._right = Right.NONE
        self._told = -1  # number of the last state that the page was told
        self._owed: deque[Next] = deque()
        self._waits_since_s = 0.0
        self._drawer = drawer
        self._held = held
        self._drawing: asyncio.Task[None] | None = None

    async def run(self) -> None:
        """Talk until the page is gone, or has to go."""
        try:
            await self._greet()
            while True:
                await self._step()
        except ConnectionClosed:
            pass
        except _EndTalkError as end:
            await self._end(str(end))
        except Exception as error:
            _log.exception("a page could not be served")
            await self._end(
                f"a fault of vbraille's own, which its authors want to hear of: {error!r}"
            )
        finally:
            self._leave()

    def _leave(self) -> None:
        if self._drawing is not None:
            self._drawing.cancel()
        if self._held.by is self:
            self._held.by = None
            with suppress(VbrailleError):
                self._source.ask(LetGo())

    async def _end(self, why: str) -> None:
        with suppress(ConnectionClosed):
            await self._refuse(why)
            await self._connection.close(_POLICY)

    async def _refuse(self, why: str) -> None:
        await self._connection.send(_encode(Refused(spelled(why))), text=True)

    async def _greet(self) -> None:
        try:
            async with asyncio.timeout(_HELLO_S):
                hello = await self._receive()
        except TimeoutError:
            raise _EndTalkError(
                f"nothing was said for {_HELLO_S:g} s; the first message is hello"
            ) from None
        if not isinstance(hello, PageHello):
            raise _EndTalkError("the first message is hello")
        connection = self._connection
        request = connection.request
        known = owner_of(connection.remote_address, connection.local_address) is not None
        from_page = known and request is not None and "Origin" in request.headers
        self._right = self._admission.right(hello.token, from_page=from_page)
        if self._right is Right.NONE:
            raise _EndTalkError(
                "the token of this address is not that of the live view that runs now; "
                "open the address that vbraille said"
            )
        source = self._source
        welcome = Welcome(
            VERSION,
            steers=self._right is Right.STEER,
            playback=source.playback,
            length_s=source.length_s,
            moments=list(source.moments),
        )
        await self._connection.send(_encode(welcome), text=True)

    async def _receive(self) -> AnyRequest:
        said = await self._connection.recv()
        if isinstance(said, bytes):
            raise _EndTalkError("requests are text: one JSON object each")
        try:
            return _decode(said)
        except (msgspec.MsgspecError, RecursionError, ValueError) as error:
            raise _EndTalkError(f"that is no request: {error}") from None

    async def _step(self) -> None:
        """Answer the oldest frame asked for if there is one, or else hear what else is asked."""
        owed = self._owed
        if not owed:
            await self._take(await self._receive())
            return
        if await self._answered():
            return
        # Sleeping costs a fraction of hearing with a limit, and mostly that is all.
        await asyncio.sleep(_TICK_S)
        if await self._answered():
            return
        if len(owed) > MOST_QUEUED:
            await asyncio.sleep(_LOOK_S)
        else:
            # A page that steers must not wait until something new is to be seen.
            with suppress(TimeoutError):
                async with asyncio.timeout(_LOOK_S):
                    request = await self._receive()
                await self._take(request)

    async def _answered(self) -> bool:
        """Send a state that is new, and the frame that is owed; tell whether there was one."""
        request = self._owed[0]
        number, state = self._viewer.state(request)
        is_new = number != self._told
        late = asyncio.get_running_loop().time() - self._waits_since_s > _MOST_WAIT_S
        frame = self._viewer.frame(request, again=is_new or late)
        if frame is None:
            return False
        if is_new:
            await self._connection.send(state, text=True)
            self._told = number
        await self._connection.send(frame)
        self._owed.popleft()
        self._waits_since_s = asyncio.get_running_loop().time()
        return True

    async def _take(self, request: AnyRequest) -> None:
        match request:
            case Next():
                if not self._owed:
                    self._waits_since_s = asyncio.get_running_loop().time()
                self._owed.append(request)
            case Map():
                await self._draw(request)
            case PageHello():
                raise _EndTalkError("hello is said once")
            case _:
                await self._steer(request)

    async def _steer(self, request: Steering) -> None:
        if self._right is not Right.STEER:
            await self._refuse(
                "no page can steer what is played back"
                if self._source.playback
                else "this page may only watch; steering needs the other address"
            )
            return
        try:
            self._source.ask(request)
        except VbrailleError as error:
            await self._refuse(str(error))
        else:
            if isinstance(request, Point | LetGo):
                self._held.by = self if isinstance(request, Point) else None

    async def _draw(self, request: Map) -> None:
        if request.form not in ("png", "svg"):
            await self._refuse(f'there is no map as {request.form!r}; ask for "png" or "svg"')
        elif self._drawing is not None and not self._drawing.done():
            await self._refuse("the map before is still being drawn; ask again when it is there")
        else:
            self._drawing = asyncio.create_task(self._map(request))

    async def _map(self, request: Map) -> None:
        with suppress(ConnectionClosed):
            try:
                loop = asyncio.get_running_loop()
                drawn = await loop.run_in_executor(self._drawer, self._source.map, request)
            except VbrailleError as error:
                await self._refuse(str(error))
            except Exception as error:
                _log.exception("a map could not be drawn")
                await self._refuse(f"the map could not be drawn: {error}")
            else:
                await self._connection.send(map_bytes(drawn, request.form))
