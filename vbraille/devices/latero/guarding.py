"""The driver's end of the Latero's guardian: starts it, beats, and sees whether it lives."""

from __future__ import annotations

import mmap
import os
import select
import subprocess
import sys
from typing import TYPE_CHECKING, Final

from vbraille.devices.latero import guardian
from vbraille.errors import DeviceError

if TYPE_CHECKING:
    from collections.abc import Sequence

# It takes a few hundredths of a second; this is a machine with a lot to do.
_START_S: Final = 10.0
_END_S: Final = 2.0


class Guarding:
    """A guardian that watches from now on, until `close`.

    Parameters
    ----------
    request
        FULL with all blades at rest, which the guardian changes as it has to.
    off
        RAW that switches motor power off.
    socket
        Descriptor of a socket of the guardian's own, connected to the Latero.
    kept
        Further descriptors that stay open as long as the guardian lives.

    Attributes
    ----------
    board : Board
        Memory that is shared with the guardian.

    Raises
    ------
    DeviceError
        If it does not begin to watch.
    """

    def __init__(self, request: bytes, off: bytes, socket: int, kept: Sequence[int] = ()) -> None:
        memory = os.memfd_create("vbraille-latero")
        os.ftruncate(memory, guardian.MEMORY_BYTES)
        self._memory = mmap.mmap(memory, guardian.MEMORY_BYTES)
        self.board = guardian.Board(self._memory)
        self.board.full[:] = request
        self.board.off[:] = off
        lifeline, self._lifeline = os.pipe()
        try:
            self._process = subprocess.Popen(
                [
                    sys.executable,
                    "-I",
                    "-S",
                    guardian.__file__,
                    *map(str, (memory, lifeline, socket)),
                ],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                pass_fds=(memory, lifeline, socket, *kept),
                cwd="/",
                start_new_session=True,  # what ends the driver's session does not end it
            )
        except OSError as error:
            os.close(self._lifeline)
            raise DeviceError(
                f"the Latero's guardian cannot be started: {error.strerror}"
            ) from None
        finally:
            os.close(memory)
            os.close(lifeline)
        self._ended = os.pidfd_open(self._process.pid)
        self._look = select.poll()
        self._look.register(self._ended, select.POLLIN)
        self._wait()

    def _wait(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as said:
            ready, _, _ = select.select([said], (), (), _START_S)
            if not (ready and os.read(said.fileno(), 1)):
                self._process.kill()
                self.close()
                raise DeviceError(
                    "the Latero's guardian does not begin to watch, and without it nobody may "
                    "read on a Latero; try again"
                )

    @property
    def process_id(self) -> int:
        """Number of the guardian's process."""
        return self._process.pid

    @property
    def alive(self) -> bool:
        """Whether the guardian lives; this never waits."""
        return not self._look.poll(0)

    @property
    def trips(self) -> int:
        """How often the guardian has begun to bring the blades to rest."""
        return self.board.words[guardian.TRIPS]

    def beat(self, now_ns: int) -> None:
        """Say that the driver lives; this never waits."""
        self.board.words[guardian.BEAT] = now_ns

    def close(self, *, all_done: bool = True) -> None:
        """Have the guardian end, and wait for that.

        Parameters
        ----------
        all_done
            Whether it has nothing to do; otherwise it brings the blades to rest before, and
            switches motor power off.
        """
        if all_done:
            self.board.words[guardian.STATE] = guardian.CLOSED
        os.close(self._lifeline)
        try:
            self._process.wait(_END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._ended)
