"""The spindle's drive: how it comes to speed, what torque it gives, and what the cut takes of it."""

import math
from typing import NamedTuple

from twin.compilation.kernel import kernel
from twin.nc.canonical import FloatArray

_SLOWEST = 1e-6
"""Speed below which a power is no torque [turns/s]."""


class SpindleDrive(NamedTuple):
    """A spindle and its drive.

    Attributes:
        speeds: Speeds at which the power is known, rising, shape (m,) [turns/s]; none: nothing stalls it.
        powers: What it gives for long there, shape (m,) [W].
        overload: What it gives for a short time, as a share of that.
        fastest: Never exceeded [turns/s].
        rate: How fast it changes its speed without a cut [turns/s²].
    """

    speeds: FloatArray
    powers: FloatArray
    overload: float
    fastest: float
    rate: float


@kernel
def lasting_torque(drive: SpindleDrive, speed: float) -> float:
    """Torque that the drive gives for long [N m]; infinite: nothing is known of it."""
    count = len(drive.speeds)
    if count == 0:
        return math.inf
    at = max(abs(speed), _SLOWEST)
    if at <= drive.speeds[0]:
        return drive.powers[0] / (2.0 * math.pi * drive.speeds[0])
    power = drive.powers[count - 1]
    for i in range(count - 1):
        if at < drive.speeds[i + 1]:
            share = (at - drive.speeds[i]) / (drive.speeds[i + 1] - drive.speeds[i])
            power = drive.powers[i] + share * (drive.powers[i + 1] - drive.powers[i])
            break
    return power / (2.0 * math.pi * at)


@kernel
def next_speed(
    drive: SpindleDrive, speed: float, commanded: float, torque: float, period_s: float
) -> float:
    """Speed of the spindle a period later.

    What the cut leaves of the drive's torque turns the spindle up; the moment of inertia is what the
    time to speed tells, J = M/(2 pi rate) with the short torque at rest. A cut that takes more than
    the drive can give slows it down.

    Args:
        speed: Now, signed [turns/s].
        commanded: What the control asks for, signed [turns/s].
        torque: Of the cut, against the turning [N m].
        period_s: Time [s].
    """
    target = min(max(commanded, -drive.fastest), drive.fastest)
    sign = 1.0 if speed > 0.0 or (speed == 0.0 and target >= 0.0) else -1.0
    turns, wanted = sign * speed, sign * target
    rise = fall = drive.rate * period_s
    if len(drive.speeds):
        short = drive.overload * lasting_torque(drive, turns)
        at_rest = drive.overload * lasting_torque(drive, 0.0)
        if torque > short:
            # The drive gives all that it has, and the cut takes more.
            slowing = (torque - short) / at_rest * min(rise, abs(wanted) + _SLOWEST)
            return sign * max(0.0, min(turns - slowing, max(wanted, turns - fall)))
        rise = rise * (short - torque) / short if torque < short else 0.0
    if wanted > turns:
        return sign * min(wanted, turns + rise)
    return sign * max(wanted, turns - fall, 0.0) if wanted >= 0.0 else sign * max(turns - fall, 0.0)
