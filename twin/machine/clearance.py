"""How close the tool's side comes to the part's: collisions and near misses along a run.

Distances are taken between convex geoms (``mj_geomDistance``), and only where they could matter. If
the clearance is d now, nothing can touch before the axes have moved by d altogether: linear axes
count their way, rotary ones the way of the farthest point that they turn. So the next look is due
after that way (less the clearance that is worth reporting), however long it takes, and a ten-hour
run over a far-away table needs few looks. A step is never below ``RESOLUTION``: what a collision may
be seen late by.
"""

import itertools

import mujoco
import numpy as np

from twin.machine.alarms import Alarm, NearMiss
from twin.machine.config import Machine
from twin.machine.tool_shape import COLLISION_GROUP
from twin.nc.canonical import FloatArray
from twin.recording.reader import Samples
from twin.units import MM

RESOLUTION = 0.1
"""Shortest way between two looks [mm]."""
_FAR = 10.0
"""Distances beyond this are not measured [m]."""


class Clearance:
    """Watches a run for the first sample at which two things meet.

    Attributes:
        near_miss: The closest approach below the machine file's limit so far, or None.
    """

    def __init__(self, machine: Machine, model: mujoco.MjModel) -> None:
        self.near_miss: NearMiss | None = None
        self._model = model
        self._data = mujoco.MjData(model)
        self._worth_reporting = machine.file.collision.near_miss
        axes = [machine.axis(name) for name in machine.axes.names]
        self._scale = machine.joint_scale
        self._qpos = np.array([int(model.joint(axis.joint).qposadr[0]) for axis in axes])
        self._pairs = _pairs(model)
        self._reach = self._reaches(machine)
        self._due = 0.0
        self._last: FloatArray | None = None
        self._bearable = 0.0

    def begin(self) -> None:
        """Look anew at the next sample: the axes have moved since the last one."""
        self._last, self._due = None, 0.0

    def acknowledge(self, position: FloatArray) -> None:
        """Raise again only what gets worse than it is: what has met may be driven apart.

        Args:
            position: Where the axes stand, shape (k,) [mm or deg].
        """
        self.begin()
        if self._pairs:
            self._bearable = min(0.0, self._measure(position)[0] - RESOLUTION)

    def _reaches(self, machine: Machine) -> FloatArray:
        """Way of the farthest point that an axis moves, per unit of the axis [mm], shape (k,)."""
        mujoco.mj_kinematics(self._model, self._data)
        model, data = self._model, self._data
        reaches = []
        for name, kind in zip(machine.axes.names, machine.axes.kinds, strict=True):
            if kind == "linear":
                reaches.append(1.0)
                continue
            joint = model.joint(machine.axis(name).joint)
            body = int(joint.bodyid[0])
            turned = [g for g in range(model.ngeom) if _descends(model, model.geom_bodyid[g], body)]
            radii = [
                np.linalg.norm(data.geom_xpos[g] - data.xanchor[joint.id]) + model.geom_rbound[g]
                for g in turned
            ]
            reaches.append(np.deg2rad(max(radii, default=0.0)) / MM)
        return np.array(reaches)

    def look(self, samples: Samples) -> Alarm | None:
        """Return the alarm of the first sample of the chunk at which two things meet."""
        if not self._pairs:
            return None
        position = samples.joint_position
        before = position[:1] if self._last is None else self._last
        way = np.cumsum(np.abs(np.diff(position, axis=0, prepend=before)) @ self._reach)
        first = 0 if self._last is None else int(np.searchsorted(way, self._due))
        self._last = position[-1:]
        while first < len(way):
            clearance, pair = self._measure(position[first])
            if clearance <= self._bearable:
                return self._alarm(samples, first, clearance, pair)
            if clearance > 0:
                self._bearable = 0.0
            if 0 < clearance < self._worth_reporting:
                self._remember(samples, first, clearance, pair)
            self._due = way[first] + max(clearance - self._worth_reporting, RESOLUTION)
            first = max(first + 1, int(np.searchsorted(way, self._due)))
        self._due -= way[-1]
        return None

    def _measure(self, position: FloatArray) -> tuple[float, tuple[str, str]]:
        """Smallest clearance [mm] at a position of the axes, and between what."""
        self._data.qpos[self._qpos] = position * self._scale
        mujoco.mj_kinematics(self._model, self._data)
        distance = [
            mujoco.mj_geomDistance(self._model, self._data, one, two, _FAR, None)
            for one, two in self._pairs
        ]
        nearest = int(np.argmin(distance))
        one, two = (self._model.geom(index).name for index in self._pairs[nearest])
        return distance[nearest] / MM, (one, two)

    def _remember(
        self, samples: Samples, row: int, clearance: float, pair: tuple[str, str]
    ) -> None:
        if self.near_miss is None or clearance < self.near_miss.clearance_mm:
            line, time = int(samples.setpoint.line[row]), float(samples.setpoint.time[row])
            self.near_miss = NearMiss(clearance, line, time, pair)

    def _alarm(self, samples: Samples, row: int, clearance: float, pair: tuple[str, str]) -> Alarm:
        one, two = pair
        return Alarm(
            "collision",
            int(samples.setpoint.line[row]),
            float(samples.setpoint.time[row]),
            "",
            f"the {one} meets the {two} ({-clearance:.2f} mm deep)",
        )


def _pairs(model: mujoco.MjModel) -> list[tuple[int, int]]:
    """Geoms of different bodies that may not meet, by their bits; the tool's side first."""
    geoms = [index for index in range(model.ngeom) if model.geom_group[index] == COLLISION_GROUP]
    geoms.sort(key=lambda index: int(model.geom_contype[index]))
    return [
        (one, two)
        for one, two in itertools.combinations(geoms, 2)
        if model.geom_bodyid[one] != model.geom_bodyid[two]
        and (
            model.geom_contype[one] & model.geom_conaffinity[two]
            or model.geom_contype[two] & model.geom_conaffinity[one]
        )
    ]


def _descends(model: mujoco.MjModel, body: int, ancestor: int) -> bool:
    while body > 0 and body != ancestor:
        body = int(model.body_parentid[body])
    return body == ancestor
