"""Transmission and resistance of an axis: inertia, backlash, stiffness, friction.

A rigid axis is one joint that carries the motor's inertia as armature. Backlash or a springy screw
splits it in two coincident joints: the first is the motor (with the armature, and the position loop
closed on it), the second the give between motor and axis. The axis is where both together say.

A screw without backlash is a spring with a damper on the give. With backlash the give runs between
two walls, which are limits of its joint, and nothing acts within the gap:

    F = k p + c p'   (pushing only)   for p = |x| - gap/2 > 0.

A limit of MuJoCo gives its force from acceleration: F = (K p + B p' - p'')/R, with R = (1 - d)/(d m) for an
impedance d and the mass m that swings. d is so small that the term of p'' is a thousandth of m; K and B
follow from k and c.

Friction acts where the guides are, on the motion of the axis: on the joint of a rigid axis, on a
tendon over both joints otherwise.
"""

import math

import mujoco
import numpy as np

from twin.machine.description.machine_file import AxisTable
from twin.machine.model.drives import reflected_inertia
from twin.units import to_si

FASTEST_SPRING = 1.0
"""Natural frequency times step of the stiffest spring: RK4 follows it with a frequency
that is 0.6 % low, and takes 0.6 % of its swing in a step; at twice as much it takes a quarter."""
WALL_SUBSTEPS = 2
"""Steps of a servo period where the walls of a gap are rigid: they are springs that this step can just
follow, of 1000 N/µm where half a tonne swings at 1 kHz."""
_WALL_IMPEDANCE = 0.001
"""d above."""
FASTEST = 2.0
"""Rate of a loop or spring, times the step, that is still simulated; RK4 diverges from 2.78 on."""
GIVE_DAMPING_RATIO = 0.1
"""Of the spring between motor and axis. Assumed: screws ring, but not for long."""
_TOLERANCE = 1e-14
"""Of MuJoCo's solver where there are walls: by its own of 1e-8 it keeps a force that has changed by little, and
an axis at rest on a wall trembles by up to a hundredth of a micrometre."""
_ROUNDING = 1e-9
_NO_INPUT = 16
"""What MuJoCo calls ``input="none"``: an actuator without controls, here a passive friction."""
_SOLREF_FRICTION = (0.002, 1.0)
_SOLIMP_FRICTION = (0.9999, 0.9999, 0.001, 0.5, 2.0)
"""Keep dry friction from creeping: below 0.1 µm/s under half the friction force."""


def give_name(axis: AxisTable) -> str:
    """Joint between motor and axis, where the transmission gives."""
    return f"{axis.joint} give"


def has_give(axis: AxisTable) -> bool:
    """Whether motor and axis are two joints."""
    return axis.backlash > 0 or axis.stiffness > 0


def directly_driven(axis: AxisTable, moved: float) -> float:
    """What the motor accelerates at once: itself alone where the transmission gives [kg or kg m²]."""
    return reflected_inertia(axis) if has_give(axis) else moved


def swinging(axis: AxisTable, moved: float) -> float:
    """What swings on the spring between motor and axis: both masses in series [kg or kg m²]."""
    reflected = reflected_inertia(axis)
    return reflected * (moved - reflected) / moved


def give_stiffness(axis: AxisTable, moved: float, period_s: float) -> float:
    """Of what lies between motor and axis, or of the walls of its gap where that is rigid.

    Args:
        axis: The axis; its transmission gives.
        moved: Moved mass [kg] or inertia [kg m²], motor and screw included.
        period_s: The servo period [s].

    Returns:
        [N/m or N m/rad].
    """
    if axis.stiffness:
        return axis.stiffness / to_si(axis.kind)
    return swinging(axis, moved) * (FASTEST_SPRING * WALL_SUBSTEPS / period_s) ** 2


def give_substeps(axis: AxisTable, moved: float, period_s: float) -> int:
    """Steps per servo period that the spring between motor and axis needs."""
    if not has_give(axis):
        return 1
    rate = math.sqrt(give_stiffness(axis, moved, period_s) / swinging(axis, moved))
    return max(1, math.ceil(rate * period_s / FASTEST_SPRING - _ROUNDING))


