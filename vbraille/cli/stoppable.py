"""The keys of whoever is at a device, where the process may be stopped for a while."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Self

from vbraille.engine.suspending import Suspension

if TYPE_CHECKING:
    from vbraille.reading.keyboard import Keyboard

POLL_S: Final = 0.02  # for which a loop waits for a key
STOPPED: Final = "stopped: the array rests; fg goes on"


class StoppableKeyboard(Suspension):
    """A keyboard that the shell has back while the process is stopped. A context manager.

    It is for a loop that looks at `asked` before it takes keys: if that is true, the loop brings
    the array to rest, and then calls `stop`.

    Parameters
    ----------
    keyboard
        The keyboard; its keys are taken one at a time once this is entered.
    """

    def __init__(self, keyboard: Keyboard) -> None:
        super().__init__()
        self._keyboard = keyboard

    @property
    def attached(self) -> bool:
        """Whether there is a terminal to type at."""
        return self._keyboard.attached

    def pressed(self, wait_s: float = 0.0) -> list[str]:
        """Keys typed since the last call; see `Keyboard.pressed`."""
        if self.continued:
            self.continued = False
            self._keyboard.take()  # the shell has had the terminal
        return self._keyboard.pressed(wait_s)

    def stop(self) -> None:
        """Give the terminal back and stop the process; this returns when both are to go on."""
        self._keyboard.release()
        super().stop()
        self._keyboard.take()

    def __enter__(self) -> Self:
        super().__enter__()
        self._keyboard.take()
        return self
