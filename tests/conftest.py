"""What all tests share: one seed, and hypothesis without chance or clocks."""

import gc
import os
import signal
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import is_hypothesis_test, settings
from hypothesis.internal.conjecture import providers

from tests import forking, realtime
from tests.tiers import TIER, by_tier

SEED = 20090618
TEXTS = Path(__file__).parent.parent / "texts"


# What changes what the program does, says or finds, or how Python does.
_OWN = ("VBRAILLE_", "SPEECHD_", "SSH_", "LC_", "PYTHON")
_OWN_NAMES = {"LANG", "LANGUAGE", "COLUMNS", "LINES", "DISPLAY", "WAYLAND_DISPLAY", "NO_COLOR"}


def start_alike() -> None:
    """Have tests and what they start see the same, however the tests were started.

    A signal that is ignored here (by nohup, in the background of a shell) would be ignored by every
    process from here on. One that is handled is not: a new program has its default again.
    """
    for name in [*os.environ]:
        if name in _OWN_NAMES or (name.startswith(_OWN) and name != "PYTHONPATH"):
            del os.environ[name]
    # No person's own settings; there is no such file.
    os.environ |= {
        "VBRAILLE_SETTINGS": "/nonexistent/settings.toml",
        "LANG": "C.UTF-8",
        "TERM": "xterm",
    }
    os.umask(0o022)
    signal.pthread_sigmask(signal.SIG_SETMASK, ())
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    python_ignores = {signal.SIGPIPE, signal.SIGXFSZ}  # and gives back to those whom it starts
    for number in signal.valid_signals() - python_ignores:
        if signal.getsignal(number) is signal.SIG_IGN:
            signal.signal(number, lambda *_: None)


start_alike()
forking.begin()

_FOLDER = pytest.StashKey[TemporaryDirectory]()
_places: list[str] = []  # tests that have had places so far

EXAMPLES = by_tier(30, 100, 5000)  # of a law that does not say how many it needs

settings.register_profile(
    "vbraille", derandomize=True, deadline=None, database=None, max_examples=EXAMPLES
)
settings.load_profile("vbraille")
# It would try numbers of our own modules, too: of those that are loaded when a law's turn comes, so
# that what is tried would go by the tests that came before. (And reading them takes seconds.)
providers.is_local_module_file = lambda _: False


def pytest_report_header() -> str:
    return (
        f"tier of the tests: {TIER.name.lower()}; "
        f"seed: {SEED}; hypothesis derives its own from each test"
    )


def pytest_collection(session: pytest.Session) -> None:  # noqa: ARG001 - as hooks are called
    """Look for no garbage among modules and tests: hardly any of it is."""
    gc.disable()


def pytest_collection_finish(session: pytest.Session) -> None:  # noqa: ARG001
    """Look for garbage again, but never among what was collected: it stays to the end."""
    gc.freeze()
    gc.enable()


def pytest_configure(config: pytest.Config) -> None:
    """Make known the marks of tests, and try those of real time again."""
    config.addinivalue_line("markers", "new_processes: programs are new Pythons (tests/forking.py)")
    config.pluginmanager.register(realtime)


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Give each test places of its own, and none that another has kept."""
    forking.nursery.used = item.get_closest_marker("new_processes") is None
    if _FOLDER not in item.config.stash:
        item.config.stash[_FOLDER] = TemporaryDirectory(prefix="vbraille-places-")
    folder = item.config.stash[_FOLDER]
    _places.append(item.nodeid)
    os.environ["VBRAILLE_PLACES"] = f"{folder.name}/{len(_places)}/places.sqlite"


def pytest_unconfigure(config: pytest.Config) -> None:
    """Remove the places of all tests."""
    folder = config.stash.get(_FOLDER, None)
    if folder is not None:
        folder.cleanup()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Leave laws out of coverage: it would double the time of their hundreds of examples."""
    for item in items:
        if is_hypothesis_test(getattr(item, "obj", None)):
            item.add_marker(pytest.mark.no_cover)


@pytest.fixture
def rng() -> np.random.Generator:
    """Random numbers that are the same in every run."""
    return np.random.default_rng(SEED)


@pytest.fixture(scope="session")
def texts() -> Path:
    """The folder of the project's own passages."""
    return TEXTS