def add_inertia(spec: mujoco.MjSpec, axis: AxisTable) -> None:
    """Let the joint carry motor and screw, and the counterbalance the weight."""
    joint = spec.joint(axis.joint)
    joint.armature = reflected_inertia(axis)
    if axis.counterbalance is not None:
        body = joint.parent
        for carried in (body, *body.find_all("body")):
            carried.gravcomp = axis.counterbalance


def add_friction_and_give(
    spec: mujoco.MjSpec, axis: AxisTable, moved: float, period_s: float
) -> None:
    """Add what makes an axis less than ideal.

    Args:
        spec: The model, its joints inert so far.
        moved: Moved mass [kg] or inertia [kg m²], motor and screw included.
        period_s: The servo period [s].
    """
    joint = spec.joint(axis.joint)
    resisted: mujoco.MjsJoint | mujoco.MjsTendon = joint
    if has_give(axis):
        resisted = _add_give(spec, axis, moved, period_s)
    unit = to_si(axis.kind)
    resisted.damping = np.array([axis.viscous_friction / unit, 0.0, 0.0])
    if axis.lugre is None:
        resisted.frictionloss = axis.dry_friction
        resisted.solref_friction = np.array(_SOLREF_FRICTION)
        resisted.solimp_friction = np.array(_SOLIMP_FRICTION)
    else:
        _add_lugre(spec, axis, resisted)


def _add_give(
    spec: mujoco.MjSpec, axis: AxisTable, moved: float, period_s: float
) -> mujoco.MjsTendon:
    """Split the joint; return the tendon that measures the motion of the axis."""
    motor = spec.joint(axis.joint)
    give = motor.parent.add_joint(
        name=give_name(axis), type=motor.type, axis=list(motor.axis), pos=list(motor.pos)
    )
    unit = to_si(axis.kind)
    free = swinging(axis, moved)
    stiffness = give_stiffness(axis, moved, period_s)
    damping = 2.0 * GIVE_DAMPING_RATIO * math.sqrt(stiffness * free)
    if axis.backlash:
        in_degrees = spec.compiler.degree and axis.kind == "rotary"
        share = _WALL_IMPEDANCE
        spec.option.tolerance = _TOLERANCE
        give.limited = True
        give.range = np.array([-0.5, 0.5]) * axis.backlash * (1.0 if in_degrees else unit)
        give.solref_limit = -np.array([stiffness, damping]) * (1.0 - share) / free
        give.solimp_limit = np.array([share, share, 1.0, 0.5, 2.0])
    else:
        spring = spec.add_tendon(name=give_name(axis))
        spring.wrap_joint(give.name, 1.0)
        spring.stiffness = np.array([stiffness, 0.0, 0.0])
        spring.damping = np.array([damping, 0.0, 0.0])
    guide = spec.add_tendon(name=f"{axis.joint} guide")
    guide.wrap_joint(motor.name, 1.0)
    guide.wrap_joint(give.name, 1.0)
    return guide


def _add_lugre(
    spec: mujoco.MjSpec, axis: AxisTable, resisted: "mujoco.MjsJoint | mujoco.MjsTendon"
) -> None:
    assert axis.lugre is not None
    unit = to_si(axis.kind)
    on_tendon = isinstance(resisted, mujoco.MjsTendon)
    friction = spec.add_actuator(
        name=f"{axis.joint} friction",
        target=resisted.name,
        trntype=mujoco.mjtTrn.mjTRN_TENDON if on_tendon else mujoco.mjtTrn.mjTRN_JOINT,
    )
    friction.set_to_dcmotor(
        motorconst=[0.0, 0.0],
        resistance=1.0,
        lugre=[
            axis.lugre.stiffness / unit,
            axis.lugre.damping / unit,
            axis.dry_friction,
            axis.lugre.static_friction or axis.dry_friction,
            axis.lugre.stribeck_velocity * unit,
        ],
        ctrlspec=_NO_INPUT,
    )
