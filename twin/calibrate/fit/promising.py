"""Which structures are worth a search: every set of extras, judged by tangents at one optimum.

A search costs some hundred runs of the model, and what a drive or a log may have besides makes 512 sets. To
first order, what a set leaves is linear least squares: a column for each parameter, a tangent for
what the optimum has and a secant to a usual value for what it lacks. One triangle of all columns makes of
each set a problem of some ten rows.
"""

import dataclasses
import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from twin.calibrate.fit.parameters import AxisParameters
from twin.calibrate.fit.solve import Problem, Solution, slope
from twin.nc.canonical import FloatArray

EXTRAS = (
    "delay", "force_delay", "velocity_feedforward", "acceleration_feedforward", "measuring_filter", "reset_time_s",
    "loop_delay_s", "velocity_filter_s", "command_filter_s",
)  # fmt: skip
"""What a drive or a log may have in addition to gain, damping, mass and friction."""
INTEGRATOR = "reset_time_s"
VISCOUS = "viscous_friction"
_USUAL = {
    "reset_time_s": 0.03, "loop_delay_s": 0.001, "velocity_filter_s": 0.001, "command_filter_s": 0.003,
    "measuring_filter": 0.002,
}  # fmt: skip
"""Where the search for what an axis has not begins [s]: off none, where a search within bounds hardly moves."""
_NEAR = 1.2
"""A set is worth a search where it promises less than this, in units of what the optimum leaves."""
_SAME = 0.997
"""A set promises more than one of its parts only where it leaves less than this share of that."""
_MOST = 8
"""Searches at a time."""


def started(parameters: AxisParameters, name: str) -> AxisParameters:
    """These, with some of a parameter where they have none of it."""
    value = getattr(parameters, name) or _USUAL.get(name, 0.0)
    return dataclasses.replace(parameters, **{name: value})


@dataclasses.dataclass(frozen=True, slots=True)
class Core:
    """What every structure of an axis has.

    Attributes:
        names: Of the parameters that are always fitted.
        unset: Parameters, whose extras are those of a structure without them.
        forced: Whether a force is logged: without one, an integrator hides a constant force.

    Positions alone do not tell viscous friction from the loop gain. With an integrator they do: the
    command has the product of the velocity loop's gain d and the loop gain, the position the integrator's
    rate times d besides, and the integral the product of all three; what the speed has over d is friction.
    """

    names: tuple[str, ...]
    unset: AxisParameters
    forced: bool

    @property
    def extras(self) -> tuple[str, ...]:
        """What a structure may have in addition."""
        return tuple(name for name in EXTRAS if name not in self.names)

    def free(self, extras: Sequence[str]) -> list[str]:
        """Names that are fitted in a structure."""
        integrates = INTEGRATOR in extras or self.unset.reset_time_s > 0.0
        if not integrates or self.forced:
            return [*self.names, *extras]
        seen = [name for name in self.names if name != "constant_force"]
        return [*dict.fromkeys([*seen, VISCOUS]), *extras]

    def extras_of(self, solution: Solution) -> list[str]:
        """The extras that an optimum has."""
        return [name for name in self.extras if name in solution.free]

    def unset_where(self, free: Sequence[str]) -> dict[str, float]:
        """Values of what some structures have, and not the one that fits these."""
        optional = [*self.extras, *({VISCOUS} - set(self.names))]
        return {name: getattr(self.unset, name) for name in optional if name not in free}


class Promise(NamedTuple):
    """A structure that may leave little."""

    extras: tuple[str, ...]
    cost: float
    """What it may leave, in the units of a solution's cost."""
    start: AxisParameters
    """Where a search begins."""


def promising(problem: Problem, best: Solution, core: Core) -> list[Promise]:
    """Structures that may leave about as little as an optimum does, or less, the best first.

    Sets with at most one extra more than the optimum has are judged; of those that promise alike, the
    smallest is kept.
    """
    own = core.extras_of(best)
    linear = _linear(problem, best, core)
    sets = (
        names
        for size in range(len(own) + 2)
        for names in itertools.combinations(core.extras, size)
        if set(names) != set(own)
    )
    judged = [promise for names in sets if (promise := linear.of(names)) is not None]
    kept: list[Promise] = []
    for one in sorted(judged, key=lambda one: (len(one.extras), one.cost)):
        parts = [other for other in kept if set(other.extras) < set(one.extras)]
        if one.cost < _NEAR * best.cost and all(one.cost < _SAME * part.cost for part in parts):
            kept.append(one)
    return sorted(kept, key=lambda one: one.cost)[:_MOST]


def _linear(problem: Problem, best: Solution, core: Core) -> "_Linear":
    here = problem.residuals(best.parameters)
    names = tuple(dict.fromkeys([*core.names, VISCOUS, *core.extras]))
    columns = []
    for name in names:
        start = started(best.parameters, name) if name in core.extras else best.parameters
        if start == best.parameters:
            columns.append(slope(problem, start, name, here))
        else:
            coordinate = problem.coordinates[name]
            step = coordinate.inside(getattr(start, name)) - coordinate.inside(
                getattr(best.parameters, name)
            )
            columns.append((problem.residuals(start) - here) / step)
    triangle = np.linalg.qr(np.column_stack([*columns, here]), mode="r")
    return _Linear(problem, best, core, names, np.asarray(triangle, np.float64), len(here))


class _Linear(NamedTuple):
    """The problem to first order."""

    problem: Problem
    best: Solution
    core: Core
    names: tuple[str, ...]
    """Of the columns."""
    triangle: FloatArray
    """Of columns and residuals, shape (p + 1, p + 1)."""
    rows: int

    def of(self, extras: tuple[str, ...]) -> Promise | None:
        """What a structure promises; None where its optimum is one of a structure with less."""
        free = self.core.free(extras)
        coordinates, parameters = self.problem.coordinates, self.best.parameters
        now = np.array([coordinates[name].inside(getattr(parameters, name)) for name in self.names])
        moved = np.array([name in free for name in self.names])
        step = np.zeros(len(self.names))
        for name, value in self.core.unset_where(free).items():
            index = self.names.index(name)
            step[index] = coordinates[name].inside(value) - now[index]
        columns, rest = self.triangle[:, :-1], self.triangle[:, -1] + self.triangle[:, :-1] @ step
        size = np.maximum(np.sqrt(np.sum(columns[:, moved] ** 2, axis=0)), 1e-12)
        found, *_ = np.linalg.lstsq(columns[:, moved] / size, -rest, rcond=1e-10)
        step[moved] = found / size
        cost = float(np.sqrt(np.sum((rest + columns[:, moved] @ step[moved]) ** 2) / self.rows))
        values = dict[str, float]()
        for name, end in zip(self.names, now + step, strict=True):
            low, high = coordinates[name].bounds
            if name in extras and not low < end < high:
                return None
            values[name] = coordinates[name].outside(float(np.clip(end, low, high)))
        return Promise(extras, cost, dataclasses.replace(parameters, **values))
