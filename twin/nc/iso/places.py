"""Places of cycles in the working plane [mm]: rows, circles, grids."""

from twin.nc.geometry.arcs import Point, direction


def row(start: Point, angle: float, spacing: float, count: int) -> list[Point]:
    """Places so far apart on a line that leaves the first at an angle [deg]."""
    return grid(start, (angle, 0.0), (spacing, 0.0), (count, 1))


def circle(center: Point, radius: float, angle: float, step: float, count: int) -> list[Point]:
    """Places on a circle from an angle on, a step apart [deg]."""
    return [along(center, angle + number * step, radius) for number in range(count)]


def along(start: Point, angle: float, distance: float) -> Point:
    """The place that lies so far from another one at an angle [deg]."""
    cosine, sine = direction(angle)
    return (start[0] + distance * cosine, start[1] + distance * sine)


def grid(
    start: Point,
    angles: tuple[float, float],
    spacing: tuple[float, float],
    counts: tuple[int, int],
    *,
    frame: bool = False,
) -> list[Point]:
    """Columns and lines, every other line backwards.

    Args:
        start: The first place.
        angles: Of the lines against the abscissa, of the columns against the ordinate [deg].
        spacing: Between columns and between lines [mm].
        frame: Only those at the edge.
    """
    (cosine, sine), (up, aside) = direction(angles[0]), direction(angles[1])
    columns, lines = counts
    places = list[Point]()
    for line in range(lines):
        order = range(columns) if line % 2 == 0 else range(columns - 1, -1, -1)
        for column in order:
            if frame and 0 < line < lines - 1 and 0 < column < columns - 1:
                continue
            across, high = column * spacing[0], line * spacing[1]
            x = start[0] + across * cosine - high * aside
            places.append((x, start[1] + across * sine + high * up))
    return places
