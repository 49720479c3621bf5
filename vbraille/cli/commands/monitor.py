"""``vbraille monitor``."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from vbraille.cli import options
from vbraille.cli.printing import say
from vbraille.errors import InputError, VbrailleError
from vbraille.signals import Stopped

if TYPE_CHECKING:
    from vbraille.playback.recorded import Playback

_HDF5 = b"\x89HDF\r\n\x1a\n"
_LOOK_S = 0.5


@options.command(
    "monitor reading.h5",
    click.argument("file", type=click.Path(path_type=Path)),
    options.host(group=options.FIRST), options.port(group=options.FIRST),
)  # fmt: skip
def command(file: Path, host: str | None, port: int | None) -> None:
    """FILE is what vbraille render wrote, or a session. Ctrl-C ends it."""
    from vbraille.live.server import Server, open_browser

    source = _opened(file)
    for note in source.notes:
        say(f"note: {note}", aside=True)
    try:
        with Server(source, host=host, port=port, steers=False) as server:
            (address,) = server.admission.addresses
            say(f"live view: {address}")
            open_browser(address)
            while not server.fault:
                time.sleep(_LOOK_S)
            raise VbrailleError(f"the live view has ended: {server.fault}")
    except Stopped:
        say("live view: ended")


def _opened(path: Path) -> Playback:
    """Open a recording or a session, told by what it is."""
    try:
        is_hdf5 = path.is_file() and path.open("rb").read(len(_HDF5)) == _HDF5
    except (OSError, ValueError) as error:
        raise InputError(f"{path} cannot be read: {error}") from None
    if is_hdf5 or not path.exists():
        from vbraille.playback.rendered import open_recording

        return open_recording(path)
    from vbraille.sessions.playback import SessionPlayback

    return SessionPlayback(path)
