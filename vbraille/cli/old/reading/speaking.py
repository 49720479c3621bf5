"""The process that speaks, through Speech Dispatcher by its protocol (SSIP)."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Final

from vbraille.cli.old.reading.speech import Spoken
from vbraille.errors import VbrailleError
from vbraille.wording import printable
from vbraille.workers import begin

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.workers import Incoming

_ANSWER_S: Final = 5.0
_SPAWN_S: Final = 10.0
_MOST_ANSWER: Final = 1 << 16


class SpeechError(VbrailleError):
    """There is no speech; the message says why."""


class SpeechServer:
    """A connection to Speech Dispatcher, which is started if it does not run.

    Parameters
    ----------
    language
        Language that is spoken, as a tag such as "fr".

    Raises
    ------
    SpeechError
        If there is no server, and none can be started.
    """

    def __init__(self, language: str) -> None:
        self._socket = _connected()
        self._heard = b""
        try:
            self._do(f"SET SELF CLIENT_NAME {_user()}:vbraille:reading")
            with suppress(SpeechError):  # a server that does not know it speaks as it is set up
                self._do(f"SET SELF LANGUAGE {printable(language)}")
            # Of the priority "text", as the lines of a book are: alarms may interrupt it.
            self._do("SET SELF PRIORITY TEXT")
        except SpeechError:
            self._socket.close()
            raise

    def say(self, sentence: str) -> None:
        """Say a sentence after those before it.

        Raises
        ------
        SpeechError
            If the server does not take it, or is gone.
        """
        self._do("SPEAK")
        # A dot at the beginning would end the text.
        self._do(f"{'.' if sentence.startswith('.') else ''}{sentence}\r\n.")

    def hush(self) -> None:
        """Say no more of what was given so far.

        Raises
        ------
        SpeechError
            If the server does not take it, or is gone.
        """
        self._do("CANCEL SELF")

    def close(self) -> None:
        """Leave the server, which says what it was given."""
        with suppress(SpeechError):
            self._do("QUIT")
        self._socket.close()

    def _do(self, command: str) -> None:
        """Send a command, and wait for its answer."""
        try:
            self._socket.sendall(command.encode() + b"\r\n")
            code, text = self._answer()
        except OSError as error:
            raise SpeechError(f"the speech server is gone ({error})") from None
        if not code.startswith("2"):
            raise SpeechError(f"the speech server does not take that ({code} {text})")

    def _answer(self) -> tuple[str, str]:
        """Code and text of the last line of an answer; those before it have a hyphen."""
        while True:
            line, ends, rest = self._heard.partition(b"\r\n")
            if not ends:
                more = self._socket.recv(4096)
                if not more or len(self._heard) > _MOST_ANSWER:
                    raise ConnectionResetError("it has closed the connection")
                self._heard += more
                continue
            self._heard = rest
            said = line.decode("utf-8", "replace")
            if said[3:4] != "-":
                return said[:3], said[4:]


def address() -> tuple[str, str]:
    """Kind and place of the server's socket, by the environment: ("unix_socket", PATH) usually."""
    given = os.environ.get("SPEECHD_ADDRESS", "")
    kind, _, place = given.partition(":")
    if kind == "inet_socket":
        return kind, place or "localhost:6560"
    if kind == "unix_socket" and place:
        return kind, place
    runtime = os.environ.get("XDG_RUNTIME_DIR") or str(Path("~/.cache").expanduser())
    return "unix_socket", f"{runtime}/speech-dispatcher/speechd.sock"


def _connected() -> socket.socket:
    """Open a socket to the server; start the server if none answers there."""
    try:
        return _connect()
    except OSError as error:
        reason = error
    kind, place = address()
    if kind == "unix_socket":
        spawn = ["speech-dispatcher", "-a", "-c", kind, "-S", place]  # spawn, method, socket
        try:
            subprocess.run(
                spawn,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                timeout=_SPAWN_S,
                check=False,
            )
            return _connect()
        except FileNotFoundError as error:
            if error.filename == spawn[0]:
                raise SpeechError("speech-dispatcher is not installed") from None
            reason = error
        except (OSError, subprocess.TimeoutExpired) as error:
            reason = error
    why = reason.strerror if isinstance(reason, OSError) and reason.strerror else str(reason)
    raise SpeechError(f"no speech server answers at {place} ({why})")


def _connect() -> socket.socket:
    kind, place = address()
    if kind == "inet_socket":
        host, _, port = place.rpartition(":")
        return socket.create_connection((host, int(port)), _ANSWER_S)
    made = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        made.settimeout(_ANSWER_S)
        made.connect(place)
    except OSError:
        made.close()
        raise
    return made


def _user() -> str:
    """Name of the user, as far as it is a word."""
    name = os.environ.get("USER", "")
    return name if name.isalnum() else "user"


def newest(sentences: Iterable[Spoken]) -> list[Spoken]:
    """Sentences from the last on that takes the place of those before it."""
    kept: list[Spoken] = []
    for sentence in sentences:
        if sentence.instead:
            kept.clear()
        kept.append(sentence)
    return kept


def speak(orders: Incoming[Spoken], language: str) -> None:
    """Say what comes until it ends.

    Parameters
    ----------
    orders
        Sentences that come.
    language
        Language that is spoken, as a tag.

    Raises
    ------
    SpeechError
        If there is no speech.
    """
    server = SpeechServer(language)
    while not orders.ended:
        orders.wait()
        sentences = newest(orders.take())  # of several the newest are what is true
        try:
            _say(server, sentences)
        except SpeechError:  # the server may have been started anew; if not, that is the end
            server.close()
            server = SpeechServer(language)
            _say(server, sentences)
    server.close()


def _say(server: SpeechServer, sentences: list[Spoken]) -> None:
    for sentence in sentences:
        if sentence.instead:
            server.hush()
        if sentence.text.strip():
            server.say(sentence.text)


def main() -> int:
    """Speak until there is no more to say, or no speech."""
    try:
        speak(begin(Spoken)[0], sys.argv[2])
    except SpeechError as error:
        with suppress(OSError):
            print(f"speech: {error}; reading goes on without it", file=sys.stderr, flush=True)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
