"""The machine stepped while its tool cuts: one loop over setpoints, without a way back to Python."""

import enum
import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import array_kernel, kernel
from twin.coupling.spindle_kernels import SpindleDrive, lasting_torque, next_speed
from twin.cutting.forces.tool_strength import ToolStrength
from twin.cutting.kernels.sweep import ALL_ROWS, Marks, sweep
from twin.cutting.kernels.tooth_forces import (
    CutterForm,
    ForceLaw,
    ToothScratch,
    add_force_between,
    tooth_forces,
)
from twin.cutting.kernels.walls import Material, leave_walls, lose_trace
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


class Edge(enum.IntEnum):
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
    """Its ``Edge``."""
    VALUE = 4
    """At which the edge went."""
    MET = 5
    """Whether it meets material."""
    FRESH = 6
    """Whether nothing is known of where it was."""
    STOOD = 7
    """Whether it has cut all that it meets where it was swept up to."""


class Place(NamedTuple):
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
    """A tool in a material.

    Attributes:
        material: The height map, which is cut.
        cutter: The tool's edges.
        law: What the material does to them.
        strength: What the tool gives way to.
        spindle: What turns it.
        place: Where the part is.
    """

    material: Material
    cutter: CutterForm
    law: ForceLaw
    strength: ToolStrength
    spindle: SpindleDrive
    place: Place


class Memory(NamedTuple):
    """What is carried from one period to the next.

    Attributes:
        numbers: By ``CutNumber``.
        rigid: Where the tip would be, were the tool rigid, part's frame, shape (3,) [mm].
        swept: Where the material was cut up to, shape (2, 3); the second row is the later [mm].
        trace: Where it has left walls up to, of ``leave_walls``.
        speed: Speed of the tip in the mean of a tooth, shape (3,) [mm/s].
        looked: Feed per tooth when the material was looked at, shape (3,) [mm].
        bend: Deflection of the tip in the part's frame, shape (3,) [mm].
        load: What pushes the axes, shape (k,) [N or N m].
        scratch: The teeth's forces.
        force: On the tool in this period, part's frame, shape (3,) [N].
        feed: Feed per tooth in this period, shape (3,) [mm].
        sums: What ``sweep`` adds to, shape (1, 2, 4).
        marks: Nothing is marked.
    """

    numbers: FloatArray
    rigid: FloatArray
    swept: FloatArray
    trace: FloatArray
    speed: FloatArray
    looked: FloatArray
    bend: FloatArray
    load: FloatArray
    scratch: ToothScratch
    force: FloatArray
    feed: FloatArray
    sums: FloatArray
    marks: Marks


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


@array_kernel
def follow_cutting(
    physics: Physics,
    controls: FloatArray,
    states: FloatArray,
    commanded: FloatArray,
    cut: Cut,
    memory: Memory,
    loads: ToolLoads,
) -> None:
    """Step the machine from setpoint to setpoint while its tool cuts.

    In every period the axes are pushed by the force that the teeth felt at its beginning, in the
    mean over the angle that they turn in a period.

    Args:
        physics: The machine.
        controls: What the drives are commanded on the way to each setpoint, shape (n, nu).
        states: Set to the states there, shape (n, width).
        commanded: Speed that the spindle is commanded, shape (n,) [turns/s]; NaN: nothing is known of it.
        cut: Tool and material.
        memory: Carried on.
        loads: Set to what the tool felt.
    """
    stepper = physics.stepper
    for row in range(len(controls)):
        hold_push(physics.drives, memory.load, physics.pushed)
        physics.control[:] = controls[row]
        for _ in range(physics.substeps):
            step_machine(stepper.step, stepper.model, stepper.data)
        place = states[row].ctypes.data
        pass_state(
            stepper.get_state, stepper.model, stepper.data, place, np.int64(physics.signature)
        )
        cosine, sine = _go_to(physics, states[row], cut, memory)
        _turn_and_cut(physics.drives.period, commanded[row], cut, memory)
        _bend(physics.drives.period, cut, memory)
        _load_axes(cut.place, memory, cosine, sine)
        _note(cut, memory, loads, row, (cosine, sine))
    physics.pushed[:] = 0.0


