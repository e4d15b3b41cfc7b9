"""Relative motion of the bodies of a machine.

Axes slide and turn; whatever hangs on them moves rigidly. Of two things the clearance needs only how
a point of the one goes in the frame of the other, and by what angle the two turn against each other.
"""

import dataclasses
import itertools

import mujoco
import numpy as np

from twin.machine.watching.track_kernels import BodyChain, TrackedPoints
from twin.nc.canonical import FloatArray
from twin.units import MM

_PARALLEL = 1e-9
"""Sine of an angle below which two directions are parallel, and length below which a point lies on
an axis [m]."""


@dataclasses.dataclass(frozen=True, slots=True)
class RelativeGeom:
    """A geom as seen from a body that it moves against.

    Attributes:
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
        seen: What is followed, one for each track.
        chain: The axes and what they carry, for the kernels.
    """

    def __init__(self, model: mujoco.MjModel, joints: list[int], scale: FloatArray) -> None:
        """Look at a machine.

        Args:
            joints: The joint of each of k axes.
            scale: What each moves per unit of the axis, shape (k,) [m/mm or rad/deg].
        """
        self._model = model
        self._joints = joints
        self._data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, self._data)
        hinge = mujoco.mjtJoint.mjJNT_HINGE
        self._hinge = [mujoco.mjtJoint(model.jnt_type[joint]) == hinge for joint in joints]
        self.seen: list[RelativeGeom] = []
        self.chain = self._carriers(scale)

    def follow(self, seen: RelativeGeom) -> int:
        """Follow something; return the number of its track."""
        if seen not in self.seen:
            self.seen.append(seen)
        return self.seen.index(seen)

    def view(self, geom: int, frame: int) -> RelativeGeom:
        """A geom as seen from a body."""
        model, data = self._model, self._data
        body = int(model.geom_bodyid[geom])
        between = self._axes_of(body) ^ self._axes_of(frame)
        turning = tuple(sorted(axis for axis in between if self._hinge[axis]))
        if not turning:
            return RelativeGeom(frame, body, (0.0, 0.0, 0.0), (), 0.0)
        point = data.geom_xpos[geom] - data.xpos[body]
        round_geom = mujoco.mjtGeom(model.geom_type[geom]) == mujoco.mjtGeom.mjGEOM_SPHERE
        if len(turning) == 1:
            about = data.xaxis[self._joints[turning[0]]]
            point = point - (point @ about) * about
            round_geom = round_geom or self._turns_in_itself(geom, about)
        point = data.xmat[body].reshape(3, 3).T @ point
        x, y, z = (float(value) for value in np.round(point, 12) + 0.0)
        reach = 0.0 if round_geom else float(model.geom_rbound[geom]) / MM
        return RelativeGeom(frame, body, (x, y, z), turning, reach)

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

    def followed(self) -> TrackedPoints:
        """What is followed, as columns."""
        rotary = [axis for axis, hinge in enumerate(self._hinge) if hinge]
        return TrackedPoints(
            np.array([seen.frame for seen in self.seen], np.int64),
            np.array([seen.body for seen in self.seen], np.int64),
            np.array([seen.point for seen in self.seen], float).reshape(-1, 3),
            np.array(
                [[axis if axis in seen.turning else -1 for axis in rotary] for seen in self.seen],
                np.int64,
            ).reshape(len(self.seen), len(rotary)),
        )

    def _carriers(self, scale: FloatArray) -> BodyChain:
        """The bodies of the model with the joints of the axes."""
        model = self._model
        of_body = [
            [axis for axis, joint in enumerate(self._joints) if model.jnt_bodyid[joint] == body]
            for body in range(model.nbody)
        ]
        axes = list(itertools.chain(*of_body))
        joints = [self._joints[axis] for axis in axes]
        return BodyChain(
            model.body_parentid.astype(np.int64),
            model.body_pos.copy(),
            np.array([_matrix(quaternion) for quaternion in model.body_quat]),
            np.cumsum([0, *map(len, of_body)]),
            np.array(axes, np.int64),
            np.array([self._hinge[axis] for axis in axes], np.int64),
            model.jnt_axis[joints],
            model.jnt_pos[joints],
            model.qpos0[model.jnt_qposadr[joints]],
            scale,
        )


def _matrix(quaternion: FloatArray) -> FloatArray:
    matrix = np.zeros(9)
    mujoco.mju_quat2Mat(matrix, quaternion)
    return matrix.reshape(3, 3)
