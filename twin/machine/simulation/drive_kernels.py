"""What the drives hold between setpoints, and what comes of it in the axes' own units."""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import array_kernel, kernel
from twin.machine.simulation.sampling import held_acceleration, held_velocity, polyline_node
from twin.nc.canonical import FloatArray, IntArray


class Drives(NamedTuple):
    """The drives of k axes and where they lie in the model, whose state is time, qpos, qvel, act.

    Attributes:
        period: The servo period [s].
        scale: SI units per mm or deg of each axis, as its joint turns or slides, shape (k,); so on.
        position_gain: Force per position.
        velocity_gain: Force per velocity, as far as none is late.
        integral_gain: Force per integral of the position's error; 0: the drive has no integrator.
        velocity_feedforward: Force that is added in advance per commanded velocity.
        acceleration_feedforward: Force that is added in advance per commanded acceleration.
        trail: How long an axis that the integrator has settled trails its setpoint [s].
        speed_bulge: What the motor's speed is higher between samples than at them, on average, per
            commanded acceleration [s]: the commanded speed is constant over a step.
        limit: Of the force [N or N m].
        constant: Force from outside that never changes [N or N m].
        velocity_input: Control that tells the drive its velocity.
        force_input: Control that tells the drive a force.
        position_input: Control that tells the integrator where it should stand; -1: there is none.
        qpos: Column of the state that tells the motor's position.
        qvel: Column of the state that tells the motor's velocity.
        dof: Degree of freedom of the motor.
        give_qpos: Column of the state that tells how far the axis is off its motor; -1: it is not.
        give_qvel: Column of the state that tells how fast that changes.
        give_dof: Degree of freedom of it.
        integral: Column of the state that tells the integral; -1: there is none.
    """

    period: float
    scale: FloatArray
    position_gain: FloatArray
    velocity_gain: FloatArray
    integral_gain: FloatArray
    velocity_feedforward: FloatArray
    acceleration_feedforward: FloatArray
    trail: FloatArray
    speed_bulge: FloatArray
    limit: FloatArray
    constant: FloatArray
    velocity_input: IntArray
    force_input: IntArray
    position_input: IntArray
    qpos: IntArray
    qvel: IntArray
    dof: IntArray
    give_qpos: IntArray
    give_qvel: IntArray
    give_dof: IntArray
    integral: IntArray


class DriveSetpoints(NamedTuple):
    """Setpoints, as far as drives receive them: shape (n, k) each."""

    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray


@kernel
def all_finite(points: DriveSetpoints) -> bool:
    """Whether all of them are finite numbers."""
    for row in range(points.position.shape[0]):
        for axis in range(points.position.shape[1]):
            # What is not finite makes the sum so.
            total = abs(points.position[row, axis]) + abs(points.velocity[row, axis])
            if not math.isfinite(total + abs(points.acceleration[row, axis])):
                return False
    return True


@array_kernel
def hold_controls(
    drives: Drives, past: DriveSetpoints, points: DriveSetpoints, width: int
) -> FloatArray:
    """Controls to hold during the step to each setpoint.

    Args:
        past: Setpoints that went before, of which the last counts.
        points: n setpoints.
        width: Of the model's controls.

    Returns:
        Shape (n, width), SI.
    """
    count, axes = points.position.shape
    h, last = drives.period, len(past.position) - 1
    controls = np.zeros((count, width))
    for axis in range(axes):
        scale = drives.scale[axis]
        before = polyline_node(past.position[last, axis], past.acceleration[last, axis], h)
        speed_before = past.velocity[last, axis]
        for row in range(count):
            node = polyline_node(points.position[row, axis], points.acceleration[row, axis], h)
            velocity = held_velocity(before, node, h)
            acceleration = held_acceleration(speed_before, points.velocity[row, axis], h)
            controls[row, drives.velocity_input[axis]] = velocity * scale
            controls[row, drives.force_input[axis]] = _feedforward_force(
                drives, axis, velocity, acceleration
            )
            if drives.position_input[axis] >= 0:
                meant = (node + before) / 2 - drives.trail[axis] * velocity
                controls[row, drives.position_input[axis]] = meant * scale
                # Within a step the axis passes under the held input, and the integral bulges by V h²/12.
                bulge = h**2 / 12 * (velocity * scale)
                controls[row, drives.force_input[axis]] -= drives.integral_gain[axis] * bulge
            before, speed_before = node, points.velocity[row, axis]
    return controls


