"""At which speed functions run that have two: as CPython takes them, or compiled."""

import enum
import os

VARIABLE = "MILL_TWIN_COMPILATION"
"""Environment variable: ``wait`` lets everything wait for the compiler, as tests and benches want it."""


class Speed(enum.Enum):
    """What a run does while there is no compiled form."""

    COLD = "cold"
    """It never asks for one."""
    WHEN_READY = "when ready"
    """It begins without, has it compiled beside, and changes over when it is there."""
    HOT = "hot"
    """It waits for it."""


def usual_speed() -> Speed:
    """``WHEN_READY``, unless the environment wants everybody to wait."""
    return Speed.HOT if os.environ.get(VARIABLE) == "wait" else Speed.WHEN_READY
