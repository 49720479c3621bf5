"""What is spoken, at a small speech server on a real socket."""

import os
import threading
from contextlib import closing
from itertools import count

import pytest

from tests.reading.ssipserver import SsipServer
from vbraille.reading.speaking import SpeechError, SpeechServer, address, newest, speak
from vbraille.reading.speech import Speech, Spoken
from vbraille.workers import Incoming, Outgoing


@pytest.fixture
def at(tmp_path, monkeypatch):
    """Path of the socket where the speech server is looked for; none can be started there."""
    path = tmp_path / "speechd.sock"
    monkeypatch.setenv("SPEECHD_ADDRESS", f"unix_socket:{path}")
    monkeypatch.setenv("PATH", str(tmp_path))
    return path


def test_a_sentence_takes_the_place_of_the_one_before_unless_both_are_one_answer(at):
    now_s = iter((0.0, 10.0, 10.04, 10.08, 20.0)).__next__
    with SsipServer(at) as server, closing(Speech("fr", now_s)) as speech:
        for sentence in ("line: 1", "up: back", ".dots", "a\x07b", "texture: 0.4"):
            speech.say(sentence)
            server.until(lambda it, wanted=sentence[-1]: it.said and it.said[-1][-1] == wanted)
        speech.close()
        server.until(lambda it: it.done[-1] == ("QUIT", ""))
        assert server.done == [
            ("SET SELF CLIENT_NAME " + server.done[0][0].split()[-1], ""),
            ("SET SELF LANGUAGE fr", ""),
            ("SET SELF PRIORITY TEXT", ""),
            ("hush", ""),
            ("say", "line: 1"),
            ("hush", ""),
            ("say", "up: back"),
            ("say", ".dots"),
            ("say", "a<bell>b"),
            ("hush", ""),
            ("say", "texture: 0.4"),
            ("QUIT", ""),
        ]


def test_a_server_that_stops_keeps_nobody_and_says_the_newest_when_it_goes_on(at):
    with SsipServer(at) as server, closing(Speech("en", count().__next__)) as speech:
        server.goes_on.clear()
        speech.say("first")
        assert server.speaking.wait(30.0)
        for number in range(500):  # more than a pipe holds
            speech.say(f"{number} " + "x" * 500)
        server.goes_on.set()
        server.until(lambda it: len(it.said) > 1)
        speech.say("last")
        server.until(lambda it: it.said[-1] == "last")
        assert len(server.said) < 10


def test_what_was_said_last_is_spoken_though_the_reading_ends_with_it(at):
    with SsipServer(at) as server:
        with closing(Speech("en", count().__next__)) as speech:
            server.until(lambda it: it.done and it.done[-1] == ("SET SELF PRIORITY TEXT", ""))
            speech.say("summary: lines 3")
        assert server.said == ["summary: lines 3"]


def test_a_long_sentence_is_said_whole(at):
    with SsipServer(at) as server:
        sentence = "".join(chr(0x4E00 + number) for number in range(2000))
        with closing(Speech("zh")) as speech:
            speech.say(sentence)
            server.until(lambda it: len("".join(it.said)) == len(sentence))
        assert "".join(server.said) == sentence


@pytest.mark.usefixtures("at")
def test_without_a_server_that_is_said_once_and_nothing_else_happens(capfd):
    with closing(Speech("en", count().__next__)) as speech:
        speech._worker.process.wait(30.0)
        for _ in range(3):
            speech.say("line: 1")
    assert capfd.readouterr() == (
        "",
        "speech: speech-dispatcher is not installed; reading goes on without it\n",
    )


@pytest.mark.usefixtures("at")
def test_a_server_that_cannot_be_started_is_named(tmp_path):
    spawner = tmp_path / "speech-dispatcher"
    spawner.write_text("#!/bin/false\n")
    spawner.chmod(0o755)
    with pytest.raises(SpeechError, match=r"no speech server answers at .*speechd\.sock \(No such"):
        SpeechServer("en")


def test_a_server_that_does_not_run_is_started(at, tmp_path):
    """As Debian's is, which goes to the background once its socket is there."""
    spawner = tmp_path / "speech-dispatcher"
    spawner.write_text(f'#!/bin/sh\necho "$@" > {tmp_path}/asked\n/bin/mv {at}.later {at}\n')
    spawner.chmod(0o755)
    with SsipServer(f"{at}.later"):
        SpeechServer("en").close()
    asked = (tmp_path / "asked").read_text()
    assert asked == f"-a -c unix_socket -S {at}\n"


def test_a_server_without_the_language_speaks_as_it_can(at):
    with SsipServer(at, refuses=("SET SELF LANGUAGE",)) as server:
        speaker = SpeechServer("tlh")
        speaker.say("Qapla")
        speaker.close()
        assert server.said == ["Qapla"]


def test_a_server_that_takes_nothing_is_told_of_in_a_sentence(at):
    with SsipServer(at, refuses=("SET SELF CLIENT",)), pytest.raises(SpeechError, match="409 ERR"):
        SpeechServer("en")


def test_a_server_that_was_started_anew_goes_on(at):
    read, write = os.pipe()
    with SsipServer(at) as server, os.fdopen(write, "wb", buffering=0) as orders:
        sent = Outgoing(write)
        sent.put(Spoken("one", instead=True))
        speaker = threading.Thread(target=speak, args=(Incoming(read, Spoken), "en"))
        speaker.start()
        server.until(lambda it: it.said == ["one"])
        server.hang_up()
        sent.put(Spoken("two", instead=True))
        server.until(lambda it: it.said[-1] == "two")
        orders.close()
        speaker.join()
    os.close(read)


def test_of_what_waits_only_the_newest_is_said():
    a, b, c, d, e, f = (Spoken(text, text in "bd") for text in "abcdef")
    assert newest([a, b, c, d, e, f]) == [d, e, f]
    assert newest([a, c]) == [a, c]


@pytest.mark.parametrize(
    ("given", "found"),
    [
        ("unix_socket:/run/here", ("unix_socket", "/run/here")),
        ("inet_socket:pc:6561", ("inet_socket", "pc:6561")),
        ("inet_socket:", ("inet_socket", "localhost:6560")),
        ("", ("unix_socket", "/run/user/1/speech-dispatcher/speechd.sock")),
    ],
)
def test_where_the_server_is(given, found, monkeypatch):
    monkeypatch.setenv("SPEECHD_ADDRESS", given)
    monkeypatch.setenv("XDG_RUNTIME_DIR", "/run/user/1")
    assert address() == found
