"""The machine stepped while its tool cuts a part from any side: any chain of axes, a tri-dexel stock."""

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
from twin.cutting.tridexel.dexels import Dexels, Lattice
from twin.cutting.tridexel.edge import Leaning
from twin.cutting.tridexel.edge_forces import EdgeScratch, edge_forces, empty_scratch
from twin.cutting.tridexel.solids.moving_solid import Poses
from twin.cutting.tridexel.sweep import StepColumn, sweep
from twin.kinematics import Kinematics
from twin.machine.simulation.process import Physics
from twin.nc.canonical import FloatArray
from twin.toolpath.pose_kernels import turned
from twin.units import DEGREE, MM

_ALONG = 0.9
"""Cosine to the tool's axis from which machine X is no direction across it."""
_SINGULAR = 1e-6
"""Volume that the displacements by X, Y and Z span below which they leave the tip a direction short."""


class JointChain(NamedTuple):
    """The joints between tool and part, and what they count from (``twin.toolpath.part_frame.PartFrame``).

    Attributes:
        zero: What its axes count from, shape (k,) [mm or deg].
        length_difference: How much longer the tool is than that which positions count for [mm].
    """

    joints: Kinematics
    zero: FloatArray
    length_difference: float


class LeaningCut(NamedTuple):
    """A tool in a part that is cut from any side.

    Attributes:
        solids: The bodies of the edge, shape (m, 5).
        number: That the cut surface remembers.
        longest: Step that is swept at once at most [mm].
    """

    dexels: Dexels
    lattice: Lattice
    solids: FloatArray
    number: int
    longest: float
    tool: TurningTool
    chain: JointChain


class Pose(NamedTuple):
    """Where the tool is; carried from one period to the next.

    Attributes:
        frame: Directions of its X, Y and Z in the part's frame, as rows, shape (3, 3).
        jacobian: Displacement of its tip in the part's frame by each axis, shape (k, 3) [mm per mm or rad].
        lean_speed: What its axis turns by in the mean of a tooth, in its frame, shape (3,) [1/s].
        lean: That in the time between two teeth, shape (3,).
        bend: Deflection of its tip in the part's frame, shape (3,) [mm].
        cut_to: Where the material was cut up to: two poses, the later one second.
        sums: What ``sweep`` adds to, shape (1, ``StepColumn.COLUMNS``).
        edge: What of the edge is in the material.
    """

    frame: FloatArray
    jacobian: FloatArray
    lean_speed: FloatArray
    lean: FloatArray
    bend: FloatArray
    cut_to: Poses
    step: Poses
    sums: FloatArray
    edge: EdgeScratch


def nowhere(axes: int) -> Pose:
    """Of a tool that has been nowhere, on a machine of k axes."""
    lean_speed, lean, bend = np.zeros((3, 3))
    cut_to, step = (Poses(np.zeros((2, 3)), np.zeros((2, 3))) for _ in range(2))
    return Pose(
        np.eye(3), np.zeros((axes, 3)), lean_speed, lean, bend, cut_to, step,
        np.zeros((1, StepColumn.COLUMNS)), empty_scratch(),
    )  # fmt: skip


@threaded_kernel
def follow_leaning(
    physics: Physics,
    controls: FloatArray,
    states: FloatArray,
    commanded: FloatArray,
    cut: LeaningCut,
    memory: Memory,
    pose: Pose,
    loads: ToolLoads,
) -> int:
    """Step the machine from setpoint to setpoint while its tool cuts; see ``cutting_kernels.follow_cutting``.

    Returns:
        How many rows were followed: fewer than all where there was no memory for what is left of the material. The
        next call cuts what the last one could not.
    """
    period = physics.drives.period
    for row in range(len(controls)):
        step_period(physics, controls[row], memory.load, states[row])
        _go_to(physics, states[row], cut, memory, pose)
        enough = True
        if turn_spindle(period, commanded[row], cut.tool, memory):
            enough = _look(period, cut, memory, pose)
            feel_teeth(period, cut.tool, memory)
        bend_tool(period, cut.tool, memory)
        _load_axes(cut.chain.joints, memory, pose)
        note_load(cut.tool, memory, loads, row, _along_axes(memory, pose))
        if not enough:
            physics.pushed[:] = 0.0
            return row + 1
    physics.pushed[:] = 0.0
    return len(controls)


