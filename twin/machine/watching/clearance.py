"""How close the tool's side comes to the other side: collisions and near misses along a run.

Whoever is on the tool's side (cutter, shank, holder, spindle nose, housing, head) is held
against every solid on the other side (table, rotary table, fixtures, column), each as its exact
convex shape. Where two of them are d apart, a plane with the normal n lies between them, and it
keeps lying there while the one is displaced by s as long as

    d + n s - r |turn| > 0,

r being the farthest that a point of it is displaced by turning. That sum is linear in the displacement
and costs a few operations for a sample, so all samples are judged by it, and between them the straight path from
sample to sample. Only where it no longer decides is the distance measured again (``mj_geomDistance``), which gives
the next plane; where neither the plane before nor the plane behind separates the two all the way between two samples,
the path is halved until they do, or until it is shorter than ``SHORTEST_WAY``.

So an overlap of more than ``TOUCH`` is found wherever two samples see it, and a thinner overlap at a corner
between two samples where it is longer than ``SHORTEST_WAY``, whatever the speed.
"""

import copy
import itertools
from typing import NamedTuple

import mujoco
import numpy as np

from twin.machine.description.config import MachineConfig
from twin.machine.model.fixture_shape import fixture_of
from twin.machine.model.tool_shape import (
    COLLISION_GROUP,
    CUTTER,
    CUTTING_PARTS,
    PART_SIDE,
    STOCK_SIDE,
    TOOL_SIDE,
)
from twin.machine.watching.plane_kernels import (
    PlaneColumns,
    find_suspects,
    follow_suspects,
    least_clearance,
    view_columns,
    watched,
)
from twin.machine.watching.relative_motion import RelativeMotion
from twin.nc.canonical import FloatArray, IntArray
from twin.recording.alarms import Alarm, NearMiss
from twin.recording.reader import Samples
from twin.units import MM

TOUCH = 0.01
"""Overlap that is no collision yet [mm]: what the axes tremble by where two faces lie on each other."""
SHORTEST_WAY = 0.02
"""A path between two samples that is shorter is not halved any more [mm]."""
WORSE = 0.1
"""What has met, and was acknowledged, may overlap by so much more before it is an alarm again [mm]."""
NEAR_STEP = 0.01
"""A near miss is reported to this [mm]."""
_FAR = 10.0
"""Distances beyond this are not measured [m]."""
_BLOCK = 256
"""Samples that are judged at once by the box around them."""
_ORDER = (TOOL_SIDE, STOCK_SIDE, PART_SIDE)
"""In which order an alarm names two that meet."""
_BODY_NUMBERS = 1 << 16
"""By which MuJoCo multiplies the first body's number in the signature of an excluded pair."""
_NO_PLANE = 1e-6
"""Distance below which two witness points give no direction [mm]."""


class _Plane(NamedTuple):
    """The plane that was found between the two geoms of a pair.

    Attributes:
        clearance: When it was measured [mm]; minus infinity: never.
        normal: Towards the geom that is followed, in the frame of the other, shape (3,).
        place: Where that geom's track was when it was measured, shape (w,).
        reach: Farthest that a point of the geom is displaced by turning [mm/rad].
        slack: 1 where there is no plane, and any displacement may bring the two together; else 0.
    """

    clearance: float
    normal: FloatArray
    place: FloatArray
    reach: float
    slack: float

    def bound(self, track: FloatArray) -> FloatArray:
        """Clearance that the plane leaves along a track of shape (w, n), shape (n,) [mm]."""
        moved = track - self.place[:, None]
        left = self.clearance + self.normal @ moved[:3]
        if self.reach:
            left = left - self.reach * np.abs(moved[3:]).sum(axis=0)
        if self.slack:
            left = left - np.linalg.norm(moved[:3], axis=0)
        return left


