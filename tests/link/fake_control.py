"""A control in place of LinuxCNC: it asks for positions and keeps the answers."""

import socket
import threading
from collections.abc import Iterable, Sequence

import numpy as np

from twin.link.lockstep import LockstepMotion
from twin.link.packet import ANSWER_LAYOUT, JOINTS, MAGIC, REQUEST_LAYOUT, REQUEST_STATES, VERSION
from twin.nc.canonical import FloatArray

MAY_RUN, LEAVING = REQUEST_STATES["may_run"], REQUEST_STATES["leaving"]
AMPLIFIERS = (1 << JOINTS) - 1


class FakeControl:
    """Asks the twin from a thread of its own.

    Attributes:
        answers: State, faults, reason and feedback of every answer.
    """

    def __init__(self, motion: LockstepMotion, noise: Sequence[bytes] = ()) -> None:
        self.answers: list[tuple[int, int, str, FloatArray]] = []
        self._port = motion.port
        self._noise = noise
        self._sequence = 0

    def start(self, positions: FloatArray, line: int = 1, *, leaves: bool = True) -> None:
        """Switch on where the positions begin, command them and, by default, take leave."""

        def ask() -> None:
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as channel:
                channel.settimeout(20.0)
                channel.connect(("127.0.0.1", self._port))
                for noise in self._noise:
                    channel.send(noise)
                self._ask(channel, MAY_RUN, 0, 0, positions[0])
                for _ in range(2):
                    self._ask(channel, MAY_RUN, AMPLIFIERS, 0, positions[0])
                for position in positions[1:]:
                    self._ask(channel, MAY_RUN, AMPLIFIERS, line, position)
                if leaves:
                    self._ask(channel, LEAVING, 0, 0, positions[-1])

        self._thread = threading.Thread(target=ask, daemon=True)
        self._thread.start()

    def finish(self) -> None:
        """Wait until the last answer has come."""
        self._thread.join(20.0)
        assert not self._thread.is_alive()

    @property
    def feedback(self) -> FloatArray:
        """Where the joints were, from the first commanded position on, shape (n, 9)."""
        return np.array([answer[3] for answer in self.answers[3:]])

    def _ask(
        self, channel: socket.socket, state: int, amplifiers: int, line: int, at: Iterable[float]
    ) -> None:
        row = list(at)
        command = [*row, *[0.0] * (JOINTS - len(row))]
        self._sequence += 1
        head = (MAGIC, VERSION, self._sequence, state, amplifiers, line, int(line > 0))
        channel.send(REQUEST_LAYOUT.pack(*head, *command, *[0.0] * JOINTS))
        answer = ANSWER_LAYOUT.unpack(channel.recv(ANSWER_LAYOUT.size + 1))
        assert answer[2] == self._sequence
        reason = answer[-1].split(b"\0")[0].decode()
        self.answers.append((answer[3], answer[4], reason, np.array(answer[7:-1])))
