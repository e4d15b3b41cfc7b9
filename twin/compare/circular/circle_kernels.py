"""Loops over the points of an actual path around a circle."""

import math
from typing import NamedTuple

from twin.compilation.kernel import kernel
from twin.nc.canonical import FloatArray, IntArray


class AngleBins(NamedTuple):
    """Points around a circle by angle, in m bins of a turn.

    Attributes:
        samples: How many points, shape (m,).
        angle: Sum of their angles, shape (m,) [rad].
        deviation: Sum of their radial deviations, shape (m,) [mm].
        least: Least radial deviation and its point, shape (m, 3) [mm].
        greatest: Greatest radial deviation and its point, shape (m, 3) [mm].
    """

    samples: IntArray
    angle: FloatArray
    deviation: FloatArray
    least: FloatArray
    greatest: FloatArray


class ByAngle(NamedTuple):
    """What the f bins that have points say of a path.

    Attributes:
        mean: Mean angle [rad] and radial deviation [mm], shape (f, 2).
        place: The point there, relative to the centre, shape (f, 2) [mm].
        extremes: The innermost point of each bin and the outermost, shape (2 f, 2) [mm].
    """

    mean: FloatArray
    place: FloatArray
    extremes: FloatArray


@kernel
def collect_by_angle(points, radius, bins):
    """Sort points into bins of angle.

    Args:
        points: Relative to the centre, shape (n, 2) [mm].
        radius: Of the circle [mm].
        bins: Added to.
    """
    turn = 2.0 * math.pi
    number = len(bins.samples)
    for i in range(len(points)):
        x, y = points[i]
        angle = math.atan2(y, x)
        if angle < 0.0:
            angle += turn
        deviation = math.sqrt(x * x + y * y) - radius
        here = min(int(angle * (number / turn)), number - 1)
        least, greatest = bins.least[here], bins.greatest[here]
        first = bins.samples[here] == 0
        bins.samples[here] += 1
        bins.angle[here] += angle
        bins.deviation[here] += deviation
        if first or deviation < least[0]:
            least[0], least[1], least[2] = deviation, x, y
        if first or deviation > greatest[0]:
            greatest[0], greatest[1], greatest[2] = deviation, x, y


@kernel
def look_by_angle(bins, radius, found):
    """Evaluate every bin that has points.

    Args:
        radius: Of the circle [mm].
        found: Set.
    """
    row = 0
    for here in range(len(bins.samples)):
        count = bins.samples[here]
        if count == 0:
            continue
        angle, deviation = bins.angle[here] / count, bins.deviation[here] / count
        found.mean[row, 0], found.mean[row, 1] = angle, deviation
        found.place[row, 0] = (radius + deviation) * math.cos(angle)
        found.place[row, 1] = (radius + deviation) * math.sin(angle)
        for side in range(2):
            found.extremes[2 * row, side] = bins.least[here, side + 1]
            found.extremes[2 * row + 1, side] = bins.greatest[here, side + 1]
        row += 1


@kernel
def radial_range(points, radius):
    """Least and greatest radial deviation of points [mm], relative to the centre, shape (n, 2)."""
    least, greatest = math.inf, -math.inf
    for i in range(len(points)):
        x, y = points[i]
        deviation = math.sqrt(x * x + y * y) - radius
        least, greatest = min(least, deviation), max(greatest, deviation)
    return least, greatest


@kernel
def widest_gap(count):
    """The longest run of empty bins around a turn, and one [bins]; all of them without points."""
    bins = len(count)
    first, last, widest = -1, -1, 0
    for index in range(bins):
        if count[index] == 0:
            continue
        if last < 0:
            first = index
        else:
            widest = max(widest, index - last)
        last = index
    return bins if last < 0 else max(widest, first + bins - last)


@kernel
def radial_equations(points, center, radius, matrix, right):
    """Normal equations of the change of a circle that minimises the squared radial distances.

    Args:
        points: Shape (n, 2) [mm].
        center: Of the circle, shape (2,) [mm].
        radius: Of the circle [mm].
        matrix: Out: shape (3, 3); unknowns are the centre's two coordinates and the radius.
        right: Out: shape (3,).
    """
    matrix[:], right[:] = 0.0, 0.0
    for i in range(len(points)):
        x, y = points[i, 0] - center[0], points[i, 1] - center[1]
        distance = math.sqrt(x * x + y * y)
        x, y, off = x / distance, y / distance, distance - radius
        matrix[0, 0] += x * x
        matrix[0, 1] += x * y
        matrix[0, 2] += x
        matrix[1, 1] += y * y
        matrix[1, 2] += y
        right[0] += x * off
        right[1] += y * off
        right[2] += off
    matrix[1, 0], matrix[2, 0], matrix[2, 1] = matrix[0, 1], matrix[0, 2], matrix[1, 2]
    matrix[2, 2] = len(points)


@kernel
def into_planes(point, run, center, across, seen):
    """Where tool points lie in the planes of arcs, about their centres.

    Args:
        point: In the part's frame, shape (n, 3) [mm].
        run: Which arc each belongs to, shape (n,).
        center: Of m arcs, shape (m, 3) [mm].
        across: Directions of 0 and 90 degrees in their planes as columns, shape (m, 3, 2).
        seen: Out: along 0 and 90 degrees, shape (n, 2) [mm].
    """
    for i in range(len(point)):
        arc = run[i]
        x = point[i, 0] - center[arc, 0]
        y = point[i, 1] - center[arc, 1]
        z = point[i, 2] - center[arc, 2]
        for side in range(2):
            along = across[arc, :, side]
            seen[i, side] = x * along[0] + y * along[1] + z * along[2]
