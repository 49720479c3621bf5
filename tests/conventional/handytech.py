"""A braille display of Handy Tech at a pseudo-terminal, and the BRLTTY that drives it.

Both are real parts but for the display's pins: BRLTTY's own driver speaks to this end of the port.
"""

import os
import shutil
import socket
import subprocess
import time

import pytest

from tests.conventional.plugged import PluggedDisplay
from vbraille.conventional.display import load_brlapi
from vbraille.errors import InputError

PATIENCE_S = 30.0
STATUS = 4  # cells that stand before the text
MODELS = {20: 0x80, 40: 0x89, 80: 0x88}  # what the Modular with so many cells calls itself
RELEASED = 0x80
HELD_S = 0.08  # a shorter press is none
FWINLT, FWINRT, LNDN, HOME = 0x04, 0x08, 0x13, 0x03  # keys, by what BRLTTY makes of them
ROUTE_0 = 0x20  # the routing key of the first cell
_PORTS = range(4101, 4101 + 900)  # at which BRLTTY can listen


def missing():
    """Why there is no BRLTTY to be tried; empty if there is one."""
    if shutil.which("brltty") is None:
        return "brltty is not installed; `make test` installs it"
    try:
        load_brlapi()
    except InputError as error:
        return str(error)
    return ""


needs_brltty = pytest.mark.skipif(bool(missing()), reason=missing())


class HandyTech(PluggedDisplay):
    """The display.

    Parameters
    ----------
    link
        Path at which BRLTTY finds the port.
    cells
        Number of its cells.
    """

    def __init__(self, link, cells=40):
        super().__init__(link)
        self.shown = []  # (time by the monotonic clock in ns, cells) of each change, in order
        self.plug(cells)

    def plug(self, cells):
        """Plug a display with so many cells in."""
        self.cells = cells
        super().plug()

    def press(self, key):
        """Press a key, and let go of it."""
        os.write(self._master, bytes([key]))
        time.sleep(HELD_S)
        os.write(self._master, bytes([key | RELEASED]))

    @property
    def standing(self):
        """Cells that stand on it now."""
        with self._changed:
            return self.shown[-1][1] if self.shown else b""

    def wait(self, cells):
        """Wait until these cells stand on it, followed by blank ones; when they came, in ns."""
        wanted = bytes(cells).ljust(self.cells, b"\0")
        with self._changed:
            came = self._changed.wait_for(
                lambda: self.shown and self.shown[-1][1] == wanted, PATIENCE_S
            )
            assert came, (wanted, self.shown[-3:])
            return self.shown[-1][0]

    def _answer(self, told):
        """Answer what BRLTTY has told, and give what of it is not complete."""
        whole = 1 + STATUS + self.cells
        while told:
            if told[0] == 0xFF:  # who are you?
                os.write(self._master, bytes([0xFE, MODELS[self.cells]]))
                told = told[1:]
            elif told[0] == 0x01:  # cells
                if len(told) < whole:
                    break
                with self._changed:
                    self.shown.append((time.monotonic_ns(), told[1 + STATUS : whole]))
                    self._changed.notify_all()
                os.write(self._master, b"\x7e")  # taken
                told = told[whole:]
            else:
                told = told[1:]
        return told


class Brltty:
    """BRLTTY with a display of Handy Tech. A context manager.

    Parameters
    ----------
    folder
        Directory for its files.
    driver
        Driver of the display; "no" for none.
    auth
        What it asks for from those who want the display.
    """

    def __init__(self, folder, *, cells=40, driver="ht", auth="none"):
        self._folder = folder
        self._port = folder / "port"
        self._driver = driver
        self._auth = auth
        self.display = HandyTech(self._port, cells)
        self.number = _free() - _PORTS[0]
        self.host = f"127.0.0.1:{self.number}"
        self.process = None
        self.start()

    def start(self):
        """Start it."""
        api = f"Auth={self._auth},Host={self.host}"
        file = self._folder / "brltty.conf"
        file.write_text(
            f"braille-driver {self._driver}\nbraille-device serial:{self._port}\n"
            f"screen-driver no\nspeech-driver no\napi-parameters {api}\n"
        )
        files = (("f", file.name), ("U", "updatable"), ("W", "writable"), ("P", "pid"))
        where = [f"-{flag}{self._folder / name}" for flag, name in files]
        with (self._folder / "brltty.log").open("ab") as log:
            self.process = subprocess.Popen(
                ["brltty", "-n", "-e", "-q", *where, "-A", api], stdout=log, stderr=log
            )

    def stop(self):
        """End it."""
        self.process.terminate()
        try:
            self.process.wait(5)
        except subprocess.TimeoutExpired:
            self.process.kill()  # it may wait for a thread of its own for ever
            self.process.wait()
        self.display.forget()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()
        self.display.unplug()


def _free():
    """Find a port of those at which BRLTTY can listen, at which no process does."""
    start = os.getpid() * 7 % len(_PORTS)
    for port in (*_PORTS[start:], *_PORTS[:start]):
        with socket.socket() as tried:
            try:
                tried.bind(("127.0.0.1", port))
            except OSError:
                continue
            return port
    raise OSError("there is no free port")


def until(found, patience_s=PATIENCE_S):
    """Ask again and again until there is an answer, and give it."""
    end_s = time.monotonic() + patience_s
    while time.monotonic() < end_s:
        if answer := found():
            return answer
        time.sleep(0.005)
    raise AssertionError("nothing came")
