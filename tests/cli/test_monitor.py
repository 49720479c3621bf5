"""``vbraille monitor``: a recording played back to a page, and what cannot be is one sentence."""

import json
import re
import signal
import socket
import subprocess
import sys

import numpy as np
import pytest
from websockets.sync.client import connect

from tests.cli import program
from tests.live.headers import FRAME
from tests.playback.written import recorded
from tests.sessions.written import written
from tests.tiers import heavy

RECORDING = recorded()
SESSION = written("stopped")


def refused(said, code=2):
    assert (said.code, said.out) == (code, "")
    (sentence,) = said.err.splitlines()
    return sentence.removeprefix("vbraille: ")


def talk(port, *requests):
    """What the server answers to a page."""
    answers = []
    origin = f"http://127.0.0.1:{port}"
    with connect(f"ws://127.0.0.1:{port}/live", origin=origin, compression=None) as page:
        page.send(json.dumps({"ask": "hello"}))
        answers.append(json.loads(page.recv(60)))
        for request in requests:
            page.send(json.dumps(request))
            while isinstance(answer := page.recv(60), str):
                answers.append(json.loads(answer))
            answers.append(answer)
    return answers


@pytest.mark.parametrize("path", [RECORDING, pytest.param(SESSION, marks=heavy)], ids=["h5", "s"])
def test_a_page_sees_the_recording_until_ctrl_c(path):
    process = program.start("monitor", str(path))
    try:
        said = process.stdout.readline().decode()
        port = re.fullmatch(r"live view: http://127\.0\.0\.1:(\d+)/\n", said)[1]
        welcome, state, frame, drawn = talk(
            int(port),
            {"ask": "next", "at_s": 0.2},
            {"ask": "map", "form": "png", "at_s": 0.2 if path is RECORDING else 1.3},
        )
        process.send_signal(signal.SIGINT)
        assert process.wait(60) == 0
        assert process.stdout.read().decode() == "live view: ended\n"
        assert process.stderr.read().decode().startswith("" if path is RECORDING else "note: ")
    finally:
        process.kill()
        process.wait()
        process.stdout.close()
        process.stderr.close()
    assert welcome["playback"]
    assert not welcome["steers"]
    assert welcome["length_s"] > 0.5
    assert welcome["moments"]
    assert state["tell"] == "state"
    header = np.frombuffer(frame, FRAME, 1)[0]
    assert header["state"] == state["number"]
    assert 0.195 < header["time_s"] <= 0.2
    assert drawn[8:16] == b"\x89PNG\r\n\x1a\n"


def test_what_cannot_be_played_is_said_in_a_sentence(call, tmp_path):
    assert refused(call("monitor")).startswith("nothing is to be played; give a recording or a")
    (tmp_path / "empty").touch()
    for name, said in (("none.h5", "there is no file"), ("empty", f"{tmp_path}/empty is empty")):
        assert refused(call("monitor", tmp_path / name)).startswith(said)
    play = ("monitor", RECORDING)
    assert refused(call(*play, "--port", "70000")).startswith("--port is 70000; it must be")
    assert refused(call(*play, "--host", "192.0.2.1")).startswith("192.0.2.1 is not an address of")
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        said = refused(call(*play, "--port", port))
    assert said == f"port {port} is in use; give --port another, or leave it out"


def test_help_loads_none_of_it():
    code = (
        "import sys; from vbraille.cli.app import main; main(['monitor', '--help']); "
        "print(*sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.splitlines()[-1].split())
    assert "vbraille.config.options" in loaded
    assert not loaded & {"websockets", "PIL", "numpy", "h5py", "vbraille.live.server"}
