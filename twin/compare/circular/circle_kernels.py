"""Collecting an actual path around a circle by angle, point by point."""

import math

from twin.compilation.kernel import array_kernel


@array_kernel
def collect_by_angle(points, radius, count, angle_sum, deviation_sum, least, greatest):
    """Sort points into bins of angle.

    Args:
        points: Relative to the centre, shape (n, 2) [mm].
        radius: Of the circle [mm].
        count: By bin: how many points, added to, shape (m,).
        angle_sum: By bin: sum of their angles, added to, shape (m,) [rad].
        deviation_sum: By bin: sum of their radial deviations, added to, shape (m,) [mm].
        least: By bin: least radial deviation [mm] and its angle [rad], shape (m, 2).
        greatest: By bin: greatest radial deviation [mm] and its angle [rad], shape (m, 2).
    """
    turn = 2.0 * math.pi
    bins = len(count)
    for i in range(len(points)):
        x, y = points[i]
        angle = math.atan2(y, x)
        if angle < 0.0:
            angle += turn
        deviation = math.sqrt(x * x + y * y) - radius
        here = min(int(angle * (bins / turn)), bins - 1)
        count[here] += 1
        angle_sum[here] += angle
        deviation_sum[here] += deviation
        if deviation < least[here, 0]:
            least[here, 0], least[here, 1] = deviation, angle
        if deviation > greatest[here, 0]:
            greatest[here, 0], greatest[here, 1] = deviation, angle
