"""A braille display at a pseudo-terminal, which is plugged in and taken away."""

import array
import fcntl
import os
import pty
import select
import termios
import threading
import time
import tty

READ_WITHIN_S = 1.0


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
        self._forgotten = threading.Event()
        self._end = self._thread = None

    def plug(self):
        """Plug it in."""
        self._master, self._port = pty.openpty()
        tty.setraw(self._master)
        tty.setraw(self._port)
        self.link.unlink(missing_ok=True)
        self.link.symlink_to(os.ttyname(self._port))
        self._usual = termios.tcgetattr(self._port)
        stop, self._end = os.pipe()
        self._thread = threading.Thread(target=self._serve, args=(stop,))
        self._thread.start()

    def forget(self):
        """Have the port be as if it had never been opened, and forget a message begun.

        A real port is so after its last user's end. A pseudo-terminal that this end holds open
        keeps the settings of a user who was killed; and where they ask for parity, as it has none,
        it refuses the same settings a second time.
        """
        if self._end is None:
            return
        self._forgotten.clear()
        os.write(self._end, b"f")
        self._forgotten.wait()
        termios.tcsetattr(self._port, termios.TCSAFLUSH, self._usual)

    def unplug(self):
        """Take it away, once what it has said was read.

        A BRLTTY whose display is gone before it has read that its cells were taken waits for that
        again and again, and never finds out.
        """
        if self._end is None:
            return
        os.write(self._end, b"x")
        self._thread.join()
        end_s = time.monotonic() + READ_WITHIN_S  # a driver that has ended reads nothing
        while self._unread() and time.monotonic() < end_s:
            time.sleep(0.001)
        self.link.unlink()
        for descriptor in (self._master, self._port, self._end):
            os.close(descriptor)
        self._end = None

    def _unread(self):
        """Count the bytes that the display has said and its driver has not read."""
        count = array.array("i", [0])
        fcntl.ioctl(self._port, termios.FIONREAD, count)
        return count[0]

    def _serve(self, stop):
        begun = b""
        while True:
            ready = select.select([self._master, stop], [], [])[0]
            if self._master in ready:
                begun = self._answer(begun + os.read(self._master, 4096))
            elif os.read(stop, 1) == b"f":
                begun = b""
                self._forgotten.set()
            else:
                os.close(stop)
                return

    def _answer(self, told):
        """Answer what the display was told, and give what of it is not complete."""
        raise NotImplementedError
