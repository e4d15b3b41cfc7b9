"""Geometric errors of the machine, added to the positions of its axes.

Names and signs follow ISO 230-1: E, then the direction of the error, then the axis whose motion brings
it. EXX is the positioning error of X (its pitch), EYX the straightness of X along Y, ECC the
indexing of C, EXC its run-out along X. Errors are those of the tool against the part, in machine
coordinates: a positive EXX leaves the tool at a greater X than X shows.

Errors are counted from the part zero, where the operator measured the part with all of them: there the
tool is where it is meant to be. Rigid-body motion of small errors adds up, so each term is found on its
own; their products, a millionth of them, are left out.
"""

import dataclasses
import json
from collections.abc import Iterator

import numpy as np

from twin.nc.canonical import FloatArray


@dataclasses.dataclass(frozen=True, slots=True)
class ErrorTerm:
    """One error that depends on one axis, read off a table by straight lines, constant beyond its ends.

    Attributes:
        axis: Column of the axis whose motion brings it.
        toward: Column of the coordinate that it shifts.
        at: Positions of the axis, rising [mm or deg].
        error: What is added there [mm or deg].
        period: After which the table repeats [deg]; 0: it does not.
    """

    name: str
    axis: int
    toward: int
    at: tuple[float, ...]
    error: tuple[float, ...]
    period: float = 0.0

    def read(self, position: FloatArray) -> FloatArray:
        """The error at positions of its axis, shape (n,)."""
        return np.interp(position, self.at, self.error, period=self.period or None)


@dataclasses.dataclass(frozen=True, slots=True)
class MachineGeometry:
    """The errors of a machine, counted from one place of its axes.

    Attributes:
        center_offset: How far the table's axis is from where the control takes it to be, X and Y [mm].
        tilt: Slope of the table's axis: its turn about X and about Y [rad].
        origin: Where the errors are counted from, one value per axis [mm or deg]; empty: zero.
    """

    terms: tuple[ErrorTerm, ...] = ()
    center_offset: tuple[float, float] = (0.0, 0.0)
    tilt: tuple[float, float] = (0.0, 0.0)
    origin: tuple[float, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.terms) or self.has_table

    @property
    def has_table(self) -> bool:
        """Whether the axis of a table is off."""
        return any(self.center_offset) or any(self.tilt)

    def as_text(self) -> str:
        """All of it as JSON; empty without errors."""
        return json.dumps(dataclasses.asdict(self)) if self else ""

    def counted_from(self, origin: FloatArray) -> "MachineGeometry":
        """These errors, counted from another place."""
        return dataclasses.replace(self, origin=tuple(float(value) for value in origin))

    def contributions(
        self, joints: FloatArray, rotary: int | None, center: tuple[float, float]
    ) -> Iterator[tuple[str, FloatArray]]:
        """Every error by name, as what it adds to the machine coordinates.

        Args:
            joints: Where the axes stand, shape (n, k) [mm or deg].
            rotary: Column of the axis that turns the table, or None.
            center: Machine X and Y at which the tool is over the table's axis [mm].

        Yields:
            A name, and what is added, shape (n, k) [mm or deg].
        """
        origin = np.array(self.origin) if self.origin else np.zeros(joints.shape[1])
        for term in self.terms:
            added = np.zeros_like(joints)
            zero = term.read(origin[term.axis : term.axis + 1])
            added[:, term.toward] = term.read(joints[:, term.axis]) - zero
            yield term.name, added
        if rotary is None:
            return
        angle = np.deg2rad(joints[:, rotary] - origin[rotary])
        if any(self.center_offset):
            offset = np.tile([*self.center_offset, 0.0], (len(joints), 1))
            yield "centre of the table", _among_axes(_turned(offset, -angle) - offset, joints)
        if any(self.tilt):
            place = joints[:, :3] - np.array([*center, origin[2]])
            slope = np.array([*self.tilt, 0.0])
            turned = _turned(np.cross(slope, _turned(place, angle)), -angle)
            yield "tilt of the table", _among_axes(turned - np.cross(slope, place), joints)

    def real(
        self, joints: FloatArray, rotary: int | None, center: tuple[float, float]
    ) -> FloatArray:
        """Machine coordinates at which a machine without errors would have the tool where it is.

        Args:
            joints: Where the axes stand, shape (n, k) [mm or deg].
            rotary: Column of the axis that turns the table, or None.
            center: Machine X and Y at which the tool is over the table's axis [mm].
        """
        found = joints.copy()
        for _, added in self.contributions(joints, rotary, center):
            found += added
        return found


def geometry_from_text(text: str) -> MachineGeometry:
    """What ``MachineGeometry.as_text`` wrote.

    Raises:
        ValueError: It did not write this.
    """
    if not text:
        return NO_ERRORS
    data = json.loads(text)
    terms = tuple(
        ErrorTerm(
            name=str(term["name"]),
            axis=int(term["axis"]),
            toward=int(term["toward"]),
            at=tuple(term["at"]),
            error=tuple(term["error"]),
            period=float(term["period"]),
        )
        for term in data["terms"]
    )
    (x, y), (about_x, about_y) = data["center_offset"], data["tilt"]
    return MachineGeometry(terms, (x, y), (about_x, about_y), tuple(data["origin"]))


NO_ERRORS = MachineGeometry()
"""Straight, square and true."""


def _among_axes(shift: FloatArray, joints: FloatArray) -> FloatArray:
    added = np.zeros_like(joints)
    added[:, :3] = shift
    return added


def _turned(vector: FloatArray, angle: FloatArray) -> FloatArray:
    cosine, sine = np.cos(angle), np.sin(angle)
    x, y = vector[:, 0], vector[:, 1]
    return np.column_stack([cosine * x - sine * y, sine * x + cosine * y, vector[:, 2]])
