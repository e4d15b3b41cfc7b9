"""Which control a drive holds over a step, so that a perfect drive shows no error of the simulator.

Sample i of the recording belongs to the instant of setpoint i, and a control is held from sample i
to sample i + 1. The drives hold a *velocity* and integrate it, so that their position setpoint is
the polyline through the setpoints: at every sample it is where the setpoint stands, whatever
the integrator, and no sample of slip is possible.

Why not hold a position? A held position is a staircase, worth the setpoint in the middle of its
step. The samples lie at the step's borders, where the staircase is off by V h/2 (25 µm at F3000):
the drive pushes kp V h/2 too hard at the start of each step and as much too little at its end (29 kN
on an axis of 1.8 t at 30 m/min). The mean is right, but a force limit cuts the tips off, and
every sampled velocity is low by w² h²/12, which is half a percent at w = 250 rad/s.

A polyline has an error of its own: it cuts corners. Drawn through the samples of sin(W t) it
contains that sine with the amplitude (sin(x)/x)², x = W h/2, that is 1 - (W h)²/12 and higher
terms, in phase. Since the sine's second derivative is -W² times itself, the nodes are moved to

    p - h²/12 a,

which undoes the loss to the second order. The velocity that runs from node to node,

    u = (p1 - p0)/h - h/12 (a1 - a0),

is at the same time what a drive must be commanded as its velocity: the setpoint's velocity, held, with
the loss of holding ((W h)²/24) undone, to the same order. The acceleration that belongs to it is the
mean of the step, (v1 - v0)/h. ``tests/machine/test_sampling.py`` holds all of this to closed forms.
"""

from typing import TypeVar

from twin.compilation.kernel import array_kernel
from twin.nc.canonical import FloatArray

Value = TypeVar("Value", float, FloatArray)
"""One axis, or several and their samples as an array."""

_POLYLINE_LOSS = 1.0 / 12.0
"""Second-order loss of a signal drawn as a polyline, in units of (W h)²."""


@array_kernel
def polyline_node(position: Value, acceleration: Value, period_s: float) -> Value:
    """Where a drive's position setpoint is at a sample; elementwise of arrays.

    Args:
        position: Of the setpoint [mm or deg].
        acceleration: Of the setpoint [mm/s² or deg/s²].
        period_s: The servo period h, which is also the step [s].
    """
    return position - _POLYLINE_LOSS * period_s**2 * acceleration


@array_kernel
def held_velocity(node: Value, next_node: Value, period_s: float) -> Value:
    """The velocity that leads from one node to the next; elementwise of arrays."""
    return (next_node - node) / period_s


@array_kernel
def held_acceleration(velocity: Value, next_velocity: Value, period_s: float) -> Value:
    """The acceleration that belongs to the step between two setpoints; elementwise of arrays."""
    return (next_velocity - velocity) / period_s
