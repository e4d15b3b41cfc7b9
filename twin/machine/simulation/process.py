"""The interface of a cutting process with which the drives are stepped."""

from typing import NamedTuple, Protocol

from twin.machine.simulation.drive_kernels import Drives
from twin.machine.simulation.stepping import Stepper
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.recording.alarms import Alarm
from twin.recording.form import ToolLoad


class Physics(NamedTuple):
    """A machine that is stepped by a kernel; SI.

    Attributes:
        control: Its data's controls, shape (nu,).
        pushed: Its data's applied forces, shape (nv,).
        substeps: Steps in a servo period.
        signature: Which parts of the state are read.
    """

    stepper: Stepper
    control: FloatArray
    pushed: FloatArray
    drives: Drives
    substeps: int
    signature: int


class Process(Protocol):
    """Steps a machine and pushes its axes by what its tool does."""

    @property
    def alarm(self) -> Alarm | None:
        """What the last ``follow`` found that stops the machine."""
        ...

    def begin(self, position: FloatArray) -> None:
        """Begin with the machine at rest.

        Args:
            position: Machine coordinates, shape (k,) [mm or deg].
        """
        ...

    def follow(
        self, physics: Physics, setpoints: Setpoints, controls: FloatArray, states: FloatArray
    ) -> ToolLoad:
        """Step the machine from setpoint to setpoint.

        Args:
            physics: The machine, in the state that it has come to.
            setpoints: n setpoints.
            controls: What the drives are commanded during the step to each, shape (n, nu).
            states: Set to the states there, shape (n, width).

        Returns:
            The load on the tool at each.
        """
        ...

    def at_rest(self, count: int) -> ToolLoad:
        """The load on a tool that does not cut, n times."""
        ...
