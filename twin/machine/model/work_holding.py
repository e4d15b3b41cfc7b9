"""What carries the stock where it does not lie on the table: two parallels, or a post under a round blank."""

from typing import NamedTuple

INSET = 0.15
"""How far they are back from the blank's sides, as a share of its size."""
SMALLEST_GAP = 0.1
"""A blank that is so far above the table at most lies on it [mm]."""
PARALLELS, POST = ("parallel 1", "parallel 2"), "post"
"""As an alarm calls them."""
_WIDTH = 0.1
"""Half the width of a parallel, as a share of the blank's size along Y."""


class Support(NamedTuple):
    """A parallel or a post.

    Attributes:
        half: Half its size along X, Y, Z [mm]; of a post radius, radius and half its height.
        aside: Its middle off that of the blank along Y [mm].
    """

    name: str
    half: tuple[float, float, float]
    aside: float
    round: bool


def supports(size: tuple[float, float, float], gap: float, *, box: bool) -> tuple[Support, ...]:
    """What is between the table and a blank.

    Args:
        size: Of the box around the blank [mm].
        gap: Height of its lower face over the table [mm].
        box: The blank is a box; else it is on a post.
    """
    if gap < SMALLEST_GAP:
        return ()
    x, y, z = size[0] * (0.5 - INSET), size[1] * _WIDTH, gap / 2.0
    if not box:
        return (Support(POST, (x, x, z), 0.0, round=True),)
    aside = size[1] * (0.5 - INSET - _WIDTH)
    return tuple(
        Support(name, (x, y, z), side * aside, round=False)
        for name, side in zip(PARALLELS, (-1.0, 1.0), strict=True)
    )
