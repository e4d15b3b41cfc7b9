"""A turning tool between one period of the machine and the next: its spindle, what its teeth feel, how it bends.

What describes the material is no matter here: ``cutting_kernels`` cuts a height map, ``leaning_kernels`` a part from any side.
"""

import enum
import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import array_kernel, kernel
from twin.coupling.spindle_kernels import SpindleDrive, lasting_torque, next_speed
from twin.cutting.forces.tool_strength import ToolStrength
from twin.cutting.kernels.teeth import (
    CutterForm,
    ForceLaw,
    ToothScratch,
    add_force_between,
    tooth_bench,
)
from twin.machine.simulation.drive_kernels import Drives, hold_push
from twin.machine.simulation.process import Physics
from twin.machine.simulation.stepping import pass_state, step_machine
from twin.nc.canonical import FloatArray
from twin.units import MM, SECONDS_PER_MINUTE

LOOK_CELLS = 0.25
"""The material is cut, and looked at again, when the tip has gone so far since [cells]."""
LOOK_FEED = 0.05
"""Or when the feed per tooth has changed by so much of itself."""
_LONGEST_MEAN_S = 0.05
"""Longest time that the speed of the feed is averaged over, however seldom a tooth comes [s]."""
_STILL = 1e-9


class EdgeState(enum.IntEnum):
    """A tool's edge: whole, or why it has gone."""

    WHOLE = 0
    BY_FORCE = 1
    BY_CHIP = 2
    BY_SPEED = 3
    BY_TORQUE = 4
    BY_THRUST = 5


class CutNumber(enum.IntEnum):
    """Columns of ``Memory.numbers``."""

    ANGLE = 0
    """Direction of the first tooth [turns]."""
    SPEED = 1
    """Of the spindle [turns/s]."""
    CONTACT = 2
    """Path since the cutter met material [mm]."""
    EDGE = 3
    """Its ``EdgeState``."""
    VALUE = 4
    """At which the edge went."""
    MET = 5
    """Whether it meets material."""
    FRESH = 6
    """Whether nothing is known of where it was."""
    STOOD = 7
    """Whether it has cut all that it meets where it was swept up to."""


class TurningTool(NamedTuple):
    """A tool in the spindle."""

    cutter: CutterForm
    law: ForceLaw
    strength: ToolStrength
    spindle: SpindleDrive


class Memory(NamedTuple):
    """What is carried from one period to the next.

    Forces, feeds and bends are in the tool's frame, whose Z is its axis; in a height map that is the part's frame.

    Attributes:
        numbers: By ``CutNumber``.
        rigid: Where the tip would be, were the tool rigid, part's frame, shape (3,) [mm].
        speed: Speed of the tip in the mean of a tooth, shape (3,) [mm/s].
        looked: Feed per tooth when the material was looked at, shape (3,) [mm].
        bend: Deflection of the tip, shape (3,) [mm].
        load: What pushes the axes, shape (k,) [N or N m].
        force: On the tool in this period, shape (3,) [N].
        feed: Feed per tooth in this period, shape (3,) [mm].
    """

    numbers: FloatArray
    rigid: FloatArray
    speed: FloatArray
    looked: FloatArray
    bend: FloatArray
    load: FloatArray
    scratch: ToothScratch
    force: FloatArray
    feed: FloatArray


class ToolLoads(NamedTuple):
    """Columns of ``twin.recording.form.ToolLoad``, set row by row."""

    force: FloatArray
    peak_force: FloatArray
    power: FloatArray
    chip: FloatArray
    deflection: FloatArray
    spindle_speed: FloatArray
    spindle_load: FloatArray
    broken: FloatArray


def new_memory(axes: int) -> Memory:
    """Memory before the first period."""
    numbers = np.zeros(len(CutNumber))
    numbers[CutNumber.FRESH] = 1.0
    three = [np.zeros(3) for _ in range(6)]
    rigid, speed, looked, bend, force, feed = three
    return Memory(numbers, rigid, speed, looked, bend, np.zeros(axes), tooth_bench(), force, feed)


@array_kernel
def step_period(physics: Physics, control: FloatArray, load: FloatArray, state: FloatArray) -> None:
    """Step a machine through a servo period, its axes pushed by what the tool does.

    Args:
        control: What the drives are commanded, shape (nu,).
        load: What pushes the axes, shape (k,) [N or N m].
        state: Set to that at the end, shape (width,).
    """
    stepper = physics.stepper
    hold_push(physics.drives, load, physics.pushed)
    physics.control[:] = control
    for _ in range(physics.substeps):
        step_machine(stepper.step, stepper.model, stepper.data)
    place, signature = state.ctypes.data, np.int64(physics.signature)
    pass_state(stepper.get_state, stepper.model, stepper.data, place, signature)


@kernel
def axis_place(drives: Drives, state: FloatArray, axis: int) -> float:
    """Where an axis is beyond what gives [mm or deg]."""
    place = state[drives.qpos[axis]]
    if drives.give_qpos[axis] >= 0:
        place += state[drives.give_qpos[axis]]
    return place / drives.scale[axis]


@kernel
def share_of_tooth(tool: TurningTool, memory: Memory, period: float) -> float:
    """How far a mean over the time between two teeth follows in a period, 0 to 1."""
    rate = max(abs(memory.numbers[CutNumber.SPEED]) * tool.cutter.teeth, 1.0 / _LONGEST_MEAN_S)
    return 1.0 - math.exp(-rate * period)