@kernel
def _go_to(physics: Physics, state: FloatArray, cut: Cut, memory: Memory) -> tuple[float, float]:
    """Move the rigid tool's tip to where the axes are; cosine and sine of the part's turn."""
    drives, numbers, place = physics.drives, memory.numbers, cut.place
    x = _axis(drives, state, 0) - place.center[0]
    y = _axis(drives, state, 1) - place.center[1]
    z = _axis(drives, state, 2) - place.length_difference
    cosine, sine = 1.0, 0.0
    if place.rotary >= 0:
        turn = math.radians(_axis(drives, state, place.rotary) - place.turn_zero)
        cosine, sine = math.cos(turn), math.sin(turn)
    tip = (cosine * x - sine * y, sine * x + cosine * y, z)
    # A chip is as thick as the way between two teeth: the speed in the mean of that time.
    share = _share_of_tooth(cut, memory, drives.period)
    for k in range(3):
        if numbers[CutNumber.FRESH] > 0.0:
            numbers[CutNumber.STOOD] = 0.0
            lose_trace(memory.trace)
            memory.speed[k] = 0.0
            memory.swept[0, k] = memory.swept[1, k] = tip[k]
        else:
            now = (tip[k] - memory.rigid[k]) / drives.period
            memory.speed[k] += share * (now - memory.speed[k])
        memory.rigid[k] = tip[k]
    numbers[CutNumber.FRESH] = 0.0
    return cosine, sine


@kernel
def _axis(drives: Drives, state: FloatArray, axis: int) -> float:
    """Where an axis is beyond what gives [mm or deg]."""
    place = state[drives.qpos[axis]]
    if drives.give_qpos[axis] >= 0:
        place += state[drives.give_qpos[axis]]
    return place / drives.scale[axis]


@kernel
def _share_of_tooth(cut: Cut, memory: Memory, period: float) -> float:
    """How far a mean over the time between two teeth follows in a period, 0 to 1."""
    rate = max(abs(memory.numbers[CutNumber.SPEED]) * cut.cutter.teeth, 1.0 / _LONGEST_MEAN_S)
    return 1.0 - math.exp(-rate * period)


@array_kernel
def _turn_and_cut(period: float, commanded: float, cut: Cut, memory: Memory) -> None:
    """Turn the spindle, cut, and find what the teeth feel until the next period."""
    numbers = memory.numbers
    torque = memory.scratch.figures[1] * MM if numbers[CutNumber.MET] > 0.0 else 0.0
    told = 0.0 if math.isnan(commanded) else commanded
    numbers[CutNumber.SPEED] = next_speed(
        cut.spindle, numbers[CutNumber.SPEED], told, torque, period
    )
    memory.force[:] = 0.0
    if math.isnan(commanded) or numbers[CutNumber.EDGE] != Edge.WHOLE.value:
        # What cuts nothing goes where it will: the next cut begins where the tool is then.
        numbers[CutNumber.MET], numbers[CutNumber.FRESH] = 0.0, 1.0
        return
    turned = numbers[CutNumber.SPEED] * period
    if abs(numbers[CutNumber.SPEED]) > cut.strength.speed / SECONDS_PER_MINUTE:
        _break(memory, Edge.BY_SPEED, abs(numbers[CutNumber.SPEED]) * SECONDS_PER_MINUTE)
        return
    _look(period, cut, memory)
    if numbers[CutNumber.MET] > 0.0:
        if memory.scratch.figures[2] > cut.strength.chip:
            _break(memory, Edge.BY_CHIP, memory.scratch.figures[2])
        elif memory.scratch.figures[0] > cut.strength.force:
            _break(memory, Edge.BY_FORCE, memory.scratch.figures[0])
        elif memory.scratch.figures[1] * MM > cut.strength.torque:
            _break(memory, Edge.BY_TORQUE, memory.scratch.figures[1] * MM)
        elif memory.scratch.mean[2] > cut.strength.thrust:
            _break(memory, Edge.BY_THRUST, memory.scratch.mean[2])
        else:
            add_force_between(
                cut.cutter, memory.scratch, numbers[CutNumber.ANGLE], -turned, memory.force
            )
    numbers[CutNumber.ANGLE] -= turned
    numbers[CutNumber.ANGLE] -= math.floor(numbers[CutNumber.ANGLE])


@kernel
def _break(memory: Memory, why: Edge, value: float) -> None:
    memory.numbers[CutNumber.EDGE], memory.numbers[CutNumber.VALUE] = why.value, value
    memory.numbers[CutNumber.MET] = 0.0


