"""How things on a machine move as seen from one another: the kinematics of many samples at once.

Axes slide and turn; whatever hangs on them moves rigidly. Of two things the clearance needs only how
a point of the one goes in the frame of the other, and by what angle the two turn against each other.
"""

import dataclasses

import mujoco
import numpy as np

from twin.nc.canonical import FloatArray
from twin.units import MM

_STILL = 1e-9
"""Turning of an axis that stands: it trembles by rounding [rad]."""
_PARALLEL = 1e-9
"""Sine of an angle below which two directions are parallel, and length below which a point lies on
an axis [m]."""


@dataclasses.dataclass(frozen=True, slots=True)
class Seen:
    """A geom as seen from a body that it moves against.

    Attributes:
        frame: The body that it is seen from.
        body: The body that it belongs to.
        point: The point that is followed, in the frame of ``body`` [m]: the geom's middle, moved
            along the axis about which the two turn, which changes no displacement.
        turning: The axes that turn the two against each other, by their columns.
        reach: Farthest that a point of the geom is displaced by turning about that middle
            [mm/rad]; 0 for a body of revolution about the direction of the axis.
    """

    frame: int
    body: int
    point: tuple[float, float, float]
    turning: tuple[int, ...]
    reach: float


class RelativeMotion:
    """The axes of a machine and what hangs on them.

    Attributes:
        seen: What is followed, one for each track that ``tracks`` returns.
    """

    def __init__(self, model: mujoco.MjModel, joints: list[int], scale: FloatArray) -> None:
        """Look at a machine.

        Args:
            model: Its model.
            joints: The joint of each of k axes.
            scale: What each moves per unit of the axis, shape (k,) [m/mm or rad/deg].
        """
        self._model = model
        self._joints = joints
        self._scale = scale
        self._data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, self._data)
        hinge = mujoco.mjtJoint.mjJNT_HINGE
        self._hinge = [mujoco.mjtJoint(model.jnt_type[joint]) == hinge for joint in joints]
        self._links = _links(model, joints, self._hinge)
        self.seen: list[Seen] = []

    def follow(self, seen: Seen) -> int:
        """Follow something; return the number of its track."""
        if seen not in self.seen:
            self.seen.append(seen)
        return self.seen.index(seen)

    def view(self, geom: int, frame: int) -> Seen:
        """A geom as seen from a body."""
        model, data = self._model, self._data
        body = int(model.geom_bodyid[geom])
        between = self._axes_of(body) ^ self._axes_of(frame)
        turning = tuple(sorted(axis for axis in between if self._hinge[axis]))
        if not turning:
            return Seen(frame, body, (0.0, 0.0, 0.0), (), 0.0)
        point = data.geom_xpos[geom] - data.xpos[body]
        round_geom = mujoco.mjtGeom(model.geom_type[geom]) == mujoco.mjtGeom.mjGEOM_SPHERE
        if len(turning) == 1:
            about = data.xaxis[self._joints[turning[0]]]
            point = point - (point @ about) * about
            round_geom = round_geom or self._turns_in_itself(geom, about)
        point = data.xmat[body].reshape(3, 3).T @ point
        x, y, z = (float(value) for value in np.round(point, 12) + 0.0)
        reach = 0.0 if round_geom else float(model.geom_rbound[geom]) / MM
        return Seen(frame, body, (x, y, z), turning, reach)

    def _turns_in_itself(self, geom: int, about: FloatArray) -> bool:
        """Whether a geom is a body of revolution about a direction."""
        round_types = (mujoco.mjtGeom.mjGEOM_CYLINDER, mujoco.mjtGeom.mjGEOM_CAPSULE)
        own = self._data.geom_xmat[geom].reshape(3, 3)[:, 2]
        parallel = bool(np.linalg.norm(np.cross(own, about)) < _PARALLEL)
        return parallel and mujoco.mjtGeom(self._model.geom_type[geom]) in round_types

    def _axes_of(self, body: int) -> frozenset[int]:
        """Numbers of the axes that move a body."""
        found = set[int]()
        while body > 0:
            found |= {i for i, j in enumerate(self._joints) if self._model.jnt_bodyid[j] == body}
            body = int(self._model.body_parentid[body])
        return frozenset(found)

    def tracks(self, position: FloatArray) -> FloatArray:
        """Follow all that is seen along samples.

        Args:
            position: Of the axes, shape (n, k) [mm or deg].

        Returns:
            For each of t ``seen`` its point in its frame [mm], and for each rotary axis where it
            stands [rad] if it turns the two against each other, else 0; shape
            (t, 3 + rotary axes, n).
        """
        joint = np.ascontiguousarray((position * self._scale).T)
        rotary = [axis for axis, hinge in enumerate(self._hinge) if hinge]
        poses: _Poses = {0: (np.zeros((3, 1)), np.eye(3)[:, :, None])}
        found = np.zeros((len(self.seen), 3 + len(rotary), len(position)))
        for track, seen in zip(found, self.seen, strict=True):
            origin, turn = self._pose(seen.frame, joint, poses)
            place, own = self._pose(seen.body, joint, poses)
            offset = place + _applied(own, np.array(seen.point)[:, None]) - origin
            track[:3] = _applied(turn.swapaxes(0, 1), offset) / MM
            for axis in seen.turning:
                track[3 + rotary.index(axis)] = joint[axis]
        return found

    def _pose(self, body: int, joint: FloatArray, poses: "_Poses") -> tuple[FloatArray, FloatArray]:
        """Position and orientation of a body, shapes (3, m) and (3, 3, m); m is 1 while it rests."""
        if body not in poses:
            poses[body] = self._moved(self._links[body], joint, poses)
        return poses[body]

    def _moved(
        self, link: "_Link", joint: FloatArray, poses: "_Poses"
    ) -> tuple[FloatArray, FloatArray]:
        place, turn = self._pose(link.parent, joint, poses)
        place = place + _applied(turn, link.place)
        turn = _product(turn, link.turn)
        for axis in link.axes:
            moved = joint[axis.number] - axis.zero
            if not axis.hinge:
                place = place + _applied(turn, axis.along[:, None]) * moved
                continue
            if np.ptp(moved) < _STILL:
                moved = moved[:1]
            place = place + _applied(turn, axis.anchor)
            turn = _product(turn, _turned(axis.along, moved))
            place = place - _applied(turn, axis.anchor)
        return place, turn