@array_kernel
def hold_pushes(drives: Drives, load: FloatArray, width: int) -> FloatArray:
    """Load and constant forces as generalised forces; they act beyond what gives.

    Args:
        load: What pushes the axes from outside, shape (n, k) [N or N m].
        width: The model's degrees of freedom.

    Returns:
        Shape (n, width).
    """
    pushes = np.zeros((len(load), width))
    for row in range(len(load)):
        hold_push(drives, load[row], pushes[row])
    return pushes


@kernel
def hold_push(drives: Drives, load: FloatArray, pushed: FloatArray) -> None:
    """One row of ``hold_pushes``.

    Args:
        load: What pushes the axes from outside, shape (k,) [N or N m].
        pushed: Set where an axis is pushed, shape (width,).
    """
    for axis in range(len(load)):
        push = (load[axis] + drives.constant[axis]) * np.sign(drives.scale[axis])
        pushed[drives.dof[axis]] = push
        if drives.give_dof[axis] >= 0:
            pushed[drives.give_dof[axis]] = push


@array_kernel
def read_states(
    drives: Drives, points: DriveSetpoints, states: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The axes in states of the model.

    The force is what the drives push with around the instants of the samples, on average over the
    step, within their limits.
    It is taken from the setpoint itself: at a corner of the polyline that is drawn through it the
    push is off by kp h²/12 a for a part of the step.

    Args:
        points: The setpoints of the same instants.
        states: Shape (n, width).

    Returns:
        Position [mm or deg], velocity [mm/s or deg/s] and force [N or N m], shape (n, k) each.
    """
    count, axes = points.position.shape
    position, velocity = np.zeros((count, axes)), np.zeros((count, axes))
    force = np.zeros((count, axes))
    for row in range(count):
        for axis in range(axes):
            scale, limit = drives.scale[axis], drives.limit[axis]
            motor = states[row, drives.qpos[axis]] / scale
            speed = states[row, drives.qvel[axis]] / scale
            push = drives.position_gain[axis] * ((points.position[row, axis] - motor) * scale)
            bulge = drives.speed_bulge[axis] * points.acceleration[row, axis]
            push -= drives.velocity_gain[axis] * (speed + bulge) * scale
            push += _feedforward_force(
                drives, axis, points.velocity[row, axis], points.acceleration[row, axis]
            )
            if drives.integral[axis] >= 0:
                # Its input trails the polyline, whose nodes the setpoint passes at h²/12 a.
                node_loss = drives.trail[axis] * (drives.period**2 / 12)
                off = node_loss * (points.acceleration[row, axis] * scale)
                integral = states[row, drives.integral[axis]] - off
                push += drives.integral_gain[axis] * integral
            force[row, axis] = min(max(push * np.sign(scale), -limit), limit)
            if drives.give_qpos[axis] >= 0:
                motor += states[row, drives.give_qpos[axis]] / scale
                speed += states[row, drives.give_qvel[axis]] / scale
            position[row, axis], velocity[row, axis] = motor, speed
    return position, velocity, force


@kernel
def _feedforward_force(drives: Drives, axis: int, velocity: float, acceleration: float) -> float:
    """Force that a drive adds in advance [N or N m]."""
    return drives.scale[axis] * (
        drives.velocity_feedforward[axis] * velocity
        + drives.acceleration_feedforward[axis] * acceleration
    )
