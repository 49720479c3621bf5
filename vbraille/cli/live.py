"""The live view of a reading, as ``vbraille read`` keeps it up, and of a picture that is felt."""

from __future__ import annotations

from typing import TYPE_CHECKING, Self

from vbraille.cli.terminal import say_line
from vbraille.live.monitor import Monitor
from vbraille.reading.viewed import Said
from vbraille.simulation.specs import has_hand

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Iterable

    from vbraille.devices.events import Event
    from vbraille.live.messages import PagePress, Turn
    from vbraille.reading.viewed import View


class LiveView:
    """The live view of a reading. A context manager; its pages are served while it is open.

    Parameters
    ----------
    arguments
        Options of the command.

    Attributes
    ----------
    monitor : Monitor
        Process that serves the pages, and takes what they ask for.
    pointer : Pointer or None
        Where pages may hold the hand of the device; None if a person moves that.
    """

    def __init__(self, arguments: argparse.Namespace) -> None:
        self.pointer = arguments.pointer if has_hand(arguments.device) else None
        self.monitor = Monitor(host=arguments.host, port=arguments.port, pointer=self.pointer)
        self._said = Said()
        self._view: View | None = None

    def say(self, sentence: str) -> None:
        """Print a sentence, and show it on the pages."""
        say_line(sentence)
        self._said.add(sentence)

    def show(self, view: Callable[[Said, list[tuple[str, str]]], View], hand: str) -> None:
        """Show something from now on.

        Parameters
        ----------
        view
            Function that makes the view of what was said and of facts.
        hand
            Hand of a simulated device.
        """
        self._view = view(self._said, [] if self.pointer is None else [("hand", hand)])
        self.tell()

    def tell(self, events: Iterable[Event] = (), standing: str | None = None) -> None:
        """Tell the pages what has changed, and print what the live view has to say itself.

        Parameters
        ----------
        events
            What the device has told since the last call.
        standing
            Sentence on why nothing is read; empty if it is again, None if that is as it was.
        """
        for note in self.monitor.notes():
            say_line(note)
        view = self._view
        if view is None:
            return
        if standing is not None:
            view.standing = standing
        view.see(events)
        state = view.changed()
        if state is not None:
            self.monitor.tell(state)

    def obey(self, asked: PagePress | Turn) -> None:
        """Do what a page has asked for."""
        if self._view is not None:
            self._view.obey(asked)

    def __enter__(self) -> Self:
        self.monitor.launch()
        return self

    def __exit__(self, *_: object) -> None:
        self.monitor.close()
