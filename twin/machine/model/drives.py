"""Servo drives: gains derived from what they move, never typed.

Each axis is one ``<intvelocity>`` actuator, whose input is integrated to the position setpoint p
(``sampling`` says why), and a ``<motor>`` that adds the drive's feed-forward. On the joint
q they push together with

    F = kp (p - q) - kv q' + ff.

On a moved mass m this is a second-order system of natural frequency w and damping ratio z when

    kp = m w²,    kv = 2 z m w.

On a line at constant speed V and with ff = 0 the joint trails by V kv/kp = V 2 z/w. The trade
states that trail as the loop gain Kv = speed/lag, hence

    w = 2 z Kv.

With feed-forward of a share s of the setpoint's velocity and a share r of its acceleration,

    ff = s kv p' + r m p'',

the trail is (1 - s) V/Kv, and with s = r = 1 the joint follows exactly.

Seen as a cascade, this is a position loop of gain Kv around a velocity loop of gain kv. With a reset
time Tn the velocity loop also integrates what is left of its error,

    F += kv/Tn ∫ (Kv (p - q) + s p' - q') dt.

Since q' and p' integrate to q and p, that is kv/Tn (p - q) + kv Kv/Tn ∫ (p - (1 - s) p'/Kv - q) dt: a
stiffer proportional part, and a ``<pid>`` actuator that has nothing but an integrator, whose input is
the setpoint less the trail that is meant to be.

On a line that integrator holds the load less kv/Tn (1 - s) V/Kv, which the stiffer proportional part
pushes too much. It stops where it gives the drive's whole force in addition to that of a rapid: what a drive at
its force limit cannot do does not pile up.

A real drive filters the speed that it measures and gives its force late. A filter of time constant T is a
lag of first order, 1/(1 + T s). A dead time d is taken as its Padé approximation,

    D = (1 - a s)/(1 + a s) = -1 + 2/(1 + a s),    a = d/2,

whose phase is that of exp(-d s) but for (W d)³/12. Since 1/(1 + a s) = 1 - a s/(1 + a s), a force that is D
times the law above needs nothing but the law itself and first-order lags of speeds: with L = 1/(1 + a s)
and M = 1/(1 + T s)

    D (p - q)       = (p - q) - d L (p' - q')
    D ∫ e           = ∫ e - d e + d a L e'
    D M q'          = 2 a/(a - T) L q' - (a + T)/(a - T) M q'.

``tests/machine/simulation/test_delays.py`` holds the simulated axis to the closed forms of delay and filter.
"""

import dataclasses
import math
from typing import NamedTuple

import numpy as np

from twin.machine.description.machine_file import AxisTable
from twin.nc.canonical import FloatArray
from twin.units import kv_per_second, to_si

_APART = 0.01
"""Two lags of one loop differ in time by this share at least: the sum above needs two."""


