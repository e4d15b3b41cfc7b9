"""Which structure a log asks for: filters, dead time, feed-forward, an integrator, one after the other.

One parameter more always leaves less. It is taken where it leaves less in nearly every stretch of time,
and given up again where another that came later does its work. Structures that do as well as
the one that was chosen are rivals: what differs between them is not known, and intervals hold it.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np

from twin.calibrate.fit.parameters import Parameters
from twin.calibrate.fit.solve import ROUGH, Problem, Solution, promised_costs, solve
from twin.nc.canonical import FloatArray

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
_STARTS = {
    "reset_time_s": 0.03, "loop_delay_s": 0.001, "velocity_filter_s": 0.001, "command_filter_s": 0.003,
    "measuring_filter": 0.002,
}  # fmt: skip
"""Where the search for what an axis has not begins [s]: off none, where a search within bounds hardly moves."""
INTEGRATOR = "reset_time_s"
_WHITE = 0.05
"""Below this correlation of neighbours, what is left is noise."""


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


def started(parameters: Parameters, name: str) -> Parameters:
    """These, with some of a parameter where they have none of it."""
    value = getattr(parameters, name) or _STARTS.get(name, 0.0)
    return dataclasses.replace(parameters, **{name: value})


def choose_structure(problem: Problem, cores: Sequence[Solution], *, forced: bool) -> Choice:
    """Take in what else a log asks for, and give up what it then does not ask for.

    Args:
        problem: What is minimised.
        cores: Optima of what every drive has, the likeliest first. Another is asked where what comes
            of the first leaves more than noise, and counts where it leaves less.
        forced: Whether a force is logged.
    """
    first, *others = cores
    choice = _grown(problem, first, forced=forced)
    for core in others:
        if _is_white(problem.residuals(choice.best.parameters)):
            break
        other = _grown(problem, core, forced=forced)
        choice = other if leaves_less(other.best, choice.best) else choice
    return choice


def _is_white(rest: FloatArray) -> bool:
    """Whether neighbours in what is left are as good as independent: no structure leaves less then."""
    return abs(float(rest[1:] @ rest[:-1])) < _WHITE * float(rest @ rest)


def _grown(problem: Problem, core: Solution, *, forced: bool) -> Choice:
    """What becomes of a core."""
    best, rivals = core, list[Solution]()
    while True:
        tried = _tried(problem, best, forced=forced)
        better = min(tried, key=lambda solution: solution.cost, default=best)
        if better is best or not leaves_less(better, best):
            tried = _exchanged(problem, best, core, forced=forced)
            better = min(tried, key=lambda solution: solution.cost, default=best)
            if better is best or not leaves_less(better, best):
                break
        rivals = [
            other
            for other in tried
            if other is not better and leaves_less(other, best) and not leaves_less(better, other)
        ]
        best = better
    rivals += [other for other in tried if not leaves_less(best, other)]
    return Choice(_without_idle(problem, best, core, forced=forced), tuple(rivals))


def _tried(problem: Problem, best: Solution, *, forced: bool) -> list[Solution]:
    """Optima with one parameter more."""
    return [
        _with(problem, best, name, forced=forced)
        for name, cost in _promised(problem, best, best).items()
        if cost < _HOPE * best.cost or name == INTEGRATOR
    ]


def _exchanged(problem: Problem, best: Solution, core: Solution, *, forced: bool) -> list[Solution]:
    """Optima with another parameter in the place of one that was taken in."""
    found = []
    for name in [name for name in best.free if name not in core.free]:
        less = _without(problem, best, name, core, forced=forced)
        found += [
            _with(problem, less, other, forced=forced)
            for other, cost in _promised(problem, less, best).items()
            if cost < best.cost / _PLAIN
        ]
    return found


def _promised(problem: Problem, less: Solution, best: Solution) -> dict[str, float]:
    """What an optimum might come to with each parameter that neither it nor another one has."""
    left = [name for name in EXTRAS if name not in best.free]
    return promised_costs(problem, less, {name: started(less.parameters, name) for name in left})


def _with(problem: Problem, best: Solution, name: str, *, forced: bool) -> Solution:
    """The optimum with one parameter more."""
    free = with_integrator(best.free, forced=forced) if name == INTEGRATOR else [*best.free, name]
    return solve(problem, started(best.parameters, name), free, until=ROUGH)


def _without(
    problem: Problem, best: Solution, name: str, core: Solution, *, forced: bool
) -> Solution:
    """The optimum without a parameter that was taken in; what the integrator hid is told again."""
    kept = [other for other in best.free if other != name]
    if name == INTEGRATOR and not forced:
        kept.append("constant_force")
    stays = dataclasses.replace(best.parameters, **{name: getattr(core.parameters, name)})
    return solve(problem, stays, kept, until=ROUGH)


def _without_idle(problem: Problem, best: Solution, core: Solution, *, forced: bool) -> Solution:
    """Give up what was taken in first and does nothing beside what came later."""
    for name in [name for name in best.free if name not in core.free]:
        if name in best.free:
            less = _without(problem, best, name, core, forced=forced)
            if not leaves_less(best, less):
                best = less
    return best
