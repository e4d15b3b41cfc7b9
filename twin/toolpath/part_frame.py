"""From machine coordinates to the part's own frame, which turns with the rotary table.

Sign convention (ISO 841): a positive rotary value moves the tool counter-clockwise *around the
part*, seen from +Z; the table itself turns clockwise.
"""

import dataclasses
from collections.abc import Mapping

import numpy as np

from twin.nc.canonical import FloatArray
from twin.toolpath.machine_geometry import NO_ERRORS, MachineGeometry


@dataclasses.dataclass(frozen=True, slots=True)
class PartFrame:
    """How the part turns under the tool.

    Attributes:
        rotary: Column of the axis that turns the part about +Z, or None when nothing turns it.
        center: Machine X and Y at which the tool stands over the axis of rotation [mm].
        turn_zero: Rotary machine value at which the part's frame is parallel to the machine's
            [deg]: the part zero of that axis, so that the part lies as its program describes it.
        geometry: How far the machine is from straight and square.
    """

    rotary: int | None
    center: tuple[float, float]
    turn_zero: float = 0.0
    geometry: MachineGeometry = NO_ERRORS

    def at(self, part_zero: FloatArray) -> "PartFrame":
        """The frame of a part whose program zero lies at machine coordinates, shape (k,)."""
        turn = 0.0 if self.rotary is None else float(part_zero[self.rotary])
        return dataclasses.replace(
            self, turn_zero=turn, geometry=self.geometry.counted_from(part_zero)
        )

    def real(self, joints: FloatArray) -> FloatArray:
        """Machine coordinates at which an ideal machine would have the tool where this one has it.

        Args:
            joints: Where the axes stand, shape (n, k) [mm or deg].
        """
        if not self.geometry:
            return joints
        return self.geometry.real(joints, self.rotary, self.center)

    def shares(self, joints: FloatArray, shifts: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
        """What every error of the geometry adds to the tool point, seen from the part.

        Args:
            joints: Where the axes stand, shape (k,) [mm or deg].
            shifts: What else adds to it by name, along X, Y, Z of the machine, shape (3,) [mm].

        Returns:
            By name, shape (3,) [mm].
        """
        row = joints[None]
        here = self.position(row)[0]
        added = self.geometry.contributions(row, self.rotary, self.center)
        found = {name: self.position(row + shift)[0] - here for name, shift in added}
        for name, shift in shifts.items():
            moved = row.copy()
            moved[:, :3] += shift
            found[name] = self.position(moved)[0] - here
        return found

    def position(self, joints: FloatArray) -> FloatArray:
        """Where the tool point is, seen from the part.

        Args:
            joints: Machine coordinates of all axes, shape (n, k) [mm or deg].

        Returns:
            Shape (n, 3) [mm], origin on the axis of rotation at machine Z 0: X and Y of the tool
            relative to ``center``, turned by the rotary value from ``turn_zero``; Z as it is.
        """
        relative = joints[:, :3] - np.array([*self.center, 0.0])
        if self.rotary is None:
            return relative
        angle = np.deg2rad(joints[:, self.rotary] - self.turn_zero)
        cosine, sine = np.cos(angle), np.sin(angle)
        turned = relative.copy()
        turned[:, 0] = cosine * relative[:, 0] - sine * relative[:, 1]
        turned[:, 1] = sine * relative[:, 0] + cosine * relative[:, 1]
        return turned

    def direction(self, joints: FloatArray) -> FloatArray:
        """Which way machine X points, seen from the part.

        Args:
            joints: Machine coordinates of all axes, shape (n, k) [mm or deg].

        Returns:
            Unit vectors, shape (n, 2).
        """
        if self.rotary is None:
            return np.tile([1.0, 0.0], (len(joints), 1))
        angle = np.deg2rad(joints[:, self.rotary] - self.turn_zero)
        return np.stack([np.cos(angle), np.sin(angle)], axis=1)
