"""The greatest force, power, chip and deflection of each program line, in bounded memory."""

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np

from twin.cutting.watching.cut_log import LINES_REMEMBERED, LINES_REPORTED
from twin.nc.canonical import FloatArray
from twin.recording.form import Samples, ToolLoad
from twin.units import UM_PER_MM


@dataclasses.dataclass(frozen=True, slots=True)
class Greatest:
    """The greatest value of a figure.

    Attributes:
        value: In the figure's unit.
        line: Source line at which it was met.
        time_s: When [s].
    """

    value: float
    line: int
    time_s: float


FIGURES = ("force_n", "power_w", "chip_mm", "deflection_um", "spindle_load")
"""Greatest level force of a turn, power of the cut, thickest chip, deflection of the tip, and torque as a
share of what the spindle gives for long."""


def figures_of(tool: ToolLoad) -> FloatArray:
    """The ``FIGURES`` of n samples, shape (n, 5)."""
    bend = UM_PER_MM * np.linalg.norm(tool.deflection, axis=1)
    return np.column_stack([tool.peak_force, tool.power, tool.chip, bend, tool.spindle_load])


class LoadLog:
    """Keeps the greatest of every line; of very many lines those that met the greatest force.

    Attributes:
        greatest: Of the whole run, by figure; empty where force was not simulated.
    """

    def __init__(self, remembered: int = LINES_REMEMBERED) -> None:
        self.greatest: dict[str, Greatest] = {}
        self._remembered = remembered
        self._lines: dict[int, FloatArray] = {}

    def add(self, samples: Samples) -> None:
        """Take note of samples that follow the last ones."""
        if samples.tool is None or not len(samples):
            return
        values = figures_of(samples.tool)
        for name, row in zip(FIGURES, values.argmax(axis=0).tolist(), strict=True):
            found = float(values[row, FIGURES.index(name)])
            if name not in self.greatest or found > self.greatest[name].value:
                asked = samples.setpoint
                self.greatest[name] = Greatest(found, int(asked.line[row]), float(asked.time[row]))
        cutting = samples.tool.peak_force > 0.0
        lines, which = np.unique(samples.setpoint.line[cutting], return_inverse=True)
        most = np.zeros((len(lines), len(FIGURES)))
        np.maximum.at(most, which, values[cutting])
        for line, row in zip(lines.tolist(), most, strict=True):
            self._lines[line] = np.maximum(self._lines.get(line, row), row)
        if len(self._lines) > 2 * self._remembered:
            self._lines = self._foremost(self._remembered)

    def as_json(self) -> list[dict[str, Any]]:
        """The greatest figures of the foremost lines that cut, by line."""
        return [
            {"line": line, **dict(zip(FIGURES, values.tolist(), strict=True))}
            for line, values in sorted(self._foremost(LINES_REPORTED).items())
        ]

    def _foremost(self, count: int) -> dict[int, FloatArray]:
        ranked: Mapping[int, FloatArray] = self._lines
        return dict(sorted(ranked.items(), key=lambda item: -float(item[1][0]))[:count])