@array_kernel
def turn_spindle(period: float, commanded: float, tool: TurningTool, memory: Memory) -> bool:
    """Turn the spindle for a period; whether its tool may cut.

    Args:
        period: [s].
        commanded: Speed that the spindle is commanded [turns/s]; NaN: nothing is known of it.
        memory: Carried on.
    """
    numbers = memory.numbers
    torque = memory.scratch.figures[1] * MM if numbers[CutNumber.MET] > 0.0 else 0.0
    speed = 0.0 if math.isnan(commanded) else commanded
    numbers[CutNumber.SPEED] = next_speed(
        tool.spindle, numbers[CutNumber.SPEED], speed, torque, period
    )
    memory.force[:] = 0.0
    if math.isnan(commanded) or numbers[CutNumber.EDGE] != EdgeState.WHOLE.value:
        # What cuts nothing goes where it will: the next cut begins where the tool is then.
        numbers[CutNumber.MET], numbers[CutNumber.FRESH] = 0.0, 1.0
        return False
    if abs(numbers[CutNumber.SPEED]) > tool.strength.speed / SECONDS_PER_MINUTE:
        _break(memory, EdgeState.BY_SPEED, abs(numbers[CutNumber.SPEED]) * SECONDS_PER_MINUTE)
        return False
    return True


@kernel
def feel_teeth(period: float, tool: TurningTool, memory: Memory) -> None:
    """What the teeth do until the next period: break the tool, or push it in the mean of the angle that they turn."""
    numbers, scratch, strength = memory.numbers, memory.scratch, tool.strength
    turned = numbers[CutNumber.SPEED] * period
    if numbers[CutNumber.MET] > 0.0:
        if scratch.figures[2] > strength.chip:
            _break(memory, EdgeState.BY_CHIP, scratch.figures[2])
        elif scratch.figures[0] > strength.force:
            _break(memory, EdgeState.BY_FORCE, scratch.figures[0])
        elif scratch.figures[1] * MM > strength.torque:
            _break(memory, EdgeState.BY_TORQUE, scratch.figures[1] * MM)
        elif scratch.mean[2] > strength.thrust:
            _break(memory, EdgeState.BY_THRUST, scratch.mean[2])
        else:
            add_force_between(tool.cutter, scratch, numbers[CutNumber.ANGLE], -turned, memory.force)
    numbers[CutNumber.ANGLE] -= turned
    numbers[CutNumber.ANGLE] -= math.floor(numbers[CutNumber.ANGLE])


@kernel
def _break(memory: Memory, why: EdgeState, value: float) -> None:
    memory.numbers[CutNumber.EDGE], memory.numbers[CutNumber.VALUE] = why.value, value
    memory.numbers[CutNumber.MET] = 0.0


@kernel
def time_of_tooth(period: float, tool: TurningTool, memory: Memory) -> float:
    """Time between two teeth, or since the tool met the material [s]: the first tooth cuts no more than that."""
    numbers = memory.numbers
    speed = math.sqrt(memory.speed[0] ** 2 + memory.speed[1] ** 2 + memory.speed[2] ** 2)
    if numbers[CutNumber.MET] <= 0.0:
        numbers[CutNumber.CONTACT] = 0.0
    numbers[CutNumber.CONTACT] += speed * period
    teeth = max(abs(numbers[CutNumber.SPEED]) * tool.cutter.teeth, _STILL)
    return min(1.0 / teeth, numbers[CutNumber.CONTACT] / max(speed, _STILL))


@kernel
def feed_changed(time: float, memory: Memory) -> bool:
    """Set the feed per tooth; whether it is another than when the material was looked at.

    Args:
        time: Between two teeth [s].
        memory: Carried on.
    """
    changed, before = 0.0, 0.0
    for k in range(3):
        memory.feed[k] = memory.speed[k] * time
        changed += (memory.feed[k] - memory.looked[k]) ** 2
        before += memory.looked[k] ** 2
    return changed > LOOK_FEED * LOOK_FEED * before


@kernel
def bend_tool(period: float, tool: TurningTool, memory: Memory) -> None:
    """Bend the tool by the mean force of a turn."""
    met = memory.numbers[CutNumber.MET] > 0.0
    share = share_of_tooth(tool, memory, period) if met else 1.0
    for k in range(2):
        wanted = tool.strength.compliance * memory.scratch.mean[k] if met else 0.0
        memory.bend[k] += share * (wanted - memory.bend[k])


@kernel
def note_load(
    tool: TurningTool, memory: Memory, loads: ToolLoads, row: int, bend: tuple[float, float, float]
) -> None:
    """Enter what the tool feels.

    Args:
        row: In this row.
        bend: Deflection of the tip along X, Y and Z of the machine [mm].
    """
    numbers = memory.numbers
    met = numbers[CutNumber.MET] > 0.0
    speed = numbers[CutNumber.SPEED]
    torque = memory.scratch.figures[1] * MM if met else 0.0
    for k in range(3):
        loads.force[row, k] = memory.load[k]
        loads.deflection[row, k] = bend[k]
    peak = max(memory.scratch.figures[0], abs(memory.scratch.mean[2]))
    loads.peak_force[row] = peak if met else 0.0
    loads.power[row] = 2.0 * math.pi * abs(speed) * torque
    loads.chip[row] = memory.scratch.figures[2] if met else 0.0
    loads.spindle_speed[row] = speed * SECONDS_PER_MINUTE
    loads.spindle_load[row] = torque / lasting_torque(tool.spindle, speed)
    loads.broken[row] = numbers[CutNumber.EDGE]
