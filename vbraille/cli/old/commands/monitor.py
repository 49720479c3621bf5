"""``vbraille monitor``: a recording or a session, played back in the live view."""

from __future__ import annotations

import asyncio
import sys
import threading
import webbrowser
from typing import TYPE_CHECKING

from vbraille.cli.old.terminal import say_line
from vbraille.errors import InputError
from vbraille.live.monitor import has_desktop
from vbraille.live.server import LiveServer
from vbraille.playback import open_recording
from vbraille.signals import EAR

if TYPE_CHECKING:
    import argparse

    from vbraille.playback.recorded import Playback

# So long a signal may wait to be heard.
_HEED_S = 0.1


def run(arguments: argparse.Namespace) -> int:
    """Serve a recording until a signal says to stop."""
    if arguments.file is None:
        raise InputError(
            "nothing is to be played; give a recording or a session, as in vbraille monitor "
            "reading.h5: what is read now is shown by vbraille read FILE --monitor"
        )
    source = open_recording(arguments.file)
    for note in source.notes:
        print(f"note: {note}", file=sys.stderr)
    with EAR.deferred():
        asyncio.run(_serve(source, arguments.host, arguments.port))
    say_line("live view: ended")
    return 0


async def _serve(source: Playback, host: str | None, port: int | None) -> None:
    server = LiveServer(source, host=host, port=port, steers=False)
    async with server:
        address = server.admission.watching_address
        say_line(f"live view: {address}")
        if has_desktop():
            # Some browsers run in the foreground, and are not waited for.
            threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
        while not EAR.heard:
            await asyncio.sleep(_HEED_S)
