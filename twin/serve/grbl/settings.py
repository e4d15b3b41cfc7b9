"""Grbl's settings ($$) as the machine file says them; those of the report can be changed."""

from twin.machine.description.config import MachineConfig
from twin.nc.dialects.grbl import JUNCTION_DEVIATION
from twin.serve.grbl.codes import Error
from twin.units import SECONDS_PER_MINUTE

REPORT, IN_INCHES = 10, 13
"""Numbers of the settings that say what a status report holds (1: machine position, 2: buffers), and its unit."""
_STEPS_PER_MM = 1000.0
"""The twin has no steps: a micrometre stands for one."""
_FASTEST = 1000.0
"""Grbl's own greatest spindle speed, where the machine has none [1/min]."""


def _whole(value: float) -> str:
    return f"{value:.0f}"


def _thousandths(value: float) -> str:
    return f"{value:.3f}"


class GrblSettings:
    """The settings by number."""

    def __init__(self, machine: MachineConfig) -> None:
        fastest = machine.file.spindle.max_speed or _FASTEST
        self.values: dict[int, float] = {
            0: 10, 1: 255, 2: 0, 3: 0, 4: 0, 5: 0, 6: 0, REPORT: 1, 11: JUNCTION_DEVIATION, 12: 0.002,
            IN_INCHES: 0, 20: 1, 21: 1, 22: 1, 23: 0, 24: 500, 25: 2000, 26: 250, 27: 0, 30: fastest, 31: 0,
            32: 0,
        }  # fmt: skip
        for number, name in enumerate("XYZ"):
            axis = machine.axis(name)
            low, high = axis.travel or (0.0, 0.0)
            self.values[100 + number] = _STEPS_PER_MM
            self.values[110 + number] = axis.velocity * SECONDS_PER_MINUTE
            self.values[120 + number] = axis.acceleration
            self.values[130 + number] = high - low

    def lines(self) -> list[str]:
        """What $$ lists."""
        return [f"${number}={_written(number, self.values[number])}" for number in self.values]

    def write(self, text: str) -> Error | None:
        """Take ``10=3``; None: it is done.

        Decision: what the machine file says can be written as it is, so that a sender may put its copy back, and
        is refused where it differs.
        """
        number, _, value = text.partition("=")
        try:
            which, wanted = int(number), float(value)
        except ValueError:
            return Error.BAD_NUMBER
        if not 0.0 <= wanted < 1e9:
            return Error.NEGATIVE_VALUE if wanted < 0.0 else Error.BAD_NUMBER
        if which not in self.values:
            return Error.INVALID_STATEMENT
        if which in (REPORT, IN_INCHES):
            self.values[which] = int(wanted) & (3 if which == REPORT else 1)
            return None
        same = _written(which, wanted) == _written(which, self.values[which])
        return None if same else Error.INVALID_STATEMENT


def _written(number: int, value: float) -> str:
    return (_thousandths if number in (11, 12, 24, 25, 27) or number >= 100 else _whole)(value)