@array_kernel
def _go_to(
    physics: Physics, state: FloatArray, cut: LeaningCut, memory: Memory, pose: Pose
) -> None:
    """Move the rigid tool to where the axes are."""
    drives, numbers, frame = physics.drives, memory.numbers, pose.frame
    before, axis_before = memory.rigid.copy(), frame[2].copy()
    for k in range(len(pose.jacobian)):
        pose.jacobian[k, 0] = axis_place(drives, state, k) - cut.chain.zero[k]
    _carry(cut.chain, memory.rigid, pose)
    if numbers[CutNumber.FRESH] > 0.0:
        memory.speed[:] = 0.0
        pose.lean_speed[:] = 0.0
        for end in range(2):
            pose.cut_to.tip[end], pose.cut_to.axis[end] = memory.rigid, frame[2]
        numbers[CutNumber.FRESH] = 0.0
        return
    share = share_of_tooth(cut.tool, memory, drives.period)
    travel, turned = memory.rigid - before, frame[2] - axis_before
    for k in range(3):
        now, lean = _dot(frame[k], travel) / drives.period, _dot(frame[k], turned) / drives.period
        memory.speed[k] += share * (now - memory.speed[k])
        pose.lean_speed[k] += share * (lean - pose.lean_speed[k])


@array_kernel
def _carry(chain: JointChain, tip: FloatArray, pose: Pose) -> None:
    """Carry a tool from joint to joint: tip, frame, and the displacement of the tip by each axis.

    Args:
        tip: Set to where the tip is.
        pose: In the first column of ``jacobian`` are the axes' coordinates, which are replaced.
    """
    joints, frame, jacobian = chain.joints, pose.frame, pose.jacobian
    tip[:] = -chain.length_difference * joints.tool
    frame[:] = 0.0
    frame[0, 1 if abs(joints.tool[0]) > _ALONG else 0] = 1.0
    frame[0] -= _dot(frame[0], joints.tool) * joints.tool
    frame[0] /= math.sqrt(_dot(frame[0], frame[0]))
    frame[2] = joints.tool
    for j in range(len(joints.column)):
        axis, column = joints.axis[j], joints.column[j]
        value = jacobian[column, 0]
        if not joints.rotary[j]:
            tip += value * axis
            jacobian[column] = axis
            continue
        angle, anchor = value * DEGREE, joints.anchor[j]
        cosine, sine = math.cos(angle), math.sin(angle)
        tip -= anchor
        _turn(tip, axis, cosine, sine)
        _cross(axis, tip, jacobian[column])
        tip += anchor
        _turn(frame[0], axis, cosine, sine)
        _turn(frame[2], axis, cosine, sine)
        for earlier in range(j):
            _turn(jacobian[joints.column[earlier]], axis, cosine, sine)
    _cross(frame[2], frame[0], frame[1])


@kernel
def _turn(vector: FloatArray, axis: FloatArray, cosine: float, sine: float) -> None:
    """Turn a vector about an axis."""
    x, y, z = vector[0], vector[1], vector[2]
    vector[0], vector[1], vector[2] = turned(x, y, z, axis[0], axis[1], axis[2], cosine, sine)


