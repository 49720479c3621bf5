"""What tests of a session's record share."""

import os
from pathlib import Path

import pytest


@pytest.fixture
def synced(monkeypatch):
    """Each fsync as it is done: the name of what is synced, and the sizes of all files beside it.

    A directory, whose names are synced, is called "".
    """
    done, real = [], os.fsync

    def sync(descriptor):
        real(descriptor)
        path = Path(f"/proc/self/fd/{descriptor}").readlink()
        folder = path if path.is_dir() else path.parent
        sizes = {file.name: file.stat().st_size for file in folder.iterdir() if file.is_file()}
        done.append(("" if path.is_dir() else path.name, sizes))

    monkeypatch.setattr(os, "fsync", sync)
    return done