@dataclasses.dataclass(frozen=True, slots=True)
class _Axis:
    """An axis at the body that it moves: its number, direction, anchor, and where it begins."""

    number: int
    hinge: bool
    along: FloatArray
    anchor: FloatArray
    zero: float


@dataclasses.dataclass(frozen=True, slots=True)
class _Link:
    """How a body stands on its parent, with the axes that move it.

    Copied from the model once: its arrays are slow to ask for.
    """

    parent: int
    place: FloatArray
    turn: FloatArray
    axes: tuple[_Axis, ...]


def _links(model: mujoco.MjModel, joints: list[int], hinge: list[bool]) -> list[_Link]:
    """All bodies of a model by their numbers."""
    found = []
    for body in range(model.nbody):
        axes = tuple(
            _Axis(
                number,
                hinge[number],
                model.jnt_axis[joint].copy(),
                model.jnt_pos[joint].copy()[:, None],
                float(model.qpos0[model.jnt_qposadr[joint]]),
            )
            for number, joint in enumerate(joints)
            if model.jnt_bodyid[joint] == body
        )
        place = model.body_pos[body].copy()[:, None]
        turn = _matrix(model.body_quat[body])[:, :, None]
        found.append(_Link(int(model.body_parentid[body]), place, turn, axes))
    return found


_Poses = dict[int, tuple[FloatArray, FloatArray]]


def _applied(turn: FloatArray, vector: FloatArray) -> FloatArray:
    """Rotations (3, 3, m) applied to vectors (3, m)."""
    return (turn * vector).sum(axis=1)


def _product(one: FloatArray, two: FloatArray) -> FloatArray:
    """Rotations (3, 3, m) one after another."""
    return (one[:, :, None] * two).sum(axis=1)


def _matrix(quaternion: FloatArray) -> FloatArray:
    matrix = np.zeros(9)
    mujoco.mju_quat2Mat(matrix, quaternion)
    return matrix.reshape(3, 3)


def _turned(axis: FloatArray, angle: FloatArray) -> FloatArray:
    """Rotations about an axis (Rodrigues), shape (3, 3, n)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    once, twice = cross[:, :, None], (cross @ cross)[:, :, None]
    return np.eye(3)[:, :, None] + np.sin(angle) * once + (1.0 - np.cos(angle)) * twice
