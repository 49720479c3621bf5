"""A Latero on the network: a socket, a clock, a guardian, and a `LateroConversation`."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from vbraille.carriers import latero
from vbraille.carriers.carrier import LATERO, LATERO_ARRAY
from vbraille.devices.base import Device, Particulars
from vbraille.devices.latero.hearing import NAME, STALL_NS, LateroStage
from vbraille.errors import DeviceError

if TYPE_CHECKING:
    import socket
    from collections.abc import Callable, Mapping, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.devices.latero.conversation import LateroConversation
    from vbraille.devices.latero.datagrams import Answer
    from vbraille.devices.latero.guarding import Guarding
    from vbraille.display import Display
    from vbraille.pose import Pose

DISPLAY: Final = replace(LATERO.under(LATERO_ARRAY), name=NAME, shown_near=True)
# A Latero answers in less; where it does not, the answer to the last frame is there.
AHEAD_NS: Final = 300_000
_ROOM_BYTES: Final = 256
# Answers that are taken at a time: those of a stopped client wait in the socket.
_MOST_ANSWERS: Final = 256
_STEP_S: Final = 0.001
_REST_STEPS: Final = 60
_LEAVE_STEPS: Final = 200


class LateroDevice(Device):
    """A Latero that has answered; `openlatero` begins the talk.

    Parameters
    ----------
    line
        Socket that is connected to the Latero, and does not block.
    conversation
        The talk with it, in which it has answered.
    guarding
        The guardian of it, which watches already.
    kept
        Socket that keeps other programs away; it is closed at the end.
    now_ns, pause
        Clock, and function that waits for a number of seconds.
    """

    acknowledges = True
    ahead_ns = AHEAD_NS

    def __init__(
        self,
        line: socket.socket,
        conversation: LateroConversation,
        guarding: Guarding,
        kept: socket.socket,
        now_ns: Callable[[], int] = time.monotonic_ns,
        pause: Callable[[float], None] = time.sleep,
    ) -> None:
        self.conversation = conversation
        self.guarding = guarding
        self._line = line
        self._kept = kept
        self._now_ns = now_ns
        self._pause = pause
        self._room = bytearray(_ROOM_BYTES)
        self._view = memoryview(self._room)
        self._trips = guarding.trips
        self._called_ns = now_ns()
        self._unsent = 0
        self._copy()

    @property
    def display(self) -> Display:
        """The Latero's array, on its carrier."""
        return DISPLAY

    def set_zero(self) -> None:
        """Take the place for the lower left corner with the third arm straight up."""
        self.conversation.set_zero(self._now_ns())
        self._copy()
        self._describe()

    def take_events(self) -> Sequence[Event]:
        """Events since the last call, each kind once a second at most."""
        return self.conversation.take_events(self._now_ns())

    def counts(self) -> Mapping[str, int]:
        """Counts of what went wrong so far, by name."""
        conversation = self.conversation
        numbering = conversation.numbering
        return {
            "frames not sent": self._unsent,
            "requests not answered": numbering.lost,
            "late answers": numbering.late,
            "doubled answers": numbering.doubled,
            "foreign datagrams": conversation.foreign + numbering.unasked,
            "guardian trips": self.guarding.trips,
            "reconnections": conversation.reconnections,
        }

    def read(self) -> Pose | None:
        """Newest sample since the last call, or None; this never waits.

        Raises
        ------
        DeviceError
            If the guardian has ended, without which nobody may read on a Latero.
        """
        now_ns = self._now_ns()
        if not self.guarding.alive:
            raise DeviceError(
                f"the guardian of the {NAME} has ended, and without it nobody may read on it; the "
                f"blades go to rest, so begin again"
            )
        self._mind_stall(now_ns)
        self._hear(now_ns)
        self.conversation.tend(now_ns)
        self._send_due(now_ns)
        self._copy()
        return self.conversation.take_pose()

    def ask(self) -> None:
        """Ask where the array is: the answer to the last frame would be a whole tick old."""
        now_ns = self._now_ns()
        self._mind_stall(now_ns)
        self.conversation.ask(now_ns)
        self._send_due(now_ns)

    def rest(self) -> None:
        """Bring the blades to rest, which takes 20 ms: a frame of rest would be a jump."""
        self.conversation.rest(self._now_ns())
        for _ in range(_REST_STEPS):
            self._step()
            if self.conversation.blades.rests:
                return
            self._pause(_STEP_S)

    def _send(self, frame: NDArray[np.float64]) -> None:
        now_ns = self._now_ns()
        self._mind_stall(now_ns)
        self.conversation.show(frame, now_ns)
        self._send_due(now_ns)
        self.acknowledged_ns = None

    def _mind_stall(self, now_ns: int) -> None:
        """See whether this process was stopped for so long that the guardian may have acted."""
        stopped = now_ns - self._called_ns >= STALL_NS
        self._called_ns = now_ns
        trips = self.guarding.trips
        if trips != self._trips or (stopped and not self.conversation.blades.rests):
            self._trips = trips
            self.guarding.beat(now_ns)
            self.conversation.stall(self.guarding.board.levels, trips, now_ns)

    def _hear(self, now_ns: int) -> None:
        for _ in range(_MOST_ANSWERS):
            try:
                size = self._line.recv_into(self._room)
            except OSError:  # nothing has come, or nobody is there
                return
            self.conversation.hear(self._view[:size], now_ns)
            if self.conversation.numbering.caught_up:  # what may be left is doubled or late
                return

    def _send_due(self, now_ns: int) -> None:
        conversation, board = self.conversation, self.guarding.board
        while (request := conversation.due()) is not None:
            # The guardian knows where the blades are before they are there.
            board.levels[:] = conversation.blades.view
            self.guarding.beat(now_ns)
            try:
                self._line.send(request)
            except OSError:
                self._unsent += 1
                conversation.refused()
                return
            conversation.sent()

    def _copy(self) -> None:
        """Copy the values that `Device` promises from the conversation."""
        conversation = self.conversation
        self.rested = conversation.rested
        self.taking = conversation.taking
        self.placing = conversation.place.placing
        self.acknowledged_ns = conversation.acknowledged_ns
        self.watchdog_trips = self._trips
        if self.particulars is None:
            self._describe()

    def _describe(self) -> None:
        answer = self.conversation.answer
        if answer is not None:
            self.particulars = _particulars(answer, self.conversation.place.offsets)

    def _step(self) -> None:
        now_ns = self._now_ns()
        self._mind_stall(now_ns)
        self._hear(now_ns)
        self.conversation.tend(now_ns)
        self._send_due(now_ns)

    def _release(self) -> None:
        conversation = self.conversation
        try:
            silent = conversation.stage is LateroStage.SILENT
            conversation.leave(self._now_ns())
            for _ in range(_LEAVE_STEPS):
                self._step()
                if conversation.left or (silent and conversation.blades.rests):
                    break
                self._pause(_STEP_S)
        finally:
            self.guarding.close(all_done=conversation.left)
            self._line.close()
            self._kept.close()


def _particulars(answer: Answer, offsets: Sequence[int] | None) -> Particulars:
    """What the Latero's status words say, and where its encoders are at angle 0."""
    where = "its offsets are not known before it is shown its lower left corner"
    if offsets is not None:
        where = f"offsets={','.join(map(str, offsets))}"
    return Particulars(
        firmware=(
            f"controller {_version(answer.controller)}, I/O interface {_version(answer.interface)}"
        ),
        encoder=f"{latero.COUNTS_A_TURN} a turn in each of three joints, {where}",
        largest_slew_per_s=0.0,
        disabled=(),
        inverted=(),
    )


def _version(status: int) -> str:
    """Version and revision that a status word tells."""
    return f"{status >> 8 & 0xF}.{status >> 4 & 0xF}"
