"""The driver in docs/drivers.md: complete, under 60 lines, and it works as printed."""

import inspect
import re
import socket
import struct
import threading
import types
from pathlib import Path

import numpy as np
import pytest

from vbraille.display import Display, Pose
from vbraille.errors import InputError
from vbraille.testing.conformance import CHECKS

PAGE = Path(__file__).parents[2] / "docs" / "drivers.md"


def printed(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", PAGE.read_text(), re.MULTILINE | re.DOTALL)


class Peer:
    """What answers in the device's place: a state for every frame, and one to begin with."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.frames = []
        self.thread = threading.Thread(target=self._answer)

    def _answer(self):
        while True:
            frame, host = self.socket.recvfrom(4096)
            if not frame:
                return
            self.frames.append(frame)
            count = 20_000 - abs(100 * len(self.frames) % 40_000 - 20_000)  # a carriage that sways
            state = struct.pack("<QI", 1000 * len(self.frames), count)
            self.socket.sendto(state, host)

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.socket.sendto(b"", self.socket.getsockname())
        self.thread.join()
        self.socket.close()


@pytest.fixture
def driver():
    module = types.ModuleType("netbox")
    exec(compile(printed("python")[0], str(PAGE), "exec"), module.__dict__)
    return module


@pytest.fixture
def peer():
    with Peer() as peer:
        yield peer


@pytest.fixture
def address(peer):
    return "127.0.0.1:{1}".format(*peer.socket.getsockname())


@pytest.mark.real_time
@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__)
def test_it_conforms(driver, address, check):
    check(lambda: driver.open_netbox(address, None))


@pytest.mark.parametrize(("heading", "kind"), [("`Display`", Display), ("`Pose`", Pose)])
def test_the_page_names_all_fields_in_their_order(heading, kind):
    told = PAGE.read_text().partition(f"### {heading}\n")[2].partition("\n#")[0]
    rows = [row.split("|") for row in told.splitlines() if row.startswith("| `")]
    names = [name for row in rows for name in re.findall(r"`(\w+)`", row[1])]
    assert names == list(inspect.signature(kind).parameters)
    usual = {name: row[3].strip(' `"') for row in rows for name in re.findall(r"`(\w+)`", row[1])}
    for name, parameter in inspect.signature(kind).parameters.items():
        given = "" if parameter.default is inspect.Parameter.empty else str(parameter.default)
        assert usual[name] == given.removesuffix(".0")


def test_it_has_under_60_lines():
    assert len(printed("python")[0].splitlines()) < 60


def test_what_it_sends_and_reads(driver, peer, address):
    with driver.open_netbox(address, None) as device:
        device.write(np.linspace(0, 1, 60).reshape(6, 10))
        sample = None
        while sample is None:
            sample = device.read()
        assert sample.time_ns == 1_000_000
        assert sample.x_mm == pytest.approx(0.5 - 10.8 / 2)
        assert peer.frames[0] == np.rint(np.linspace(0, 255, 60)).astype(np.uint8).tobytes()


def test_an_address_that_is_none(driver):
    with pytest.raises(InputError, match="netbox:HOST:PORT"):
        driver.open_netbox("nowhere", None)


def test_the_entry_point_and_the_checks_are_as_printed(driver, address):
    name, target = re.search(r'^(\w+) = "(.+)"$', printed("toml")[0], re.MULTILINE).groups()
    assert (name, target) == ("netbox", "netbox:open_netbox")
    test = printed("python")[1].replace('"127.0.0.1", 8900', "*ADDRESS")
    host, port = address.split(":")
    scope = {**driver.__dict__, "ADDRESS": (host, int(port))}
    exec(compile(test, str(PAGE), "exec"), scope)
    for check in CHECKS:
        scope["test_netbox"](check)