class _Planes:
    """The planes of all p pairs, of which t tracks tell."""

    def __init__(self, reach: FloatArray, track: IntArray, width: int, near: FloatArray) -> None:
        count = len(reach)
        self.track = track
        self.columns = PlaneColumns(
            np.full(count, -np.inf), np.zeros((count, 3)), np.zeros((count, width)),
            reach, np.zeros(count), track, near, np.full(count, -TOUCH),
        )  # fmt: skip

    def __getitem__(self, pair: int) -> _Plane:
        clearance, normal, place, reach, slack, *_ = self.columns
        return _Plane(
            float(clearance[pair]), normal[pair].copy(), place[pair].copy(),
            float(reach[pair]), float(slack[pair]),
        )  # fmt: skip

    def __setitem__(self, pair: int, plane: _Plane) -> None:
        clearance, normal, place, _, slack, *_ = self.columns
        clearance[pair], normal[pair], place[pair] = plane.clearance, plane.normal, plane.place
        slack[pair] = plane.slack

    def forget(self) -> None:
        """There are none: the axes have moved."""
        self.columns.clearance[:] = -np.inf


class Clearance:
    """Watches a run for the first sample at which two things meet.

    Attributes:
        near_miss: The closest approach below the machine file's limit so far, or None. The cutting
            part has none: it may come as close to a jaw as the part asks for.
    """

    def __init__(self, machine: MachineConfig, model: mujoco.MjModel) -> None:
        self.near_miss: NearMiss | None = None
        self._model = model
        self._data = mujoco.MjData(model)
        self._worth_reporting = machine.file.collision.near_miss
        axes = [machine.axis(name) for name in machine.axes.names]
        joints = [int(model.joint(axis.joint).id) for axis in axes]
        self._scale = machine.joint_scale
        self._qpos = model.jnt_qposadr[joints]
        self._motion = RelativeMotion(model, joints, self._scale)
        self._pairs = _pairs(model)
        followed = [self._follow(one, two) for one, two in self._pairs]
        self._moving = [moving for moving, _, _ in followed]
        self._fixed = [
            sum(pair) - moving for pair, moving in zip(self._pairs, self._moving, strict=True)
        ]
        cuts = [model.geom(one).name in CUTTING_PARTS for one, _ in self._pairs]
        self._planes = _Planes(
            np.array([reach for _, _, reach in followed]),
            np.array([track for _, track, _ in followed], np.int64),
            3 + machine.axes.kinds.count("rotary"),
            np.where(cuts, -np.inf, self._worth_reporting),
        )
        self._watched = watched(self._planes.columns, self._motion.chain, self._motion.followed())
        self._view_columns()
        self._last: FloatArray | None = None
        self._witness = np.zeros(6)

    def _view_columns(self) -> None:
        """Let the planes be views of what the kernels are handed."""
        self._planes.columns, _, _ = view_columns(self._watched)
        self._near, self._threshold = self._planes.columns.near, self._planes.columns.threshold

    def __deepcopy__(self, memo: dict[int, object]) -> "Clearance":
        """A copy whose views are those of its own columns."""
        copied = memo[id(self)] = object.__new__(Clearance)
        copied.__dict__ = copy.deepcopy(self.__dict__, memo)
        copied._view_columns()
        return copied

    def _follow(self, one: int, two: int) -> tuple[int, int, float]:
        """Follow whichever of the two needs fewer looks: it turns in itself, or reaches less far.

        Returns:
            The geom, its track and its reach.
        """
        bodies = self._model.geom_bodyid
        first = self._motion.view(one, int(bodies[two]))
        second = self._motion.view(two, int(bodies[one]))
        moving, seen = (two, second) if second.reach <= first.reach else (one, first)
        return moving, self._motion.follow(seen), seen.reach

    def begin(self) -> None:
        """Look again at the next sample: the axes have moved since the last one."""
        self._last = None
        self._planes.forget()

    def acknowledge(self, position: FloatArray) -> None:
        """Raise again only what gets worse than it is: what has met may be driven apart.

        Args:
            position: Where the axes stand, shape (k,) [mm or deg].
        """
        self.begin()
        for pair in range(len(self._pairs)):
            clearance, _ = self._measure(pair, position)
            self._threshold[pair] = clearance - WORSE if clearance < 0.0 else -TOUCH

    def look(self, samples: Samples) -> Alarm | None:
        """Return the alarm of the first sample of the chunk at which two things meet."""
        position, known = samples.joint_position, 0
        if not self._pairs or not len(position):
            return None
        if self._last is not None:
            position, known = np.concatenate([self._last, position]), 1
        self._last = position[-1:].copy()
        tracks, suspects = follow_suspects(self._watched, position, known, -TOUCH)
        if not len(suspects):
            return None
        chunk = _Chunk(samples, position, tracks, known)
        for start in range(known, len(position), _BLOCK):
            block = slice(start, min(start + _BLOCK, len(position)))
            near = find_suspects(
                self._planes.columns, suspects, tracks, block.start, block.stop, -TOUCH
            )
            close = near.tolist()
            met = [(found, pair) for pair in close if (found := self._along(pair, chunk, block))]
            if met:
                (row, depth), pair = min(met, key=lambda each: (each[0][0], -each[0][1]))
                return self._alarm(chunk, row, depth, pair)
        return None

    def _along(self, pair: int, chunk: "_Chunk", block: slice) -> tuple[int, float] | None:
        """Follow a pair along a block of samples.

        Returns:
            The first row at which the two meet, and how deep [mm]; None where they do not.
        """
        track, row = chunk.tracks[self._planes.track[pair]], block.start
        while row < block.stop:
            limit = least_clearance(self._near[pair], self._threshold[pair], -TOUCH)
            close = self._planes[pair].bound(track[:, row : block.stop]) < limit
            ahead = int(np.argmax(close))
            if not close[ahead]:
                return None
            row += ahead
            clearance = self._pass(pair, chunk.position, track, row)
            if clearance < self._threshold[pair]:
                return row, -clearance
            if clearance < self._near[pair]:
                self._near[pair] = clearance - NEAR_STEP
                self._remember(chunk, row, max(clearance, 0.0), pair)
            if clearance > 0.0:
                self._threshold[pair] = -TOUCH
            row += 1
        return None

    def _pass(self, pair: int, position: FloatArray, track: FloatArray, row: int) -> float:
        """Least clearance found of a pair at a row and between it and the row before [mm]."""
        before = self._planes[pair]
        clearance, plane = self._measure(pair, position[row], track[:, row])
        self._planes[pair] = plane
        if clearance < self._threshold[pair] or row == 0 or before.clearance == -np.inf:
            return clearance
        ends = track[:, row - 1 : row + 1], position[row - 1 : row + 1]
        return min(clearance, self._between(pair, before, plane, *ends))

    def _between(
        self, pair: int, before: _Plane, behind: _Plane, track: FloatArray, position: FloatArray
    ) -> float:
        """Least clearance that is measured between two samples [mm]; infinite where planes tell.

        Args:
            before: The plane that separates the pair at the first sample.
            behind: The plane that separates it at the second.
            track: Where the geom is at both, shape (w, 2).
            position: Where the axes are at both, shape (2, k).
        """
        chunk = np.abs(track[:, 1] - track[:, 0])
        length = float(np.linalg.norm(chunk[:3])) + before.reach * float(chunk[3:].sum())
        if length < SHORTEST_WAY or _is_certain(before, behind, track, self._threshold[pair]):
            return np.inf
        stand, there = position.mean(axis=0), track.mean(axis=1)
        clearance, middle = self._measure(pair, stand, there)
        if clearance < self._threshold[pair]:
            return clearance
        early = np.stack([track[:, 0], there], axis=1), np.array([position[0], stand])
        late = np.stack([there, track[:, 1]], axis=1), np.array([stand, position[1]])
        return min(
            self._between(pair, before, middle, *early), self._between(pair, middle, behind, *late)
        )

    def _measure(
        self, pair: int, position: FloatArray, place: FloatArray | None = None
    ) -> tuple[float, _Plane]:
        """Measure a pair.

        Args:
            position: Where the axes stand, shape (k,) [mm or deg].
            place: Where its track is then, shape (w,).

        Returns:
            The clearance [mm], negative where the two overlap, and the plane between them.
        """
        model, data, fixed = self._model, self._data, self._fixed[pair]
        data.qpos[self._qpos] = position * self._scale
        mujoco.mj_kinematics(model, data)
        distance = mujoco.mj_geomDistance(
            model, data, self._moving[pair], fixed, _FAR, self._witness
        )
        clearance = distance / MM
        normal, slack = np.zeros(3), 1.0
        apart = self._witness[:3] - self._witness[3:]
        if abs(clearance) > _NO_PLANE and np.any(apart):
            frame = data.xmat[model.geom_bodyid[fixed]].reshape(3, 3)
            normal = frame.T @ apart / np.copysign(np.linalg.norm(apart), distance)
            slack = 0.0
        place = np.zeros(self._planes.columns.place.shape[1]) if place is None else place
        return clearance, _Plane(
            clearance, normal, place, float(self._planes.columns.reach[pair]), slack
        )

    def _names(self, pair: int) -> tuple[str, str]:
        one, two = (fixture_of(self._model.geom(geom).name) for geom in self._pairs[pair])
        return CUTTER if one in CUTTING_PARTS else one, two

    def _remember(self, chunk: "_Chunk", row: int, clearance: float, pair: int) -> None:
        if self.near_miss is None or clearance < self.near_miss.clearance_mm:
            self.near_miss = NearMiss(clearance, *chunk.moment(row), self._names(pair))

    def _alarm(self, chunk: "_Chunk", row: int, depth: float, pair: int) -> Alarm:
        one, two = self._names(pair)
        message = f"the {one} meets the {two} ({depth:.2f} mm deep)"
        return Alarm("collision", *chunk.moment(row), "", message, (one, two))


