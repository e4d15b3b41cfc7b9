"""From machine coordinates to the part's own frame, which turns with what carries the part.

Sign convention (ISO 841): a positive rotary value moves the tool counter-clockwise *around the
part*, seen from +Z; the table itself turns clockwise.

Positions count for the tip of the first tool. Any machine is the chain of its joints (``twin.kinematics``);
of one whose part turns about Z alone, or not at all, the same is said in closed form.
"""

import dataclasses
import json
from collections.abc import Mapping

import numpy as np

from twin.kinematics import Kinematics, ToolPoses, counted_from, turns_part
from twin.nc.canonical import FloatArray
from twin.toolpath.machine_geometry import NO_ERRORS, MachineGeometry

_Z = 2
_ALONG_Z = 1.0 - 1e-12
"""Cosine of an angle of a hundred-thousandth of a degree: rounding of what is meant to be upright."""


@dataclasses.dataclass(frozen=True, slots=True)
class PartFrame:
    """How the part turns under the tool.

    Attributes:
        rotary: Column of the axis that turns the part about +Z, or None when nothing turns it.
        center: Machine X and Y at which the tool is over the axis of rotation [mm].
        turn_zero: Rotary machine value at which the part's frame is parallel to the machine's
            [deg]: the part zero of that axis, so that the part lies as its program describes it.
        geometry: How far the machine is from straight and square.
        chain: The joints of a machine that is more than X, Y, Z and a table about Z, counted from the part
            zero; else None. With it nothing else turns the part.
        zero: What its axes count from, shape (k,) [mm or deg].
    """

    rotary: int | None
    center: tuple[float, float]
    turn_zero: float = 0.0
    geometry: MachineGeometry = NO_ERRORS
    chain: Kinematics | None = None
    zero: FloatArray | None = None

    def at(self, part_zero: FloatArray, length: float) -> "PartFrame":
        """The frame of a part on the machine.

        Args:
            part_zero: Machine coordinates at which its program zero lies, shape (k,) [mm or deg].
            length: Of the first tool, from the spindle nose to the tip [mm].
        """
        geometry = self.geometry.counted_from(part_zero)
        if self.chain is None:
            turn = 0.0 if self.rotary is None else float(part_zero[self.rotary])
            return dataclasses.replace(self, turn_zero=turn, geometry=geometry)
        zero = np.zeros(len(part_zero))
        turning = self.chain.column[turns_part(self.chain)]
        zero[turning] = part_zero[turning]
        chain = counted_from(self.chain, zero, length)
        return dataclasses.replace(self, geometry=geometry, chain=chain, zero=zero)

    def counted(self, joints: FloatArray) -> FloatArray:
        """Machine coordinates as the chain counts them, shape (n, k)."""
        return joints if self.zero is None else joints - self.zero

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

    def position(
        self, joints: FloatArray, length_difference: float | FloatArray = 0.0
    ) -> FloatArray:
        """Where the tip of a tool is, seen from the part.

        Args:
            joints: Machine coordinates of all axes, shape (n, k) [mm or deg].
            length_difference: How much longer than the first the tool is, one or shape (n,) [mm].

        Returns:
            Shape (n, 3) [mm], origin on the axis of rotation at machine Z 0: X and Y of the tool
            relative to ``center``, turned by the rotary value from ``turn_zero``; Z as it is. With a chain
            its frame.
        """
        if self.chain is not None:
            return self.poses(joints, length_difference).tip
        relative = joints[:, :3] - np.array([*self.center, 0.0])
        if self.rotary is None:
            return _lowered(relative, length_difference)
        angle = np.deg2rad(joints[:, self.rotary] - self.turn_zero)
        cosine, sine = np.cos(angle), np.sin(angle)
        turned = relative.copy()
        turned[:, 0] = cosine * relative[:, 0] - sine * relative[:, 1]
        turned[:, 1] = sine * relative[:, 0] + cosine * relative[:, 1]
        return _lowered(turned, length_difference)

    def program_zero(self, part_zero: FloatArray) -> FloatArray:
        """Where program zero lies in the frame of its part, shape (3,) [mm]."""
        if self.chain is not None:
            return self.position(part_zero[None])[0]
        return np.asarray(part_zero[:3]) - np.array([*self.center, 0.0])

    def direction(self, joints: FloatArray) -> FloatArray:
        """Direction of machine X, seen from the part, in its XY plane.

        Args:
            joints: Machine coordinates of all axes, shape (n, k) [mm or deg].

        Returns:
            Unit vectors, shape (n, 2); with a chain only where the tool is along Z.
        """
        if self.chain is not None:
            return self.poses(joints).along_x[:, :2]
        if self.rotary is None:
            return np.tile([1.0, 0.0], (len(joints), 1))
        angle = np.deg2rad(joints[:, self.rotary] - self.turn_zero)
        return np.stack([np.cos(angle), np.sin(angle)], axis=1)

    def tool_direction(self, joints: FloatArray) -> FloatArray:
        """Direction from the tip of the tool to the spindle, seen from the part, shape (n, 3)."""
        if self.chain is not None:
            return self.poses(joints).axis
        return np.tile([0.0, 0.0, 1.0], (len(joints), 1))

    def poses(self, joints: FloatArray, length_difference: float | FloatArray = 0.0) -> ToolPoses:
        """Position and directions of the tool at once; arguments as for ``position``."""
        if self.chain is not None:
            # Those who look at a machine alone need no compiler.
            from twin.toolpath.pose_kernels import tool_poses

            return tool_poses(self.chain, self.counted(joints), length_difference)
        along_x = np.pad(self.direction(joints), ((0, 0), (0, 1)))
        return ToolPoses(
            self.position(joints, length_difference), along_x, self.tool_direction(joints)
        )

    @property
    def over_table(self) -> tuple[float, float]:
        """Machine X and Y at which the tool is over the middle of the table, rotary axes at zero [mm]."""
        if self.chain is None:
            return self.center
        return float(self.chain.table[0]), float(self.chain.table[1])

    def table_about(self, coordinate: int) -> tuple[int, FloatArray] | None:
        """The table next to the part, if it turns about X, Y or Z while all other rotary axes are at zero.

        Args:
            coordinate: 0, 1 or 2.

        Returns:
            Column of its axis, and a point on it in machine coordinates, shape (3,) [mm]; None: it does not.
        """
        if self.chain is None:
            found = self.rotary if coordinate == _Z else None
            return None if found is None else (found, np.array([*self.center, 0.0]))
        tables = np.flatnonzero(turns_part(self.chain))
        if not len(tables) or self.chain.axis[tables[-1], coordinate] != 1.0:
            return None
        return int(self.chain.column[tables[-1]]), self.chain.anchor[tables[-1]]

    def tilts(self, joints: FloatArray) -> bool:
        """Whether the tool is ever tilted from the part's Z, joints of shape (n, k) [mm or deg]."""
        if self.chain is None:
            return False
        return bool(np.any(self.tool_direction(joints)[:, 2] < _ALONG_Z))

    def rotary_zero(self, count: int) -> FloatArray:
        """Machine coordinates of k axes at which the part's frame is that of the machine, shape (k,)."""
        if self.zero is not None:
            return self.zero.copy()
        zero = np.zeros(count)
        zero[:2] = self.center
        if self.rotary is not None:
            zero[self.rotary] = self.turn_zero
        return zero

    def as_text(self) -> str:
        """Chain and zero as JSON; empty without."""
        if self.chain is None or self.zero is None:
            return ""
        fields = {name: field.tolist() for name, field in self.chain._asdict().items()}
        return json.dumps({**fields, "zero": self.zero.tolist()})


def chain_from_text(text: str) -> tuple[Kinematics | None, FloatArray | None]:
    """What ``PartFrame.as_text`` wrote.

    Raises:
        ValueError: It did not write this.
    """
    if not text:
        return None, None
    data = json.loads(text)
    zero = np.array(data.pop("zero"), np.float64)
    whole = {"column": np.int64, "rotary": np.bool_, "on_tool": np.bool_}
    fields = {name: np.array(value, whole.get(name, np.float64)) for name, value in data.items()}
    return Kinematics(**fields), zero


def _lowered(points: FloatArray, length_difference: float | FloatArray) -> FloatArray:
    points[:, 2] -= length_difference
    return points
