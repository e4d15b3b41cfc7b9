"""What a cycle was given."""

import dataclasses
from collections.abc import Mapping

RAPID = 99_999.0
"""A feed from here on in a cycle means FMAX (manual)."""
INCH_FEEDS = 0.1
"""F of programs in inches counts tenths of an inch per minute (manual)."""


@dataclasses.dataclass(frozen=True, slots=True)
class Parameters:
    """What a cycle was given, in the program's units.

    Attributes:
        values: By number of the Q parameter; a feed that is FMAX is ``RAPID``.
        unit: Of lengths [mm].
        line: Of the definition, from 1.
        live: The program changes them by assigning Q parameters.
    """

    name: str
    values: Mapping[int, float]
    unit: float
    line: int
    live: bool = True

    def number(self, parameter: int, default: float = 0.0) -> float:
        """A value as it is written."""
        return self.values.get(parameter, default)

    def length(self, parameter: int, default: float = 0.0) -> float:
        """A length [mm]; the default counts in the program's unit."""
        return self.values.get(parameter, default) * self.unit

    def feed(self, parameter: int) -> float | None:
        """A feed as F counts it; None: FMAX."""
        value = self.values.get(parameter, 0.0)
        if value >= RAPID:
            return None
        return value if self.unit == 1.0 else value * INCH_FEEDS

    def replaced(self, values: Mapping[int, float]) -> "Parameters":
        """The same with other values."""
        return dataclasses.replace(self, values={**self.values, **values})
