"""The live view of a reading, as ``vbraille read`` keeps it up, and of a picture that is felt."""

from __future__ import annotations

from pathlib import PurePath
from typing import TYPE_CHECKING, Self

from vbraille.cli.terminal import say_line
from vbraille.live.monitor import Monitor
from vbraille.reading.commands.paged import obey
from vbraille.reading.viewed import Said, Viewed
from vbraille.simulation.specs import has_hand

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterable

    from vbraille.devices.events import Event
    from vbraille.engine.shared import Extent
    from vbraille.feeling.feeler import Feeler
    from vbraille.feeling.viewed import FeltView
    from vbraille.live.messages import PagePress, Turn
    from vbraille.reading.opened import OpenDevice


class LiveView:
    """The live view of a reading. A context manager; its pages are served while it is open.

    Parameters
    ----------
    arguments
        Options of the command.

    Attributes
    ----------
    pointer : Pointer or None
        Where pages may hold the hand of the device; None if a person moves that.
    """

    def __init__(self, arguments: argparse.Namespace) -> None:
        self.pointer = arguments.pointer if has_hand(arguments.device) else None
        self._monitor = Monitor(host=arguments.host, port=arguments.port, pointer=self.pointer)
        self._said = Said()
        self._device: OpenDevice | None = None
        self._viewed: Viewed | FeltView | None = None

    def say(self, sentence: str) -> None:
        """Print a sentence, and show it on the pages."""
        say_line(sentence)
        self._said.add(sentence)

    def share(self, descriptor: int, extent: Extent) -> None:
        """Give the pages what the engine records; the descriptor may be closed then."""
        self._monitor.share(descriptor, extent)

    def show(self, device: OpenDevice, hand: str) -> None:
        """Show from now on what is read on a device, a simulated one with this hand."""
        source, table = device.reader.layout.book.source, device.reader.layout.book.table
        facts = [] if table is None else [("table", table.name)]
        if self.pointer is not None:
            facts.append(("hand", hand))
        self._device = device
        title = source.title or PurePath(source.name).name
        self._viewed = Viewed(device, title, self._said, facts)
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
        for note in self._monitor.notes():
            say_line(note)
        viewed = self._viewed
        if viewed is None:
            return
        if standing is not None:
            viewed.standing = standing
        viewed.see(events)
        state = viewed.changed()
        if state is not None:
            self._monitor.tell(state)

    def take(self) -> list[PagePress | Turn]:
        """Take what pages have asked for since the last call."""
        return self._monitor.take()

    def obey(self, asked: PagePress | Turn) -> None:
        """Do what a page has asked for."""
        if self._device is not None:
            obey(self._device.reader, asked)

    def __enter__(self) -> Self:
        self._monitor.launch()
        return self

    def __exit__(self, *_: object) -> None:
        self._monitor.close()


class FeltLiveView(LiveView):
    """The live view of a picture that is felt."""

    def feel(self, device: OpenDevice, feeler: Feeler, hand: str) -> None:
        """Show from now on what is felt on a device, a simulated one with this hand."""
        from vbraille.feeling.viewed import FeltView

        facts = [] if self.pointer is None else [("hand", hand)]
        self._viewed = FeltView(device, feeler, self._said, facts)
        self.tell()

    def obey(self, asked: PagePress | Turn) -> None:
        """Pass over what a page asks for: it can be the hand, but nothing can be turned."""
