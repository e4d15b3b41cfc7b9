"""The machine stepped while its tool cuts a height map: one loop over setpoints, without a call of Python."""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import array_kernel, kernel, threaded_kernel
from twin.coupling.turning_tool import (
    LOOK_CELLS,
    CutNumber,
    Memory,
    ToolLoads,
    TurningTool,
    axis_place,
    bend_tool,
    feed_changed,
    feel_teeth,
    note_load,
    share_of_tooth,
    step_period,
    time_of_tooth,
    turn_spindle,
)
from twin.cutting.kernels.covered_cells import Cells, LineColumn, Marks
from twin.cutting.kernels.sweep import sweep
from twin.cutting.kernels.tooth_forces import tooth_forces
from twin.cutting.kernels.walls import WalledMap, leave_walls, lose_trace, no_trace
from twin.machine.simulation.process import Physics
from twin.nc.canonical import FloatArray
from twin.units import MM


class PartTransform(NamedTuple):
    """From machine coordinates to the part's frame (``twin.toolpath.part_frame.PartFrame``).

    Attributes:
        rotary: Column of the axis that turns the part; -1: nothing does.
        center: Machine X and Y over the axis of rotation [mm].
        turn_zero: Where the part's frame is parallel to the machine's [deg].
        length_difference: How much lower the tip is than that which positions count for [mm].
    """

    rotary: int
    center: tuple[float, float]
    turn_zero: float
    length_difference: float


class Cut(NamedTuple):
    """A tool in a height map, which is cut, and where the part is."""

    material: WalledMap
    cells: Cells
    tool: TurningTool
    place: PartTransform


class CutProgress(NamedTuple):
    """How far the height map is cut; carried from one period to the next.

    Attributes:
        tips: Where it was cut up to, shape (2, 3); the second row is the later [mm].
        trace: Where it has left walls up to, of ``leave_walls``.
        sums: What ``sweep`` adds to, shape (1, 4).
    """

    tips: FloatArray
    trace: FloatArray
    sums: FloatArray
    marks: Marks


def nothing_swept() -> CutProgress:
    """Of a tool that has been nowhere."""
    marks = Marks(np.zeros((0, 0)), np.zeros(1))
    return CutProgress(np.zeros((2, 3)), no_trace(), np.zeros((1, len(LineColumn))), marks)


@threaded_kernel
def follow_cutting(
    physics: Physics,
    controls: FloatArray,
    states: FloatArray,
    commanded: FloatArray,
    cut: Cut,
    memory: Memory,
    swept: CutProgress,
    loads: ToolLoads,
) -> None:
    """Step the machine from setpoint to setpoint while its tool cuts.

    In every period the axes are pushed by the force of the teeth at its beginning, in the
    mean over the angle that they turn in a period.

    Args:
        controls: What the drives are commanded during the step to each setpoint, shape (n, nu).
        states: Set to the states there, shape (n, width).
        commanded: Speed that the spindle is commanded, shape (n,) [turns/s]; NaN: nothing is known of it.
        memory: Carried on.
        swept: Carried on.
        loads: Set to what the tool loads.
    """
    period = physics.drives.period
    for row in range(len(controls)):
        step_period(physics, controls[row], memory.load, states[row])
        cosine, sine = _go_to(physics, states[row], cut, memory, swept)
        if turn_spindle(period, commanded[row], cut.tool, memory):
            _look(period, cut, memory, swept)
            feel_teeth(period, cut.tool, memory)
        bend_tool(period, cut.tool, memory)
        _load_axes(cut.place, memory, cosine, sine)
        x, y = memory.bend[0], memory.bend[1]
        bend = (cosine * x + sine * y, cosine * y - sine * x, memory.bend[2])
        note_load(cut.tool, memory, loads, row, bend)
    physics.pushed[:] = 0.0


@kernel
def _go_to(
    physics: Physics, state: FloatArray, cut: Cut, memory: Memory, swept: CutProgress
) -> tuple[float, float]:
    """Move the rigid tool's tip to where the axes are; cosine and sine of the part's turn."""
    drives, numbers, place = physics.drives, memory.numbers, cut.place
    x = axis_place(drives, state, 0) - place.center[0]
    y = axis_place(drives, state, 1) - place.center[1]
    z = axis_place(drives, state, 2) - place.length_difference
    cosine, sine = 1.0, 0.0
    if place.rotary >= 0:
        turn = math.radians(axis_place(drives, state, place.rotary) - place.turn_zero)
        cosine, sine = math.cos(turn), math.sin(turn)
    tip = (cosine * x - sine * y, sine * x + cosine * y, z)
    # A chip is as thick as the path between two teeth: the speed in the mean of that time.
    share = share_of_tooth(cut.tool, memory, drives.period)
    for k in range(3):
        if numbers[CutNumber.FRESH] > 0.0:
            numbers[CutNumber.STOOD] = 0.0
            lose_trace(swept.trace)
            memory.speed[k] = 0.0
            swept.tips[0, k] = swept.tips[1, k] = tip[k]
        else:
            now = (tip[k] - memory.rigid[k]) / drives.period
            memory.speed[k] += share * (now - memory.speed[k])
        memory.rigid[k] = tip[k]
    numbers[CutNumber.FRESH] = 0.0
    return cosine, sine


@array_kernel
def _look(period: float, cut: Cut, memory: Memory, swept: CutProgress) -> None:
    """Cut up to where the tool is and look at what is before it, where it has gone far enough."""
    numbers, tips, feed = memory.numbers, swept.tips, memory.feed
    changed, moved = feed_changed(time_of_tooth(period, cut.tool, memory), memory), 0.0
    for k in range(3):
        moved += (memory.rigid[k] + memory.bend[k] - tips[1, k]) ** 2
    near = LOOK_CELLS * cut.material.grid.cell
    if moved < near * near and not changed:
        return
    for k in range(3):
        tips[0, k] = tips[1, k]
        tips[1, k] = memory.rigid[k] + memory.bend[k]
        memory.looked[k] = feed[k]
    if min(tips[0, 2], tips[1, 2]) >= cut.material.grid.top:
        numbers[CutNumber.MET] = 0.0
        lose_trace(swept.trace)
        return
    material, cutter = cut.material, cut.tool.cutter
    sweep(
        cut.cells, tips, cutter.profile,
        swept.sums, swept.marks, numbers[CutNumber.STOOD] > 0.0, False,
    )  # fmt: skip
    numbers[CutNumber.STOOD] = 1.0
    leave_walls(material, swept.trace, tips[1], cutter.profile.radius, cutter.side_from)
    sense = 1.0 if numbers[CutNumber.SPEED] >= 0.0 else -1.0
    met = tooth_forces(material, tips[1], feed, cutter, cut.tool.law, sense, memory.scratch)
    numbers[CutNumber.MET] = 1.0 if met else 0.0


@kernel
def _load_axes(place: PartTransform, memory: Memory, cosine: float, sine: float) -> None:
    """What the force on the tool pushes the axes with."""
    force, load, tip = memory.force, memory.load, memory.rigid
    load[0] = cosine * force[0] + sine * force[1]
    load[1] = cosine * force[1] - sine * force[0]
    load[2] = force[2]
    if place.rotary >= 0:
        load[place.rotary] = MM * (tip[0] * force[1] - tip[1] * force[0])
