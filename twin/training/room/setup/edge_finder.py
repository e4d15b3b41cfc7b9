"""The edge finder: its tip gives way to the part, lights, and breaks where it is pushed too far."""

from collections.abc import Iterable

from twin.job.job_file import ToolTable
from twin.recording.alarms import Alarm
from twin.training.room.setup.touch import Touch

FIRST_NUMBER = 99
"""Number of its place in the magazine, or the first free one above."""
TIP_MM, TIP_HEIGHT_MM, BODY_MM, LENGTH_MM, BELOW_HOLDER_MM = 10.0, 16.0, 20.0, 100.0, 60.0
"""Of a usual electronic edge finder: tip, body, whole length, and what stands out of the holder [mm]."""
OVERTRAVEL_MM = 2.0
"""How far its tip yields [mm]; the makers of such finders name 1 to 3."""


def edge_finder(taken: Iterable[int]) -> ToolTable:
    """An edge finder for a magazine whose tools have these numbers."""
    numbers = set(taken)
    number = next(
        n for n in range(FIRST_NUMBER, FIRST_NUMBER + len(numbers) + 1) if n not in numbers
    )
    return ToolTable(
        number=number, name="edge finder", kind="flat", diameter=TIP_MM, flute=TIP_HEIGHT_MM,
        shank=BODY_MM, length=LENGTH_MM, free_length=BELOW_HOLDER_MM,
    )  # fmt: skip


class EdgeFinder:
    """The edge finder of a room; other files read it and call its methods.

    Attributes:
        broken: It has been pushed too far.
        deflection: How far its tip is pushed aside, seen from the part, X and Y [mm].
    """

    def __init__(self, number: int) -> None:
        self.number = number
        self.broken = False
        self.deflection = (0.0, 0.0)

    def renew(self) -> None:
        """Put a sound one into its place."""
        self.broken, self.deflection = False, (0.0, 0.0)

    def push(self, touch: Touch, *, turns: bool) -> str:
        """Give way to the part.

        Args:
            touch: Where the tip is relative to the part.
            turns: Whether the spindle turns: an electronic one must not.

        Returns:
            Why it has broken; empty: it has not.
        """
        depth = max(0.0, -touch.gap)
        x, y = touch.away
        self.deflection = (depth * x, depth * y)
        if depth > OVERTRAVEL_MM:
            said = f"the edge finder was pushed {depth:.2f} mm into the part: its tip gives way by {OVERTRAVEL_MM:g} mm, and is broken"
        elif touch.meets and turns:
            said = "the edge finder met the part while the spindle turned, and is broken"
        else:
            return ""
        self.broken, self.deflection = True, (0.0, 0.0)
        return said


def broken_alarm(message: str, line: int, time_s: float) -> Alarm:
    """The alarm of a finder that has broken."""
    return Alarm("tool-broken", line, time_s, "", message)
