"""When a machine is idle, so that its time goes on without being simulated."""

import numpy as np

from twin.training.room.observed import Observed

SETTLED_S = 1.0
"""Machine time without any motion after which a machine counts as resting [s]."""
STILL = 1e-5
"""Speed below which nothing moves while it rests [mm/s or deg/s]: 0.6 micrometres in a minute, which are
not made."""


class Rest:
    """Knows whether a machine rests: nothing runs, turns or moves, and nobody has asked for anything.

    What rests stays as it is until a command comes: a slice of it costs no step of the physics. It is a
    state of the room like any other, so that a session that is lived again rests in the same slices.
    """

    def __init__(self) -> None:
        self._still_s = 0.0

    def wake(self) -> None:
        """Something was asked for."""
        self._still_s = 0.0

    @property
    def lasts(self) -> bool:
        """Whether the machine rests."""
        return self._still_s >= SETTLED_S

    def look(self, room: Observed, seconds: float) -> bool:
        """Look at a machine after a slice that was computed.

        Args:
            seconds: Length of the slice [s].

        Returns:
            Whether it rests from now on.
        """
        still = (
            room.slot.run is None
            and not room.auxiliaries.spindle.turns
            and not room.machine.machine.file.thermal
            and float(np.abs(room.samples.joint_velocity).max()) < STILL
        )
        self._still_s = self._still_s + seconds if still else 0.0
        return self.lasts