class _Chunk(NamedTuple):
    """A chunk of samples with the one before it.

    Attributes:
        samples: The chunk, n samples.
        position: Of the axes, shape (m, k) [mm or deg]; m is n, or n + 1 with the one before.
        tracks: Where what is followed goes, shape (t, w, m).
        known: Rows before the chunk's first: 0 or 1.
    """

    samples: Samples
    position: FloatArray
    tracks: FloatArray
    known: int

    def moment(self, row: int) -> tuple[int, float]:
        """Source line and time [s] of a row."""
        setpoint = self.samples.setpoint
        return int(setpoint.line[row - self.known]), float(setpoint.time[row - self.known])


def _is_certain(before: _Plane, behind: _Plane, track: FloatArray, threshold: float) -> bool:
    """Whether two planes keep a pair apart on the whole straight path between two samples."""
    leaves = _share_above(before.bound(track) - threshold)
    comes = 1.0 - _share_above(behind.bound(track)[::-1] - threshold)
    return leaves >= comes


def _share_above(ends: FloatArray) -> float:
    """Share of a straight path from its beginning on along which a linear value is not negative."""
    begin, end = float(ends[0]), float(ends[1])
    if begin < 0.0:
        return 0.0
    return 1.0 if end >= 0.0 else begin / (begin - end)


