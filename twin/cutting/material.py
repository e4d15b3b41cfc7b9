"""What a cut asks of the material, whatever describes it: a height map, or intervals along three directions."""

import dataclasses
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Protocol

import numpy as np

from twin.columns import Columns, Rows
from twin.cutting.kernels.overlap import Overlap
from twin.cutting.kernels.sweep import Removal
from twin.cutting.tools import Profile
from twin.job.job_file import ToolTable
from twin.nc.canonical import BoolArray, FloatArray, IntArray

STRAIGHT_SHARE = 0.01
STRAIGHT_MM = 5e-4
"""Samples that are off a straight line by no more than this share of a cell, and by no more than
this, count as on it [mm]."""

LONGEST_SHARE = 0.5
"""Longest stretch that is swept at once, as a share of the tool's radius: it is also how finely
cutting is distinguished from air."""

MOST_JOINED = 64
"""Samples that one stretch may stand for."""

AIR_MM = 1e-3
"""A stretch that takes less than this off one cell cuts air [mm]."""

EDGE = "edge"
"""The cutting edge, which may be in the material in a feed alone."""


class Upright(Protocol):
    """A solid above the tool's tip that goes where the tool goes."""

    @property
    def name(self) -> str:
        """As an alarm calls it."""
        ...

    @property
    def round(self) -> bool:
        """A cylinder; else a box."""
        ...

    @property
    def half(self) -> tuple[float, float]:
        """Half of its size along machine X and Y [mm]."""
        ...

    @property
    def offset(self) -> tuple[float, float]:
        """Its middle off the tool's axis along machine X and Y [mm]."""
        ...

    @property
    def above(self) -> float:
        """Height of its lower end above the tip [mm]."""
        ...

    @property
    def height(self) -> float:
        """From its lower to its upper end [mm]."""
        ...

    @property
    def beyond(self) -> tuple[int, ...]:
        """Columns of the axes between it and the spindle: they move the tool, and not it."""
        ...


Head = Callable[[ToolTable], Iterable[Upright]]
"""What is above a tool's holder."""


@dataclasses.dataclass(frozen=True, slots=True)
class Points(Columns):
    """The ends of n stretches.

    Attributes:
        tip: Places of the tool's tip in the part's frame, shape (n + 1, 3) [mm].
        turn: Direction of machine X there, shape (n + 1, 2); with axes that of the tool's, which turns with it, shape (n + 1, 3).
        axis: Direction from the tip to the spindle there, shape (n + 1, 3); None: +Z.
        carriers: Where the bodies are that carry the tool, by the axes between it and them; see ``Upright.beyond``. Each
            place is that which the tip would have with these axes at zero.
    """

    tip: FloatArray
    turn: FloatArray
    axis: FloatArray | None = None
    carriers: Mapping[tuple[int, ...], "Points"] = dataclasses.field(default_factory=dict)

    def __getitem__(self, rows: Rows) -> "Points":
        axis = None if self.axis is None else self.axis[rows]
        carriers = {axes: points[rows] for axes, points in self.carriers.items()}
        return Points(self.tip[rows], self.turn[rows], axis, carriers)

    def carrying(self, solid: Upright) -> "Points":
        """The places that a solid goes with: those of the tool, or of what carries it."""
        return self.carriers[solid.beyond] if solid.beyond else self

    def followed_by(self, others: "Points") -> "Points":
        """Both, one after the other."""
        axis = None
        if self.axis is not None and others.axis is not None:
            axis = np.concatenate([self.axis, others.axis])
        turn = np.concatenate([self.turn, others.turn])
        carriers = {
            axes: points.followed_by(others.carriers[axes])
            for axes, points in self.carriers.items()
        }
        return Points(np.concatenate([self.tip, others.tip]), turn, axis, carriers)

    def lowered(self, by: float) -> "Points":
        """The places of a tool that is longer by so much [mm]."""
        down = np.array([0.0, 0.0, by]) if self.axis is None else by * self.axis
        carriers = {axes: points.lowered(by) for axes, points in self.carriers.items()}
        return Points(self.tip - down, self.turn, self.axis, carriers)

    def copy(self) -> "Points":
        """Points that keep no longer columns in memory."""
        return self[np.arange(len(self))]


def runs_of(chosen: BoolArray) -> list[slice]:
    """Where those that are chosen follow each other."""
    edges = np.flatnonzero(np.diff(chosen, prepend=False, append=False))
    return [slice(first, end) for first, end in edges.reshape(-1, 2).tolist()]


class Contact(Protocol):
    """Measures one tool against the material."""

    def measure(
        self, points: Points, suspect: BoolArray, *, provisional: bool = False
    ) -> Mapping[str, Overlap]:
        """What reaches into the material as it is, along each stretch.

        Args:
            points: Ends of n stretches.
            suspect: In which of them the edge must not cut, shape (n,).
            provisional: Whether they cut walls of their own that later ones meet: nothing that these may
                meet is left out then.

        Returns:
            By name; zero where something reaches no further than it may.
        """
        ...


class Material(Protocol):
    """Stock that a tool cuts."""

    @property
    def cell(self) -> float:
        """Side of a cell [mm]."""
        ...

    @property
    def corners(self) -> FloatArray:
        """Two opposite corners of the box around the blank, shape (2, 3) [mm]."""
        ...

    def begin_chunk(self) -> None:
        """Forget what has changed so far."""
        ...

    def straight(self, points: Points, group: IntArray, edge: Profile) -> IntArray:
        """Choose samples between which the tool moved straight, the first and the last among them.

        Args:
            points: n samples.
            group: Samples of different groups are never joined, shape (n,).
        """
        ...

    def contact(self, tool: ToolTable, edge: Profile, head: Head | None) -> Contact:
        """What measures a tool with what is above it against the material."""
        ...

    def take_off(
        self, points: Points, tool: ToolTable, edge: Profile, travelled: FloatArray, *, stood: bool
    ) -> Removal:
        """Cut what a tool meets on n stretches.

        Args:
            travelled: Distance of all tools up to the end of each, shape (n,) [mm].
            stood: Whether the tool has been at the first point, and has cut what it meets there.
        """
        ...

    def write_stl(self, path: Path, zero: FloatArray) -> None:
        """Write the part as binary STL [mm], complete or not at all.

        Args:
            zero: Where the file's coordinates have their origin in the part's frame, shape (3,) [mm].

        Raises:
            OSError: The file cannot be written.
        """
        ...

    def write_glb(self, path: Path) -> None:
        """Write the part as binary glTF, raw and machined surface in colours of their own, complete or not at all.

        Raises:
            OSError: The file cannot be written.
        """
        ...

    def picture(self) -> bytes:
        """The part from above, PNG; empty where there is no such picture."""
        ...
