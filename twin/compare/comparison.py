"""The comparison of a run with its program: following error and contour error, chunk by chunk."""

from collections.abc import Callable, Sequence

import numpy as np

from twin.compare.circular.arcs import ArcCollector
from twin.compare.contour.blocks import BlockCollector
from twin.compare.contour.corners import CornerCollector
from twin.compare.contour.features import FeatureCollector
from twin.compare.contour.follow_kernels import Commanded, NearestPlaces, follow
from twin.compare.figures import AxisTracking, ContourFigures, Figures, WorstPlace
from twin.compare.statistics import Distribution
from twin.errors import RecordingError
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Axes, FloatArray, IntArray, Moves, concatenate
from twin.recording.reader import Samples
from twin.toolpath.nearest import drop_moves, join_paths, path_columns
from twin.toolpath.part_frame import PartFrame
from twin.toolpath.place_kernels import derivatives
from twin.units import MDEG_PER_DEGREE, UM_PER_MM

REACH_S = 0.5
"""A tool that is later than this has left the place on the path that it is held against [s]. The
slowest position loop in use, 1 (m/min)/mm, lags by 0.06 s."""
WORST_PLACES = 10
DRIVES = "drives"
"""What of a contour error is none of the geometry's."""
GROWTH = "thermal growth"
_ROWS = 16384
"""Samples that are worked on at once: bounds how many arcs are open at a time."""


def _all_alike(move: IntArray) -> FloatArray:
    return np.zeros(len(move))


