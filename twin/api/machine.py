"""A machine as a MuJoCo model."""

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path

import mujoco

from twin.files.shipped import machine_file
from twin.machine.load import read_machine
from twin.machine.model.drives import feedforward_name, integral_name
from twin.machine.model.model import build_spec, compiled


class Machine:
    """A machine of the twin as a MuJoCo model.

    Attributes:
        file: Its ``machine.toml``.
        actuators: The actuator of each axis; its input, a velocity [m/s or rad/s], is integrated to
            the position setpoint (the page of ``twin/machine`` says why).
        integral_actuators: The one that integrates what each axis leaves behind, of axes whose drive does; its
            input is the position setpoint [m or rad].
        feedforward_actuators: The motor of each axis that adds its drive's feed-forward [N or N m].
    """

    def __init__(self, name: str | Path) -> None:
        """Read a machine.

        Args:
            name: A shipped machine's name, one of its variants, or a machine file.

        Raises:
            UsageError: There is none, or its file is wrong.
        """
        self._machine = read_machine(machine_file(str(name)))
        self.file = self._machine.path
        self.axes = self._machine.axes.names
        self.joints: Mapping[str, str] = {
            name: self._machine.axis(name).joint for name in self.axes
        }
        self.actuators: Mapping[str, str] = {name: name for name in self.axes}
        self.integral_actuators: Mapping[str, str] = {
            name: integral_name(name) for name in self.axes if self._machine.axis(name).reset_time_s
        }
        self.feedforward_actuators: Mapping[str, str] = {
            name: feedforward_name(name) for name in self.axes
        }

    def spec(self) -> mujoco.MjSpec:
        """A new editable model: machine, drives, lights, cameras, a 10 mm end mill in the spindle.

        Raises:
            ConfigError: The model is wrong.
        """
        return build_spec(self._machine)

    @cached_property
    def model(self) -> mujoco.MjModel:
        """The compiled model.

        Raises:
            ConfigError: The model is wrong.
        """
        return compiled(self.spec(), self._machine)

    def __repr__(self) -> str:
        return f"<Machine {self._machine.file.name}: axes {', '.join(self.axes)}>"
