"""Which structure a log asks for: filters, dead time, feed-forward, an integrator, one after the other.

One parameter more always leaves less. It is taken where it leaves less in nearly every stretch of time,
and given up again where another that came later does its work. Structures that do as well as
the one that was chosen are rivals: what differs between them is not known, and intervals hold it.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np

from twin.calibrate.fit.parameters import Parameters
from twin.calibrate.fit.solve import Problem, Solution, promised_costs, solve

EXTRAS = (
    "delay", "force_delay", "velocity_feedforward", "acceleration_feedforward", "measuring_filter", "reset_time_s",
    "loop_delay_s", "velocity_filter_s", "command_filter_s",
)  # fmt: skip
"""What a drive or a log may have besides gain, damping, mass and friction."""
_PLAIN = 0.9
"""What leaves less than this share of what was left without it is worth a parameter more."""
_WORTH = 0.99
"""So is what leaves less than this share, where it is no chance:"""
_SURE = 4.0
"""its gain over the stretches of time is more than so many of its standard errors."""
_HOPE = 0.997
"""A parameter is tried where the tangent at the optimum promises less than this share."""
_RESET_S = 0.03
"""Where the search for an integrator begins: near none, friction hides what it does [s]."""
INTEGRATOR = "reset_time_s"


@dataclasses.dataclass(frozen=True, slots=True)
class Choice:
    """A structure that was chosen.

    Attributes:
        best: Its optimum.
        rivals: Optima of other structures that leave no more, for all that the log tells.
    """

    best: Solution
    rivals: tuple[Solution, ...] = ()


def leaves_less(one: Solution, other: Solution) -> bool:
    """Whether one optimum leaves less than another, by more than chance."""
    gains = other.squares - one.squares
    error = float(np.std(gains, ddof=1)) / len(gains) ** 0.5
    sure = float(np.mean(gains)) > _SURE * error
    return one.cost < (_WORTH if sure else _PLAIN) * other.cost


def with_integrator(free: Sequence[str], *, forced: bool) -> list[str]:
    """Names that are fitted where the drive integrates.

    Args:
        free: Names that are fitted where it does not.
        forced: Whether a force is logged: without one, the integrator hides a constant force.
    """
    return [*(name for name in free if forced or name != "constant_force"), INTEGRATOR]


def integrating(parameters: Parameters) -> Parameters:
    """These, with an integrator where they have none."""
    return dataclasses.replace(parameters, reset_time_s=parameters.reset_time_s or _RESET_S)


def choose_structure(problem: Problem, core: Solution, *, forced: bool) -> Choice:
    """Take in what else a log asks for, and give up what it then does not ask for.

    Args:
        problem: What is minimised.
        core: The optimum of what every drive has.
        forced: Whether a force is logged.
    """
    best, rivals = core, list[Solution]()
    while True:
        tried = _tried(problem, best, forced=forced)
        better = min(tried, key=lambda solution: solution.cost, default=best)
        if better is best or not leaves_less(better, best):
            break
        rivals = [
            other
            for other in tried
            if other is not better and leaves_less(other, best) and not leaves_less(better, other)
        ]
        best = better
    return Choice(_without_idle(problem, best, core), tuple(rivals))


def _tried(problem: Problem, best: Solution, *, forced: bool) -> list[Solution]:
    """Optima with one parameter more."""
    left = [name for name in EXTRAS if name not in best.free]
    promised = promised_costs(problem, best, left)
    tried = [
        solve(problem, best.parameters, [*best.free, name])
        for name in left
        if promised[name] < _HOPE * best.cost and name != INTEGRATOR
    ]
    if INTEGRATOR in left:
        free = with_integrator(best.free, forced=forced)
        tried.append(solve(problem, integrating(best.parameters), free))
    return tried


def _without_idle(problem: Problem, best: Solution, core: Solution) -> Solution:
    """Give up what was taken in first and does nothing beside what came later."""
    for name in [name for name in best.free if name not in core.free]:
        kept = [other for other in best.free if other != name]
        stays = dataclasses.replace(best.parameters, **{name: getattr(core.parameters, name)})
        less = solve(problem, stays, kept)
        if not leaves_less(best, less):
            best = less
    return best
