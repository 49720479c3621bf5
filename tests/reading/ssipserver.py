"""A small speech server at a Unix socket, which writes down what it is told."""

import socket
import threading
from contextlib import suppress


class SsipServer:
    """A speech server for as long as its block lasts.

    Parameters
    ----------
    path
        Path of the socket.
    refuses
        Commands that it does not take.
    """

    def __init__(self, path, refuses=()):
        self.done = []  # ("say", text), ("hush", ""), ("SET SELF ...", "") in order
        self.goes_on = threading.Event()  # it answers to SPEAK only then
        self.goes_on.set()
        self.speaking = threading.Event()  # a test waits for it to answer to SPEAK
        self._refuses = refuses
        self._changed = threading.Condition()
        self._listener = socket.socket(socket.AF_UNIX)
        self._listener.bind(str(path))
        self._listener.listen()
        self._open = []
        self._threads = [threading.Thread(target=self._accept)]
        self._threads[0].start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()
        self.goes_on.set()
        self.hang_up()
        for thread in self._threads:
            thread.join()

    def hang_up(self):
        """Leave everybody who is connected."""
        for connection in list(self._open):  # not those that come back meanwhile
            with suppress(OSError):
                connection.shutdown(socket.SHUT_RDWR)

    @property
    def said(self):
        return [text for what, text in self.done if what == "say"]

    def until(self, enough):
        """Wait until what was done is enough."""
        with self._changed:
            assert self._changed.wait_for(lambda: enough(self), 30.0), self.done

    def _accept(self):
        with suppress(OSError):
            while True:
                connection, _ = self._listener.accept()
                self._open.append(connection)
                thread = threading.Thread(target=self._serve, args=(connection,))
                thread.start()
                self._threads.append(thread)

    def _serve(self, connection):
        lines = connection.makefile("rwb")
        with suppress(OSError), connection, lines:
            while line := lines.readline():
                for answer in self._answers(line.decode().rstrip("\r\n"), lines):
                    lines.write(f"{answer}\r\n".encode())
                    lines.flush()

    def _answers(self, command, lines):
        if command.startswith(self._refuses):
            yield "409 ERR RATE TOO HIGH"
        elif command == "SPEAK":
            self.speaking.set()
            self.goes_on.wait()
            yield "230 OK RECEIVING DATA"
            text = []
            while (line := lines.readline().decode().rstrip("\r\n")) != ".":
                text.append(line.removeprefix("."))
            self._note("say", "\n".join(text))
            yield "225-21"
            yield "225 OK MESSAGE QUEUED"
        elif command == "CANCEL SELF":
            self._note("hush", "")
            yield "210 OK CANCELED"
        elif command == "HISTORY GET CLIENT_ID":
            yield "245-1"
            yield "245 OK CLIENT ID SENT"
        else:
            self._note(command, "")
            yield "201 OK"

    def _note(self, what, text):
        with self._changed:
            self.done.append((what, text))
            self._changed.notify_all()
