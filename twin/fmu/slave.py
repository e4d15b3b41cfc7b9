"""A machine unit behind FMI 3's functions, by ``pythonfmu3``."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pythonfmu3

from twin.errors import TwinError
from twin.files.shipped import machine_file
from twin.fmu.machine_unit import MachineUnit
from twin.machine.load import read_machine
from twin.nc.canonical import FloatArray
from twin.version import __version__

fmi: Any = pythonfmu3
_DEGREE = math.pi / 180.0
_UNITS: dict[str, dict[str, float]] = {
    "mm": {"factor": 1e-3, "m": 1},
    "mm/s": {"factor": 1e-3, "m": 1, "s": -1},
    "mm/s2": {"factor": 1e-3, "m": 1, "s": -2},
    "deg": {"factor": _DEGREE, "rad": 1},
    "deg/s": {"factor": _DEGREE, "rad": 1, "s": -1},
    "deg/s2": {"factor": _DEGREE, "rad": 1, "s": -2},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "%": {"factor": 1e-2},
}
"""Units of the variables by those of SI."""
MACHINE = "machine.txt"
"""In the unit's resources: a shipped machine's name, or the file of another one below them."""


class MachineSlave(fmi.Fmi3Slave):
    """One instance of a unit; ``pythonfmu3`` asks it for its variables and lets it step."""

    def __init__(self, **arguments: Any) -> None:
        super().__init__(**arguments)
        folder = Path(arguments["resources"])
        named = (folder / MACHINE).read_text(encoding="utf-8").strip()
        inside = folder / named
        self.unit = MachineUnit(read_machine(inside if inside.is_file() else machine_file(named)))
        self.author, self.version = "mill-twin", __version__
        self.description = f"{self.unit.machine.file.name}: setpoints in, joints and loads out"
        self.time = 0.0
        self.default_experiment = fmi.DefaultExperiment(
            start_time=0.0, stop_time=1.0, step_size=self.unit.period_s
        )
        self.register_units([fmi.Unit(name, **base) for name, base in _UNITS.items()])
        self._register()

    def _register(self) -> None:
        causality, variability = fmi.Fmi3Causality, fmi.Fmi3Variability
        self.register_variable(
            fmi.Float64("time", causality=causality.independent, variability=variability.continuous)
        )
        axes = self.unit.machine.axes
        for index, (name, kind) in enumerate(zip(axes.names, axes.kinds, strict=True)):
            length, force = ("mm", "N") if kind == "linear" else ("deg", "N.m")
            self._number("start", index, name, length, "start", causality.parameter)
            for what, unit in (
                ("position", length),
                ("velocity", f"{length}/s"),
                ("acceleration", f"{length}/s2"),
            ):
                self._number(f"setpoint.{what}", index, name, unit, what, causality.input)
            for shown, what, unit in (
                ("joint.position", "joint_position", length),
                ("joint.velocity", "joint_velocity", f"{length}/s"),
                ("drive.force", "force", force),
                ("drive.load", "load", "%"),
            ):
                self._number(shown, index, name, unit, what, causality.output)
        self.register_variable(
            fmi.String(
                "alarm", causality=causality.output, variability=variability.discrete,
                description="code of the active alarm; empty: none",
                getter=lambda: self.unit.alarm,
            ),
            nested=False,
        )  # fmt: skip

    def _number(
        self, shown: str, index: int, axis: str, unit: str, attribute: str, causality: Any
    ) -> None:
        def values() -> FloatArray:
            return getattr(self.unit, attribute)

        def write(value: float) -> None:
            values()[index] = value

        given = causality in (fmi.Fmi3Causality.parameter, fmi.Fmi3Causality.input)
        fixed = causality is fmi.Fmi3Causality.parameter
        setter: Callable[[float], None] | None = write if given else None
        self.register_variable(
            fmi.Float64(
                f"{shown}.{axis}",
                causality=causality,
                variability=fmi.Fmi3Variability.fixed if fixed else fmi.Fmi3Variability.continuous,
                unit=unit,
                getter=lambda: float(values()[index]),
                setter=setter,
            ),
            nested=False,
        )

    def exit_initialization_mode(self) -> None:
        """The parameters are known: switch the machine on."""
        self.unit.begin()

    def do_step(self, current_time: float, step_size: float) -> Any:
        """Advance by a servo period; an error is logged and fails the step."""
        try:
            self.unit.step(step_size)
        except TwinError as error:
            self.log(str(error), fmi.Fmi3Status.error)
            return fmi.Fmi3StepResult(status=fmi.Fmi3Status.error)
        self.time = current_time + step_size
        return fmi.Fmi3StepResult()
