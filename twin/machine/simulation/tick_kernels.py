"""Few servo periods at once, with a single call from Python: what a control asks for that reacts to each.

The rules are those of ``drive_kernels``; what is saved are the calls into compiled code, which for
every array that is handed over costs a good part of a step.
"""

from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import array_kernel
from twin.machine.simulation.drive_kernels import (
    Drives,
    DriveSetpoints,
    all_finite,
    hold_controls,
    hold_pushes,
    read_states,
)
from twin.machine.simulation.stepping import Stepper, pass_state, step_machine
from twin.nc.canonical import FloatArray, IntArray


class Loop(NamedTuple):
    """A machine that is stepped, in as few arrays as hold it.

    Attributes:
        substeps: Steps in a servo period.
        signature: Which parts of the state are kept.
        period: Of ``Drives``.
        numbers: Its columns of numbers, in their order, shape (., k).
        places: Its columns of places, in their order, shape (., k).
        control: The data's controls, shape (nu,).
        pushed: The data's applied forces, shape (nv,).
    """

    stepper: Stepper
    substeps: int
    signature: int
    period: float
    numbers: FloatArray
    places: IntArray
    control: FloatArray
    pushed: FloatArray


class SteppedSamples(NamedTuple):
    """What came of n setpoints; no rows where one of them is not finite.

    Attributes:
        states: Of the model, shape (n, width).
        position: Of the axes, shape (n, k) [mm or deg].
        velocity: Likewise [mm/s or deg/s].
        force: Of the drives, shape (n, k) [N or N m].
    """

    states: FloatArray
    position: FloatArray
    velocity: FloatArray
    force: FloatArray


def loop_of(
    drives: Drives, stepper: Stepper, steps: tuple[int, int], arrays: tuple[FloatArray, FloatArray]
) -> Loop:
    """Lay out what the kernels take.

    Args:
        steps: Steps in a servo period, and the signature of the state.
        arrays: Of the data: controls and applied forces.
    """
    floats = [column for column in drives[1:] if column.dtype == np.float64]
    others = [column for column in drives[1:] if column.dtype != np.float64]
    numbers, places = np.array(floats, np.float64), np.array(others, np.int64)
    return Loop(stepper, *steps, drives.period, numbers, places, *arrays)


@array_kernel
def follow_setpoints(
    loop: Loop, state: FloatArray, past: DriveSetpoints, points: DriveSetpoints, load: FloatArray
) -> SteppedSamples:
    """Step from setpoint to setpoint, to the last bit as ``mujoco.rollout`` does.

    Args:
        state: Where it has come to, shape (width,).
        past: Setpoints that went before, of which the last counts.
        points: n setpoints.
        load: What pushes the axes from outside during the step to each, shape (n, k) [N or N m].
    """
    drives = _drives(loop)
    if not all_finite(points):
        none = np.zeros((0, len(drives.scale)))
        return SteppedSamples(np.zeros((0, len(state))), none, none, none)
    controls = hold_controls(drives, past, points, len(loop.control))
    pushes = hold_pushes(drives, load, len(loop.pushed))
    states = step_held(loop, state, controls, pushes)
    position, velocity, force = read_states(drives, points, states)
    return SteppedSamples(states, position, velocity, force)


@array_kernel
def step_held(
    loop: Loop, state: FloatArray, controls: FloatArray, pushes: FloatArray
) -> FloatArray:
    """Step with controls and forces that are held over a servo period each.

    Args:
        loop: The machine, whose solver begins at its warm start.
        state: Where it has come to, shape (width,).
        controls: Shape (n, nu).
        pushes: Applied forces, shape (n, nv).

    Returns:
        The states that it comes to, shape (n, width).
    """
    stepper, signature = loop.stepper, np.int64(loop.signature)
    pass_state(stepper.set_state, stepper.model, stepper.data, state.ctypes.data, signature)
    states = np.zeros((len(controls), len(state)))
    for row in range(len(controls)):
        loop.control[:] = controls[row]
        loop.pushed[:] = pushes[row]
        for _ in range(loop.substeps):
            step_machine(stepper.step, stepper.model, stepper.data)
        kept = states[row].ctypes.data
        pass_state(stepper.get_state, stepper.model, stepper.data, kept, signature)
    loop.pushed[:] = 0.0
    return states


@array_kernel
def _drives(loop: Loop) -> Drives:
    """The drives, as they were laid out."""
    numbers, places = loop.numbers, loop.places
    return Drives(
        loop.period,
        numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5],
        numbers[6], numbers[7], numbers[8], numbers[9],
        places[0], places[1], places[2], places[3], places[4], places[5],
        places[6], places[7], places[8], places[9],
    )  # fmt: skip