@array_kernel
def _look(period: float, cut: Cut, memory: Memory) -> None:
    """Cut up to where the tool is and look at what is before it, where it has gone far enough."""
    numbers, swept, looked, feed = memory.numbers, memory.swept, memory.looked, memory.feed
    pace = math.sqrt(memory.speed[0] ** 2 + memory.speed[1] ** 2 + memory.speed[2] ** 2)
    if numbers[CutNumber.MET] <= 0.0:
        numbers[CutNumber.CONTACT] = 0.0
    numbers[CutNumber.CONTACT] += pace * period
    teeth = max(abs(numbers[CutNumber.SPEED]) * cut.cutter.teeth, _STILL)
    # The first tooth cuts no more than the tool has come into the material.
    share = min(1.0 / teeth, numbers[CutNumber.CONTACT] / max(pace, _STILL))
    moved, changed, before = 0.0, 0.0, 0.0
    for k in range(3):
        feed[k] = memory.speed[k] * share
        moved += (memory.rigid[k] + memory.bend[k] - swept[1, k]) ** 2
        changed += (feed[k] - looked[k]) ** 2
        before += looked[k] ** 2
    near = LOOK_CELLS * cut.material.grid.cell
    if moved < near * near and changed <= LOOK_FEED * LOOK_FEED * before:
        return
    for k in range(3):
        swept[0, k] = swept[1, k]
        swept[1, k] = memory.rigid[k] + memory.bend[k]
        looked[k] = feed[k]
    if min(swept[0, 2], swept[1, 2]) >= cut.material.grid.top:
        numbers[CutNumber.MET] = 0.0
        lose_trace(memory.trace)
        return
    material = cut.material
    sweep(
        material.heights, material.grid, swept, cut.cutter.profile,
        memory.sums, memory.marks, numbers[CutNumber.STOOD] > 0.0, ALL_ROWS,
    )  # fmt: skip
    numbers[CutNumber.STOOD] = 1.0
    leave_walls(material, memory.trace, swept[1], cut.cutter.profile.radius, cut.cutter.side_from)
    sense = 1.0 if numbers[CutNumber.SPEED] >= 0.0 else -1.0
    met = tooth_forces(material, swept[1], feed, cut.cutter, cut.law, sense, memory.scratch)
    numbers[CutNumber.MET] = 1.0 if met else 0.0


@kernel
def _bend(period: float, cut: Cut, memory: Memory) -> None:
    """Bend the tool by the mean force of a turn."""
    met = memory.numbers[CutNumber.MET] > 0.0
    share = _share_of_tooth(cut, memory, period) if met else 1.0
    for k in range(2):
        wanted = cut.strength.compliance * memory.scratch.mean[k] if met else 0.0
        memory.bend[k] += share * (wanted - memory.bend[k])


@kernel
def _load_axes(place: Place, memory: Memory, cosine: float, sine: float) -> None:
    """What the force on the tool pushes the axes with."""
    force, load, tip = memory.force, memory.load, memory.rigid
    load[0] = cosine * force[0] + sine * force[1]
    load[1] = cosine * force[1] - sine * force[0]
    load[2] = force[2]
    if place.rotary >= 0:
        load[place.rotary] = MM * (tip[0] * force[1] - tip[1] * force[0])


@kernel
def _note(cut: Cut, memory: Memory, loads: ToolLoads, row: int, turn: tuple[float, float]) -> None:
    """Enter what the tool feels."""
    numbers, bend = memory.numbers, memory.bend
    met = numbers[CutNumber.MET] > 0.0
    speed = numbers[CutNumber.SPEED]
    torque = memory.scratch.figures[1] * MM if met else 0.0
    for k in range(3):
        loads.force[row, k] = memory.load[k]
    loads.deflection[row, 0] = turn[0] * bend[0] + turn[1] * bend[1]
    loads.deflection[row, 1] = turn[0] * bend[1] - turn[1] * bend[0]
    loads.deflection[row, 2] = bend[2]
    peak = max(memory.scratch.figures[0], abs(memory.scratch.mean[2]))
    loads.peak_force[row] = peak if met else 0.0
    loads.power[row] = 2.0 * math.pi * abs(speed) * torque
    loads.chip[row] = memory.scratch.figures[2] if met else 0.0
    loads.spindle_speed[row] = speed * SECONDS_PER_MINUTE
    loads.spindle_load[row] = torque / lasting_torque(cut.spindle, speed)
    loads.broken[row] = numbers[CutNumber.EDGE]
