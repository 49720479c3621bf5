"""A fork that stands for a program is what a new process of it would be."""

import os
import signal
from pathlib import Path

import pytest

from tests import forking
from tests.cli import program

ALIKE = ("PPid", "NSsid", "SigIgn", "SigBlk", "Umask", "NoNewPrivs")


def seen(monkeypatch, used, folder, **options):
    """State of a waiting program as the system tells it, and the way it ends when told to."""
    monkeypatch.setattr(forking.nursery, "used", used)
    process = program.start("simulate", "serial", cwd=folder, **options)
    process.stdout.readline()
    own = Path(f"/proc/{process.pid}")
    status = dict(line.split(":\t", 1) for line in (own / "status").read_text().splitlines())
    told = {name: status[name] for name in ALIKE if name != "NSsid"}
    told["leads"] = status["NSsid"] == status["NSpid"]
    told["limits"] = (own / "limits").read_text()
    told["folder"] = (own / "cwd").readlink()
    told["streams"] = [str((own / f"fd/{number}").readlink())[:5] for number in range(3)]
    told["files"] = sorted(int(file.name) for file in (own / "fd").iterdir() if len(file.name) < 3)
    told["children"] = forking.children(process.pid)
    process.send_signal(signal.SIGTERM)
    told["said"] = process.communicate(timeout=program.PATIENCE_S)[1]
    told["code"] = process.returncode
    return told


@pytest.mark.parametrize("leads", [False, True])
def test_the_system_sees_no_difference(tmp_path, monkeypatch, leads):
    before = os.umask(0o027)
    try:
        new, fork = (
            seen(monkeypatch, used, tmp_path, start_new_session=leads) for used in (False, True)
        )
    finally:
        os.umask(before)
    assert fork == new
