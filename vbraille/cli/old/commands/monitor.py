"""``vbraille monitor``: a recording or a session, played back in the live view."""

from __future__ import annotations

import sys
import time
import webbrowser
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING

from vbraille.cli.old.terminal import say_line
from vbraille.errors import InputError
from vbraille.live.server import Server, has_desktop
from vbraille.signals import EAR

if TYPE_CHECKING:
    import argparse

    from vbraille.playback.recorded import Playback

_HEED_S = 0.1  # how long a signal may wait to be heard


def run(arguments: argparse.Namespace) -> int:
    """Serve a recording until a signal says to stop."""
    if arguments.file is None:
        raise InputError(
            "nothing is to be played; give a recording or a session, as in vbraille monitor "
            "reading.h5: what is read now is shown by vbraille read FILE --monitor"
        )
    source = _open(Path(arguments.file))
    for note in source.notes:
        print(f"note: {note}", file=sys.stderr)
    with (
        EAR.deferred(),
        Server(source, host=arguments.host, port=arguments.port, steers=False) as server,
    ):
        (address,) = server.admission.addresses
        say_line(f"live view: {address}")
        if has_desktop():
            Thread(target=webbrowser.open, args=(address,), daemon=True).start()
        while not EAR.heard and not server.fault:
            time.sleep(_HEED_S)
    say_line("live view: ended")
    return 0


def _open(path: Path) -> Playback:
    """Open a session, or a recording."""
    if path.is_dir() or path.suffix == ".gz":
        from vbraille.sessions.playback import open_session

        return open_session(path)
    from vbraille.playback.rendered import open_recording

    return open_recording(path)
