"""Outputs: where sentences are said, and where what is under the hand is shown.

An output has two methods, ``say`` and ``show``. One that may have to wait works in a thread, behind
`Behind`, and never holds the loop.
"""

from __future__ import annotations

import importlib
import queue
import sys
import threading
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Any

from vbraille.wording import printable

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

ECHOES = ("none", "text", "cells", "both")
_CELLS = "cells: "  # begins a sentence of braille signs, which no voice can say


class Cue(Enum):
    """A signal that comes with a sentence."""

    NONE = "none"
    LINE_END = "end of the line"
    PAGE_END = "end of the page"
    LIMIT = "limit"
    NOT_FOUND = "not found"


@dataclass(frozen=True, slots=True)
class _Tone:
    frequency_hz: float
    duration_ms: float = 60.0


# Tones of each cue; another number of tones each, for those who hear no pitch.
MELODIES = {
    Cue.LINE_END: (_Tone(880),),
    Cue.PAGE_END: (_Tone(660), _Tone(880)),
    Cue.LIMIT: (_Tone(220), _Tone(220), _Tone(220)),
    Cue.NOT_FOUND: (_Tone(440), _Tone(370), _Tone(311), _Tone(262, 120)),
}


class Output:
    """Place where a reading is heard, seen or felt."""

    def say(self, sentence: str, cue: Cue = Cue.NONE) -> None:
        """Say a sentence, with a cue or without; an empty one is a cue alone."""

    def show(self, what: Any) -> None:
        """Show what has come under the hand, an `explored.Explored`."""

    def close(self) -> None:
        """End; what was said before is finished."""


class Console(Output):
    """Sentences on standard output, and lines if they are to be echoed.

    Parameters
    ----------
    echo
        What is printed of each line, one of `ECHOES`.
    """

    def __init__(self, echo: str = "none") -> None:
        self._echo = echo
        self._clear = "\r\x1b[K" if sys.stdout.isatty() else ""

    def say(self, sentence: str, cue: Cue = Cue.NONE) -> None:  # noqa: ARG002 - cues are heard
        """Print a sentence, control characters by their names."""
        if sentence:
            print(f"{self._clear}{printable(sentence)}", flush=True)

    def show(self, what: Any) -> None:
        """Print a line, as the echo says."""
        for sentence in what.echoed(self._echo):
            self.say(sentence)

    def typing(self, question: str, text: str) -> None:
        """Show a line that is being typed; at a terminal only."""
        if self._clear:
            print(f"{self._clear}{printable(question)}: {printable(text)}", end="", flush=True)

    def end_typing(self) -> None:
        """Leave the line that was typed as it stands."""
        if self._clear:
            print(flush=True)


class Signals(Output):
    """Cues as tones of the machine's audio output or as the terminal's bell; sounds of pictures.

    Parameters
    ----------
    tones
        Whether cues are tones; where there is no audio output, they are bells.
    """

    def __init__(self, *, tones: bool) -> None:
        self._player: Any = None
        self._tones = tones
        if tones:
            self._open()

    def _open(self) -> None:
        from vbraille.sounds import Tones

        try:
            self._player = Tones()
        except OSError:  # which is no fault: bells ring
            self._tones = False

    def say(self, sentence: str, cue: Cue = Cue.NONE) -> None:  # noqa: ARG002 - others say it
        """Give a cue."""
        if cue in MELODIES and self._tones:
            self._player.play(*MELODIES[cue])
        elif cue in MELODIES and sys.stderr.isatty():
            print("\a" * len(MELODIES[cue]), end="", file=sys.stderr, flush=True)

    def sound(self, path: Path) -> None:
        """Play a file of sound, if there is an audio output."""
        if self._player is None:
            self._open()
        if self._player is not None:
            self._player.play_file(path)


class Speech(Output):
    """Sentences and lines spoken by Speech Dispatcher, through the system's python3-speechd.

    New sentences take the place of those being spoken, unless they came together.

    Parameters
    ----------
    language
        Tag of the language that is spoken.

    Raises
    ------
    OSError
        If there is no speech on this machine.
    """

    def __init__(self, language: str = "en") -> None:
        speechd = system_module("speechd")
        try:
            self._client = speechd.SSIPClient("vbraille")
            self._client.set_language(language.split("-")[0].lower())
        except Exception as error:  # speechd has exceptions of several bases
            raise OSError(" ".join(str(error).split())) from None

    def say(self, sentence: str, cue: Cue = Cue.NONE) -> None:  # noqa: ARG002 - cues are heard
        """Speak a sentence."""
        if sentence and not sentence.startswith(_CELLS):
            self._client.speak(sentence)

    def interrupt(self) -> None:
        """Stop what is being spoken, for something newer."""
        self._client.cancel()

    def close(self) -> None:
        """End, once all is spoken."""
        self._client.close()


def system_module(name: str) -> Any:
    """Load a module that Debian's package python3-NAME brings, and no registry has.

    Raises
    ------
    OSError
        If it is not installed.
    """
    folder = "/usr/lib/python3/dist-packages"
    sys.path.append(folder)
    try:
        return importlib.import_module(name)
    except ImportError:
        raise OSError(f"it needs Debian's package python3-{name}") from None
    finally:
        sys.path.remove(folder)


class Behind(Output):
    """An output in a thread of its own, opened there; one that fails says so once, and is silent.

    Parameters
    ----------
    name
        What it is called in that sentence.
    open_output
        Function that opens it.
    say
        Function that is called with the sentence.
    """

    _APART_S = 0.1  # sentences that come within that are said together

    def __init__(
        self, name: str, open_output: Callable[[], Any], say: Callable[[str], None]
    ) -> None:
        self._name, self._open, self._say = name, open_output, say
        self._waiting: queue.SimpleQueue[Callable[[Any], None] | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def say(self, sentence: str, cue: Cue = Cue.NONE) -> None:
        """Have a sentence said."""
        self._waiting.put(lambda output: output.say(sentence, cue))

    def show(self, what: Any) -> None:
        """Have the text under the hand said, as it is now."""
        self.say(what.text)

    def sound(self, path: Path) -> None:
        """Have a file of sound played."""
        self._waiting.put(lambda output: output.sound(path))

    def close(self) -> None:
        """End; this waits a second at most for what was said before."""
        self._waiting.put(None)
        self._thread.join(1.0)

    def _run(self) -> None:
        try:
            output = self._open()
            while (first := self._waiting.get()) is not None:
                if hasattr(output, "interrupt"):
                    output.interrupt()
                task: Callable[[Any], None] | None = first
                while task is not None:
                    task(output)
                    task = self._next()
            output.close()
        except OSError as error:
            self._say(f"no {self._name}: {error}")
        except Exception as error:  # as speechd's own, when its server ends
            self._say(f"no {self._name}: {type(error).__name__}: {error}")

    def _next(self) -> Callable[[Any], None] | None:
        """Take the next task of a moment; None without one, or at the end, which is put back."""
        try:
            task = self._waiting.get(timeout=self._APART_S)
        except queue.Empty:
            return None
        if task is None:
            self._waiting.put(None)
        return task
