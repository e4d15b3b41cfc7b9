"""What only Grbl remembers from block to block."""

import dataclasses

from twin.nc.control.control import Control

SYSTEMS = ("G54", "G55", "G56", "G57", "G58", "G59")
"""Coordinate systems in the order of their numbers, from 1."""


@dataclasses.dataclass(slots=True)
class GrblMemory:
    """Coordinate systems and what shifts them; all of it in part coordinates but for ``homes``.

    Attributes:
        systems: Zeros of the coordinate systems by number, from 1, as far as they are known; shape (k,) each
            [mm or deg].
        system: Number of the one in force.
        preset: Of G92, shape (k,) [mm or deg].
        length: Of G43.1, along Z [mm].
        homes: Positions of G28 and G30 in machine coordinates, shape (2, k) [mm or deg].
    """

    systems: dict[int, list[float]] = dataclasses.field(default_factory=dict)
    system: int = 1
    preset: list[float] = dataclasses.field(default_factory=list)
    length: float = 0.0
    homes: list[list[float]] = dataclasses.field(default_factory=list)

    def fork(self) -> "GrblMemory":
        """A copy that changes by itself."""
        return dataclasses.replace(
            self,
            systems={number: list(zero) for number, zero in self.systems.items()},
            preset=list(self.preset),
            homes=[list(home) for home in self.homes],
        )


def memory_of(control: Control) -> GrblMemory:
    """The dialect's memory."""
    assert isinstance(control.memory, GrblMemory)
    return control.memory
