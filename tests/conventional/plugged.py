"""A braille display at a pseudo-terminal, which is plugged in and taken away."""

import os
import pty
import select
import threading
import tty


class PluggedDisplay:
    """A display, at a link to its pseudo-terminal for as long as it is plugged in.

    Parameters
    ----------
    link
        Path at which the port is found.
    """

    def __init__(self, link):
        self.link = link
        self._changed = threading.Condition()
        self._end = self._thread = None

    def plug(self):
        """Plug it in."""
        self._master, self._port = pty.openpty()
        tty.setraw(self._master)
        tty.setraw(self._port)
        self.link.unlink(missing_ok=True)
        self.link.symlink_to(os.ttyname(self._port))
        stop, self._end = os.pipe()
        self._thread = threading.Thread(target=self._serve, args=(stop,))
        self._thread.start()

    def unplug(self):
        """Take it away."""
        if self._end is None:
            return
        os.write(self._end, b"x")
        self._thread.join()
        self.link.unlink()
        for descriptor in (self._master, self._port, self._end):
            os.close(descriptor)
        self._end = None

    def _serve(self, stop):
        begun = b""
        while True:
            ready = select.select([self._master, stop], [], [])[0]
            if stop in ready:
                os.close(stop)
                return
            begun = self._answer(begun + os.read(self._master, 4096))

    def _answer(self, told):
        """Answer what the display was told, and give what of it is not complete."""
        raise NotImplementedError
