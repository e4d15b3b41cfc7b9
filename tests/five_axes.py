"""Five-axis machines made up for tests, and a part on them: a trunnion (A, C) and a head and a table (B, C)."""

import numpy as np

from twin.kinematics import Kinematics
from twin.nc.canonical import Axes, FloatArray
from twin.nc.control.settings import ControlSettings, ToolData
from twin.nc.path.tool_center.tool_center import PartOnMachine

TRUNNION_AXES = Axes(("X", "Y", "Z", "A", "C"), ("linear",) * 3 + ("rotary",) * 2)
HEAD_AXES = Axes(("X", "Y", "Z", "B", "C"), ("linear",) * 3 + ("rotary",) * 2)
FIRST_LENGTH = 70.0
TRAVEL = np.array([(-400, 400), (-300, 300), (-550, 0), (-120, 120), (-np.inf, np.inf)])


def trunnion(
    tilt: tuple[float, float, float] = (12.0, -3.0, -480.0),
    table: tuple[float, float, float] = (10.0, 5.0, -520.0),
) -> Kinematics:
    """X and Z carry the tool; Y carries A, A carries C, C the part. The centres are not in line."""
    axis = np.array([(0, 0, 1), (1, 0, 0), (0, 1, 0), (1, 0, 0), (0, 0, 1)], np.float64)
    anchor = np.array([(0, 0, 0), (0, 0, 0), (0, 0, 0), tilt, table], np.float64)
    return _chain([2, 0, 1, 3, 4], [True, True, False, False, False], axis, anchor)


def head_and_table(
    pivot: tuple[float, float, float] = (1.0, -2.0, 150.0),
    table: tuple[float, float, float] = (10.0, 5.0, -520.0),
) -> Kinematics:
    """Z and X carry the head B, which carries the tool; Y carries the table C."""
    axis = np.array([(0, 1, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0), (0, 0, 1)], np.float64)
    anchor = np.array([pivot, (0, 0, 0), (0, 0, 0), (0, 0, 0), table], np.float64)
    return _chain([3, 2, 0, 1, 4], [True, True, True, False, False], axis, anchor)


def _chain(
    columns: list[int], on_tool: list[bool], axis: FloatArray, anchor: FloatArray
) -> Kinematics:
    return Kinematics(
        column=np.array(columns),
        rotary=np.array(columns) > 2,
        on_tool=np.array(on_tool),
        axis=axis,
        anchor=anchor,
        tool=np.array([0.0, 0.0, 1.0]),
        table=np.array([0.0, 0.0, -500.0]),
        table_axes=np.eye(3),
    )


def on_machine(
    chain: Kinematics, zero: tuple[float, ...] = (15.0, 20.0, -430.0, 0.0, 0.0)
) -> PartOnMachine:
    return PartOnMachine(chain, np.array(zero), FIRST_LENGTH, TRAVEL)


def settings(setup: PartOnMachine, axes: Axes = TRUNNION_AXES) -> ControlSettings:
    """A control of such a machine: tool 2 is 15 mm longer than tool 1."""
    return ControlSettings(
        axes=axes,
        setup=setup,
        tools={1: ToolData(3.0, FIRST_LENGTH), 2: ToolData(5.0, FIRST_LENGTH + 15.0)},
        machine_zero=axes.named(-setup.zero),
    )
