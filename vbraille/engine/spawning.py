"""The beginning of a host process: how its parent starts it, and what it does first.

Loading what drives actuators takes longer than all else that comes before a reading. So a
command may begin it first of all, before it is known what is to be driven, and hand it to its
`vbraille.engine.host.Host`.
"""

from __future__ import annotations

import gc
import os
import subprocess
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.files import open_memory

if TYPE_CHECKING:
    from collections.abc import Sequence


@dataclass(slots=True)
class Spawned:
    """A host process that waits to be told what to drive.

    Parameters
    ----------
    process
        The process, which is told by its standard input.
    descriptor
        Descriptor of the memory that it is to share, which is empty as yet.

    Attributes
    ----------
    taken : bool
        Whether a host has it, which then ends it.
    """

    process: subprocess.Popen[bytes]
    descriptor: int
    taken: bool = False

    def end(self) -> None:
        """End the process if it was told nothing; further calls do nothing."""
        if self.taken:
            return
        self.taken = True
        for pipe in (self.process.stdin, self.process.stdout):
            assert pipe is not None
            pipe.close()
        os.close(self.descriptor)
        self.process.kill()
        self.process.wait()


def spawn(pass_fds: Sequence[int] = ()) -> Spawned:
    """Begin a host process; the system ends it with the thread that calls this.

    Parameters
    ----------
    pass_fds
        Descriptors that the process inherits, for its device.
    """
    descriptor = open_memory("vbraille", 0)
    process = subprocess.Popen(
        [sys.executable, "-m", "vbraille.engine.spawning", str(descriptor), str(os.getpid())],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        pass_fds=(descriptor, *pass_fds),
    )
    return Spawned(process, descriptor)


def _main() -> int:
    """Run as the host process."""
    # All that it loads stays; looking through that again and again takes a sixth of the time.
    gc.disable()
    from vbraille.engine.hostprocess import main

    return main()


if __name__ == "__main__":
    sys.exit(_main())