@kernel
def _dot(a: FloatArray, b: FloatArray) -> float:
    """Product of two vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def _cross(a: FloatArray, b: FloatArray, product: FloatArray) -> None:
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        product[k] = a[i] * b[j] - a[j] * b[i]


@array_kernel
def _look(period: float, cut: LeaningCut, memory: Memory, pose: Pose) -> bool:
    """Cut up to where the tool is and look at what is before it, where it has gone far enough.

    Returns:
        False where there was no memory for what is left of the material.
    """
    numbers, frame, cut_to = memory.numbers, pose.frame, pose.cut_to
    time = time_of_tooth(period, cut.tool, memory)
    changed = feed_changed(time, memory)
    pose.lean[:] = time * pose.lean_speed
    _bend_in_part(memory, pose)
    tip = memory.rigid + pose.bend
    travel = tip - cut_to.tip[1]
    top = travel + cut.tool.cutter.flute * (frame[2] - cut_to.axis[1])
    moved = max(_dot(travel, travel), _dot(top, top))
    near = LOOK_CELLS * cut.lattice.cell
    if moved < near * near and not changed:
        return True
    cut_to.tip[0], cut_to.axis[0] = cut_to.tip[1], cut_to.axis[1]
    cut_to.tip[1], cut_to.axis[1] = tip, frame[2]
    if not _sweep(cut, pose, math.sqrt(moved)):
        cut_to.tip[1], cut_to.axis[1] = cut_to.tip[0], cut_to.axis[0]
        return False
    memory.looked[:] = memory.feed
    if pose.sums[0, StepColumn.LENGTH] <= 0.0 and numbers[CutNumber.MET] <= 0.0:
        return True
    sense = 1.0 if numbers[CutNumber.SPEED] >= 0.0 else -1.0
    leaning = Leaning(tip, frame, memory.feed, pose.lean, sense)
    met = edge_forces(
        cut.dexels, cut.lattice, leaning, cut.tool.cutter, cut.tool.law, pose.edge, memory.scratch
    )
    numbers[CutNumber.MET] = 1.0 if met else 0.0
    return True


@kernel
def _bend_in_part(memory: Memory, pose: Pose) -> None:
    """Turn the deflection of the tip into the part's frame."""
    for i in range(3):
        pose.bend[i] = 0.0
        for k in range(3):
            pose.bend[i] += memory.bend[k] * pose.frame[k, i]


@array_kernel
def _sweep(cut: LeaningCut, pose: Pose, travel: float) -> bool:
    """Cut between two poses, in short steps; False: memory ran out."""
    pose.sums[:] = 0.0
    step, begin, end = pose.step, pose.cut_to.tip[0], pose.cut_to.tip[1]
    axis, last = pose.cut_to.axis[0], pose.cut_to.axis[1]
    parts = max(math.ceil(travel / cut.longest), 1)
    step.tip[1], step.axis[1] = begin, axis
    for part in range(parts):
        share = (part + 1.0) / parts
        step.tip[0], step.axis[0] = step.tip[1], step.axis[1]
        step.tip[1] = (1.0 - share) * begin + share * end
        step.axis[1] = (1.0 - share) * axis + share * last
        step.axis[1] /= math.sqrt(_dot(step.axis[1], step.axis[1]))
        done = sweep(
            cut.dexels, cut.lattice, step, cut.solids, pose.sums, cut.number, int(np.int64(0))
        )
        if done < 1:
            return False
    return True


@kernel
def _load_axes(chain: Kinematics, memory: Memory, pose: Pose) -> None:
    """What the force on the tool pushes the axes with: virtual work."""
    force, frame = memory.force, pose.frame
    for j in range(len(chain.column)):
        column, work = chain.column[j], 0.0
        for i in range(3):
            along = force[0] * frame[0, i] + force[1] * frame[1, i] + force[2] * frame[2, i]
            work += pose.jacobian[column, i] * along
        memory.load[column] = MM * work if chain.rotary[j] else work


@array_kernel
def _along_axes(memory: Memory, pose: Pose) -> tuple[float, float, float]:
    """How far X, Y and Z would have to go for the deflection of the tool [mm]; zero where they do not span space."""
    _bend_in_part(memory, pose)
    bend, jacobian, across = pose.bend, pose.jacobian, np.zeros((3, 3))
    for k in range(3):
        _cross(jacobian[(k + 1) % 3], jacobian[(k + 2) % 3], across[k])
    volume = _dot(jacobian[0], across[0])
    if abs(volume) < _SINGULAR:
        return 0.0, 0.0, 0.0
    x, y, z = _dot(across[0], bend), _dot(across[1], bend), _dot(across[2], bend)
    return x / volume, y / volume, z / volume
