"""Long programs for the benches: a surface in parallel rows, as CAM writes it."""

import math
from pathlib import Path

FEED = 1500.0
"""[mm/min]"""
SIDE_MM, ROW_MM = 100.0, 0.5


def short_lines(path: Path, seconds: float, chord_mm: float = 1.0) -> float:
    """Write a program of short lines.

    Args:
        path: The file.
        seconds: Its machine time [s].
        chord_mm: Length of a block along X [mm].

    Returns:
        Its machine time, accelerations not counted [s].
    """
    taken, row, forth = 0.0, 0, True
    chords = round(SIDE_MM / chord_mm)
    with path.open("w") as file:
        file.write(f"G90 G17 G71\nM3 S8000\nG0 X-50 Y-50 Z5\nF{FEED:g}\n")
        while taken < seconds:
            y = (row * ROW_MM) % SIDE_MM - SIDE_MM / 2.0
            before = None
            for number in range(chords + 1):
                x = (number / chords - 0.5) * SIDE_MM * (1.0 if forth else -1.0)
                point = (x, y, -2.0 + math.sin(x / 8.0) * math.cos(y / 9.0))
                file.write("G1 X{:.3f} Y{:.3f} Z{:.3f}\n".format(*point))
                if before is not None:
                    taken += math.dist(before, point) / FEED * 60.0
                before = point
            row, forth = row + 1, not forth
        file.write("G0 Z5\nM5\nM30\n")
    return taken