def _pairs(model: mujoco.MjModel) -> list[tuple[int, int]]:
    """Geoms of different bodies that may not meet, by their bits; the tool's side first, frame last.

    Pairs of bodies that the model excludes (``<exclude>``) may.
    """
    excluded = {tuple(sorted(divmod(int(pair), _BODY_NUMBERS))) for pair in model.exclude_signature}
    geoms = [index for index in range(model.ngeom) if model.geom_group[index] == COLLISION_GROUP]
    geoms.sort(key=lambda index: _place_in_alarm(int(model.geom_contype[index])))
    return [
        (one, two)
        for one, two in itertools.combinations(geoms, 2)
        if _are_apart(model, one, two, excluded)
        and (
            model.geom_contype[one] & model.geom_conaffinity[two]
            or model.geom_contype[two] & model.geom_conaffinity[one]
        )
    ]


def _are_apart(model: mujoco.MjModel, one: int, two: int, excluded: set[tuple[int, ...]]) -> bool:
    """Whether two geoms move against each other, and the model does not exclude their bodies."""
    bodies = tuple(sorted((int(model.geom_bodyid[one]), int(model.geom_bodyid[two]))))
    first, second = model.body_weldid[list(bodies)]
    return bool(first != second) and bodies not in excluded


def _place_in_alarm(contype: int) -> int:
    return next((place for place, side in enumerate(_ORDER) if contype & side), len(_ORDER))
