"""A client and the boards of a Latero in memory, by a clock that the test turns."""

from __future__ import annotations

import heapq

import numpy as np

from tests.devices.latero.network import LateroFaults, Network
from vbraille.carriers import latero
from vbraille.devices.latero.conversation import LateroConversation
from vbraille.devices.latero.wire import Answer, Foreign, parse_answer
from vbraille.simulation.lateroboard import LateroBoard

MS = 1_000_000
OFFSETS = (4452, 4_294_960_000, 120_034)
FOREIGN_ENCODERS = (9, 9, 9, 9)  # of an answer to what was not asked
FELT = np.linspace(0.1, 1, 64).reshape(8, 8)


class Talk:
    """A client that shows the same frame at each tick, and a Latero whose array moves along x.

    Parameters
    ----------
    faults
        What the network does.
    speed_mm_s
        Speed of the array.
    options
        Arguments of the conversation.
    """

    def __init__(self, faults=None, speed_mm_s=100.0, register=0, **options):
        self.now_ns = 0
        self.speed_mm_s = speed_mm_s
        self.board = LateroBoard(register)
        self.conversation = LateroConversation(
            0, **{"offsets": OFFSETS, "power": 0, "trusted": False, **options}
        )
        self.network = Network(faults or LateroFaults())
        self.frame = FELT
        self.poses = []
        self.events = []
        self.levels = []  # of each FULL that arrived
        self.answers = []  # for each request, the ages of the answers that arrived
        self._asked = {}  # index and time of the last request by each number
        self.cut = False
        self._coming = []
        self._count = 0

    def x_mm(self, now_ns):
        """Where the array is on the tray, from the left, to and fro."""
        way = self.speed_mm_s * now_ns / 1e9 % 400
        return 40 + min(way, 400 - way)

    def run(self, ticks):
        """Do ticks, 1 ms each; give the talk."""
        for _ in range(ticks):
            self.now_ns += MS
            self.tick()
        return self

    def tick(self):
        conversation, now_ns = self.conversation, self.now_ns
        self.poses.append(self.take())
        if self.frame is not None:
            conversation.show(self.frame, now_ns)
            self.exchange()
        self.events += conversation.take_events(now_ns)

    def take(self):
        """Hear what has come, and say what is due; give the newest place."""
        while self._coming and self._coming[0][0] <= self.now_ns:
            self.hear(heapq.heappop(self._coming)[2])
        self.conversation.tend(self.now_ns)
        self.exchange()
        return self.conversation.take_pose()

    def hear(self, answer):
        found = parse_answer(answer)
        nobodys = isinstance(found, Answer) and found.encoders == FOREIGN_ENCODERS
        if not nobodys and not isinstance(found, Foreign):  # numbers come again
            index, sent_ns = self._asked[found.sequence]
            self.answers[index].append(self.now_ns - sent_ns)
        self.conversation.hear(answer, self.now_ns)

    def exchange(self):
        """Have what is due arrive at once, and the answers a little later."""
        while (request := self.conversation.due()) is not None:
            self.conversation.sent()
            self._asked[request[3] << 8 | request[4]] = len(self.answers), self.now_ns
            self.answers.append([])
            if self.cut:
                continue
            for _ in range(self.network.carry_request()):
                joints = latero.joints_at(self.x_mm(self.now_ns), 100.0, 0.1)
                self.board.encoders = (*latero.encoders_of(joints, OFFSETS), 0)
                before = self.board.fulls
                answer = self.board.receive(bytes(request))
                assert answer is not None
                if self.board.fulls != before:
                    self.levels.append(self.board.levels.copy())
                for late_s, arriving in self.network.carry_answer(answer):
                    self._count += 1
                    due_ns = self.now_ns + round(late_s * 1e9) + MS // 10
                    heapq.heappush(self._coming, (due_ns, self._count, arriving))

    def of(self, kind):
        """Events of a kind."""
        return [event for event in self.events if isinstance(event, kind)]

    @property
    def steps(self):
        """How far blades went towards rest from one FULL to the next; int[n, 64]."""
        return np.diff(np.array(self.levels).astype(int), axis=0)