class Comparison:
    """Compares the simulated joints of a run with its program, in bounded memory.

    The contour error of a sample is the shortest distance from the simulated tool point to the
    commanded geometry, both in the part's frame (``twin.toolpath.part_frame``), where the tool
    really cuts. The search follows the tool along the path (``contour_kernels.follow``), so that
    a path that crosses itself is not mistaken. Being late on the path is following error alone.

    Args:
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        apart: First and last line of ranges that have a tolerance of their own.
        lower: How much longer than the first tool that of each move is, from move numbers of shape (n,) to
            shape (n,) [mm]; looked at on machines that tilt the tool against the part.
    """

    def __init__(
        self,
        axes: Axes,
        part_frame: PartFrame,
        part_zero: FloatArray,
        apart: Sequence[tuple[int, int]] = (),
        lower: Callable[[IntArray], FloatArray] = _all_alike,
    ) -> None:
        self.axes = axes
        self._frame = part_frame
        self._lower = lower if part_frame.chain is not None else _all_alike
        self._part_zero = np.asarray(part_zero, np.float64)
        self._first = 0
        self._moves = Moves.empty(axes)
        self._path = path_columns(self._moves, part_frame, self._part_zero)
        self._waiting: list[Moves] = []
        self._state = np.full(6, np.nan)
        self._late = Commanded(np.zeros(0), np.zeros(0, np.int64), np.zeros(0))
        self._duration = 0.0
        self._axis_errors = [Distribution() for _ in axes.names]
        self._axis_worst = [(0, 0.0) for _ in axes.names]
        self._direction, self._direction_worst = Distribution(), (0, 0.0)
        self._contour = Distribution()
        self._arcs = ArcCollector()
        self._blocks = BlockCollector(apart)
        self._features = FeatureCollector()
        self._corners = CornerCollector()
        self._worst: dict[int, WorstPlace] = {}
        self._shares: dict[str, float] = {}

    def expect(self, moves: Moves) -> None:
        """Announce the next moves of the program, in order, before their samples are added.

        Args:
            moves: In part coordinates; their numbers go on from the last call's.
        """
        if len(moves):
            self._waiting.append(moves)

    def add(self, samples: Samples) -> FloatArray:
        """Compare the next chunk.

        Args:
            samples: n samples that follow the last chunk; their moves have been announced.

        Returns:
            Contour error of each sample, shape (n,) [µm].

        Raises:
            RecordingError: A joint position is not a finite number, or a sample names a move that
                was not announced.
        """
        if not np.isfinite(samples.joint_position).all():
            raise RecordingError("the recording holds joint positions that are not numbers")
        self._take_waiting()
        parts = [
            self._add(samples[first : first + _ROWS]) for first in range(0, len(samples), _ROWS)
        ]
        return np.concatenate(parts) if parts else np.zeros(0)

    def _take_waiting(self) -> None:
        if self._waiting:
            new = concatenate(self._waiting, self.axes)
            self._waiting = []
            self._moves = concatenate([self._moves, new], self.axes)
            numbers = self._first + len(self._moves) - len(new) + np.arange(len(new))
            new_path = path_columns(new, self._frame, self._part_zero, self._lower(numbers))
            self._path = join_paths(self._path, new_path)
            self._corners.expect(new_path)

    def _add(self, samples: Samples) -> FloatArray:
        setpoint = samples.setpoint
        self._duration = float(setpoint.time[-1])
        self._add_tracking(samples)
        real = samples.real(self._frame)
        length_difference = self._lower(setpoint.move)
        if self._frame.chain is None:
            point = np.ascontiguousarray(self._frame.position(real, length_difference))
        else:
            point, _, simulated = self._frame.poses(real, length_difference)
            self._add_direction(simulated, setpoint)
        if int(setpoint.move.max()) >= self._first + len(self._moves):
            raise RecordingError(
                f"a sample names move {setpoint.move.max()}, but the program has only "
                f"{self._first + len(self._moves)} moves"
            )
        if len(self._moves) == 0:
            distance = np.linalg.norm(
                point - self._frame.position(setpoint.position, length_difference), axis=1
            )
            place, fraction = None, np.zeros(0)
        else:
            distance, place, fraction = self._follow(samples, point)
        error = distance * UM_PER_MM
        worst = self._contour.add(error)
        if worst is not None and place is not None and self._has_shares(samples):
            self._shares = self._shares_of(
                samples[worst : worst + 1], point[worst], int(place[worst]), fraction[worst]
            )
        line = setpoint.line if place is None else self._moves.line[place]
        rows = self._blocks.add(self._moves, place, line, error, setpoint.time)
        self._keep_worst(rows, setpoint)
        if place is not None:
            self._corners.add(point, place, fraction, setpoint.time)
            at_corner = self._corners.at_corner(place, fraction)
            self._features.add(self._moves, place, at_corner, error, setpoint.time)
            self._arcs.add(
                self._moves, self._path, self._first, place, fraction, point, setpoint.time
            )
            self._drop_passed()
        return error

    def _has_shares(self, samples: Samples) -> bool:
        """Whether anything but the drives has a share of the errors."""
        return bool(self._frame.geometry) or samples.growth is not None

    def _shares_of(
        self, sample: Samples, point: FloatArray, place: int, fraction: float
    ) -> dict[str, float]:
        """What each error of the machine has of a contour error, along the error itself [µm]."""
        away = point - np.array(derivatives(self._path, place, float(fraction))[:3])
        size = float(np.linalg.norm(away))
        if size == 0.0:
            return {}
        grown = {} if sample.growth is None else {GROWTH: sample.growth[0]}
        found = {
            name: float(shift @ away) / size * UM_PER_MM + 0.0
            for name, shift in self._frame.shares(sample.joint_position[0], grown).items()
        }
        return {DRIVES: size * UM_PER_MM - sum(found.values()), **found}

    def _add_tracking(self, samples: Samples) -> None:
        setpoint = samples.setpoint
        for column, kind in enumerate(self.axes.kinds):
            per_unit = UM_PER_MM if kind == "linear" else MDEG_PER_DEGREE
            lag = setpoint.position[:, column] - samples.joint_position[:, column]
            row = self._axis_errors[column].add(lag * per_unit)
            if row is not None:
                place = int(setpoint.line[row]), float(setpoint.time[row])
                self._axis_worst[column] = place

    def _add_direction(self, simulated: FloatArray, setpoint: Setpoints) -> None:
        commanded = self._frame.tool_direction(setpoint.position)
        across = np.linalg.norm(np.cross(commanded, simulated), axis=1)
        along = np.einsum("ij,ij->i", commanded, simulated)
        row = self._direction.add(np.rad2deg(np.arctan2(across, along)) * MDEG_PER_DEGREE)
        if row is not None:
            self._direction_worst = int(setpoint.line[row]), float(setpoint.time[row])

    def _follow(self, samples: Samples, point: FloatArray) -> NearestPlaces:
        setpoint, late = samples.setpoint, self._late
        commanded = Commanded(
            np.concatenate([late.time, setpoint.time]),
            np.concatenate([late.move, setpoint.move]),
            np.concatenate([late.fraction, setpoint.fraction]),
        )
        if np.isnan(self._state[0]):
            where = self._frame.position(setpoint.position[:1], self._lower(setpoint.move[:1]))[0]
            started = setpoint.move[0] >= 0
            place = (setpoint.move[0], setpoint.fraction[0]) if started else (0, 0.0)
            self._state[:] = (*place, *where, 0.0)
        count = len(setpoint)
        found = NearestPlaces(np.zeros(count), np.zeros(count, np.int64), np.zeros(count))
        back = follow(self._path, self._first, point, commanded, REACH_S, self._state, found)
        self._late = Commanded._make(column[back:] for column in commanded)
        return found

    def _keep_worst(self, rows: IntArray, setpoint: Setpoints) -> None:
        """See whether the lines that the tool was in are among the worst now."""
        least = min((w.error_um for w in self._worst.values()), default=0.0)
        floor = least if len(self._worst) >= WORST_PLACES else -1.0
        known = self._blocks.columns
        for row in rows[(known.greatest[rows] >= floor) & (known.when[rows] >= setpoint.time[0])]:
            line, error = int(known.block[row]) // 2, float(known.greatest[row])
            before = self._worst.get(line)
            when = float(known.when[row])
            if before is None or (error, -when) > (before.error_um, -before.time_s):
                sample = int(np.searchsorted(setpoint.time, when))
                position = setpoint.position[sample] - self._part_zero
                self._worst[line] = WorstPlace(
                    line, when, error, position, int(setpoint.move[sample])
                )
        kept = sorted(self._worst.values(), key=lambda w: (-w.error_um, w.line))[:WORST_PLACES]
        self._worst = {place.line: place for place in kept}

    def _drop_passed(self) -> None:
        """Let go of the moves that neither the tool nor the search can come back to.

        The one before these is kept: its end may be a corner that the tool is passing.
        """
        reached = min(int(self._state[0]), max(int(self._late.move[0]), 0))
        self._arcs.finish(reached)
        passed = reached - 1 - self._first
        if passed > 0 and 2 * passed >= len(self._moves):
            self._corners.drop(self._moves, passed)
            self._moves = concatenate([self._moves[passed:]], self.axes)
            self._path = drop_moves(self._path, passed)
            self._first += passed

    def result(self) -> Figures:
        """The figures of everything added so far; more may be added."""
        worst = tuple(self._worst.values())
        tracking = {
            name: AxisTracking(kind, size.greatest, size.rms, *place, size.percentile(99.0))
            for name, kind, size, place in zip(
                self.axes.names, self.axes.kinds, self._axis_errors, self._axis_worst, strict=True
            )
        }
        return Figures(
            samples=self._contour.count,
            duration_s=self._duration,
            tracking=tracking,
            contour=ContourFigures(
                max=self._contour.greatest,
                rms=self._contour.rms,
                p99=self._contour.percentile(99.0),
                worst_line=worst[0].line if worst else 0,
                worst_time_s=worst[0].time_s if worst else 0.0,
            ),
            shares=self._shares,
            arcs=self._arcs.figures(),
            bidirectional=self._arcs.bidirectional(),
            worst=worst,
            blocks=self._blocks.figures(),
            features=self._features.figures(),
            corners=self._corners.figures(self._moves),
            direction=self._direction_figures(),
        )

    def _direction_figures(self) -> AxisTracking | None:
        size = self._direction
        if not size.count:
            return None
        place = self._direction_worst
        return AxisTracking("rotary", size.greatest, size.rms, *place, size.percentile(99.0))
