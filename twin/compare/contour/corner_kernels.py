"""How near the tool comes to the corners of the path, sample by sample."""

import math

from twin.compilation.kernel import kernel


@kernel
def pass_corners(corner, sharp, before, point, place, time, nearest, when):
    """Keep the shortest distance from each corner to the tool's path.

    The tool is taken to go straight from sample to sample. Looked at are the corners at both ends
    of the move that it is nearest to.

    Args:
        corner: End point of every move, shape (m, 3) [mm].
        sharp: Whether it is a corner, shape (m,).
        before: The tool one sample before the first, shape (3,) [mm].
        point: The tool, shape (n, 3) [mm].
        place: Its nearest move, shape (n,).
        time: Shape (n,) [s].
        nearest: By corner: shortest distance so far, shape (m,) [mm]; read and written.
        when: By corner: its time, shape (m,) [s]; read and written.
    """
    x0, y0, z0 = before[0], before[1], before[2]
    for i in range(len(point)):
        x, y, z = point[i, 0], point[i, 1], point[i, 2]
        ax, ay, az = x - x0, y - y0, z - z0
        squared = ax * ax + ay * ay + az * az
        for end in range(max(place[i] - 1, 0), place[i] + 1):
            if not sharp[end]:
                continue
            rx, ry, rz = corner[end, 0] - x0, corner[end, 1] - y0, corner[end, 2] - z0
            share = 0.0
            if squared > 0.0:
                share = min(max((rx * ax + ry * ay + rz * az) / squared, 0.0), 1.0)
            rx, ry, rz = rx - share * ax, ry - share * ay, rz - share * az
            distance = math.sqrt(rx * rx + ry * ry + rz * rz)
            if distance < nearest[end]:
                nearest[end], when[end] = distance, time[i]
        x0, y0, z0 = x, y, z