class Lag(NamedTuple):
    """A force against the axis's speed as a lag of first order shows it."""

    time_s: float
    """Its time constant [s]."""
    gain: float
    """Of the lagging speed [N s/m or N m s/rad]; negative where it pushes along."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Drive:
    """One axis's position loop, in SI.

    Attributes:
        moved: What the motor feels: moved mass [kg] or inertia [kg m²], motor and screw included.
        natural_frequency: w, of the loop without its integrator [rad/s].
        position_gain: Of the position error, kp and what the integrator adds [N/m or N m/rad].
        velocity_gain: kv [N s/m or N m s/rad].
        integral_gain: Of the position error's integral [N/(m s) or N m/(rad s)]; 0: none.
        integral_limit: Where that integral stops [m s or rad s]; 0: nowhere.
        damping_gain: Of the axis's speed as it is, kv where nothing lags [N s/m or N m s/rad].
        lags: Of the axis's speed as lags show it, in place of the rest of kv.
        dead_time_s: d [s].
    """

    moved: float
    natural_frequency: float
    position_gain: float
    velocity_gain: float
    integral_gain: float
    integral_limit: float
    damping_gain: float
    lags: tuple[Lag, ...] = ()
    dead_time_s: float = 0.0


def reflected_inertia(axis: AxisTable) -> float:
    """Inertia of motor and screw as the axis feels it: J (2 pi / lead)².

    Returns:
        Mass [kg] for linear axes, moment of inertia [kg m²] for rotary ones.
    """
    if axis.lead is None:
        return 0.0
    turns_to_travel = 2.0 * math.pi / (axis.lead * to_si(axis.kind))
    return (axis.motor_inertia + axis.screw_inertia) * turns_to_travel**2


def tune(axis: AxisTable, moved: float) -> Drive:
    """Gains of an axis that moves a known mass or inertia.

    Args:
        axis: The axis with its loop gain and damping ratio.
        moved: Mass [kg] or moment of inertia [kg m²], motor and screw included.
    """
    loop_gain = kv_per_second(axis.kv)
    frequency = 2.0 * axis.damping_ratio * loop_gain
    velocity_gain = 2.0 * axis.damping_ratio * moved * frequency
    reset_rate = 1.0 / axis.reset_time_s if axis.reset_time_s else 0.0
    position_gain = moved * frequency**2 + velocity_gain * reset_rate
    integral_gain = velocity_gain * reset_rate * loop_gain
    trail = (1.0 - axis.velocity_feedforward) * axis.velocity * to_si(axis.kind) / loop_gain
    limited = integral_gain > 0.0 and axis.force_limit > 0.0
    most = axis.force_limit + velocity_gain * reset_rate * trail
    late, filtered = axis.loop_delay_s / 2.0, axis.velocity_filter_s
    if filtered and abs(late - filtered) < _APART * late:
        filtered = late * (1.0 + _APART)
    lags = []
    if late:
        doubled = 2.0 * velocity_gain * late / (late - filtered)
        of_position = 2.0 * late * (position_gain - integral_gain * late)
        lags.append(Lag(late, doubled - of_position))
    if filtered:
        share = (late + filtered) / (filtered - late)
        lags.append(Lag(filtered, share * velocity_gain))
    return Drive(
        moved=moved,
        natural_frequency=frequency,
        position_gain=position_gain - 2.0 * late * integral_gain,
        velocity_gain=velocity_gain,
        integral_gain=integral_gain,
        integral_limit=most / integral_gain if limited else 0.0,
        damping_gain=0.0 if filtered else -velocity_gain if late else velocity_gain,
        lags=tuple(lags),
        dead_time_s=axis.loop_delay_s,
    )


def is_unstable(drive: Drive) -> bool:
    """Whether the loop, on a rigid axis without friction, grows by itself because of its lags."""
    width = 3 + len(drive.lags)
    rates: FloatArray = np.zeros((width, width))
    rates[0, 1] = 1.0
    rates[1, :3] = [-drive.position_gain, -drive.damping_gain, drive.integral_gain]
    rates[2, 0] = -1.0
    for row, lag in enumerate(drive.lags, start=3):
        rates[1, row] = -lag.gain
        rates[row, 1], rates[row, row] = 1.0 / lag.time_s, -1.0 / lag.time_s
    rates[1] /= drive.moved
    kept = [row for row in range(width) if row != 2 or drive.integral_gain]
    return bool(np.linalg.eigvals(rates[np.ix_(kept, kept)]).real.max() > 0.0)


def feedforward_name(axis: str) -> str:
    """Name of the actuator that adds an axis's feed-forward."""
    return f"{axis} feed-forward"


def integral_name(axis: str) -> str:
    """Name of the actuator that integrates what an axis leaves behind."""
    return f"{axis} integral"


def lag_name(axis: str, number: int) -> str:
    """Name of the actuator that pushes by the speed of an axis as a lag shows it."""
    return f"{axis} lag {number + 1}"
