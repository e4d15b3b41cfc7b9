"""Which structure a log asks for: filters, dead time, feed-forward, an integrator.

One parameter more always leaves less. It is taken where it leaves less in nearly every stretch of time,
and given up again where another that came later does its work. Structures that do as well as
the one that was chosen are rivals: what differs between them is not known, and intervals hold it.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np

from twin.calibrate.fit.promising import Core, Promise, promising, started
from twin.calibrate.fit.solve import ROUGH, Problem, Solution, solve
from twin.nc.canonical import FloatArray

_PLAIN = 0.9
"""What leaves less than this share of what was left without it is worth a parameter more."""
_WORTH = 0.99
"""So is what leaves less than this share, where it is no chance:"""
_SURE = 4.0
"""its gain over the stretches of time is more than so many of its standard errors."""
_WHITE = 0.05
"""Below this correlation of neighbours, what is left is noise."""


@dataclasses.dataclass(frozen=True, slots=True)
class Tried:
    """A structure that was tried.

    Attributes:
        extras: What it has in addition to gain, damping, friction and mass.
        left: Root mean square of what it leaves, weighted.
    """

    extras: tuple[str, ...]
    left: float


@dataclasses.dataclass(frozen=True, slots=True)
class StructureChoice:
    """A structure that was chosen.

    Attributes:
        rivals: Optima of other structures that leave no more, for all that the log tells.
        larger: Optima with one extra more, by its name: they leave less, but by chance.
        tried: All structures that were looked at, and the one that was chosen, which comes first.
    """

    best: Solution
    rivals: tuple[Solution, ...] = ()
    larger: dict[str, Solution] = dataclasses.field(default_factory=dict)
    tried: tuple[Tried, ...] = ()


def leaves_less(one: Solution, other: Solution) -> bool:
    """Whether one optimum leaves less than another, by more than chance."""
    gains = other.squares - one.squares
    error = float(np.std(gains, ddof=1)) / len(gains) ** 0.5
    sure = float(np.mean(gains)) > _SURE * error
    return one.cost < (_WORTH if sure else _PLAIN) * other.cost


def choose_structure(problem: Problem, cores: Sequence[tuple[Solution, Core]]) -> StructureChoice:
    """Take in what else a log asks for, and give up what it then does not ask for.

    Args:
        cores: Optima where a search begins, with what all structures that come of them have, the
            likeliest first. Another is asked where what comes of the first leaves more than noise.
    """
    choice = _grown(problem, *cores[0])
    for solution, core in cores[1:]:
        if _is_white(problem.residuals(choice.best.parameters)):
            break
        other = _grown(problem, solution, core)
        if leaves_less(other.best, choice.best):
            choice, other = other, choice
        choice = dataclasses.replace(choice, tried=(*choice.tried, *other.tried))
    return choice


def _is_white(rest: FloatArray) -> bool:
    """Whether neighbours in what is left are as good as independent: no structure leaves less then."""
    return abs(float(rest[1:] @ rest[:-1])) < _WHITE * float(rest @ rest)


def _grown(problem: Problem, start: Solution, core: Core) -> StructureChoice:
    """What becomes of a core."""
    best, known = start, dict[frozenset[str], Solution]()
    while True:
        for promise in promising(problem, best, core):
            extras = frozenset(promise.extras)
            if extras not in known:
                known[extras] = _searched(problem, best, promise, core)
        better = min(known.values(), key=lambda solution: solution.cost, default=best)
        if not leaves_less(better, best):
            break
        best = better
    best = _without_idle(problem, best, core)
    own = frozenset(core.extras_of(best))
    larger = {
        next(iter(extras - own)): other
        for extras, other in known.items()
        if own < extras and len(extras - own) == 1
    }
    tried = [Tried(tuple(core.extras_of(each)), each.cost) for each in (best, start)]
    tried += [Tried(tuple(sorted(extras)), each.cost) for extras, each in known.items()]
    return StructureChoice(best, _rivals(best, list(known.values()), core), larger, tuple(tried))


def _searched(problem: Problem, best: Solution, promise: Promise, core: Core) -> Solution:
    """The optimum of a structure, from where tangents end or from usual values, whichever is nearer."""
    free = core.free(promise.extras)
    usual = dataclasses.replace(best.parameters, **core.unset_where(free))
    for name in promise.extras:
        usual = started(usual, name)
    starts = [promise.start, usual]
    left = [float(np.sum(problem.residuals(start) ** 2)) for start in starts]
    nearer = starts[int(np.argmin(left))]
    return solve(problem, nearer, free, until=ROUGH)


def _rivals(best: Solution, others: Sequence[Solution], core: Core) -> tuple[Solution, ...]:
    """What the best leaves behind by chance alone, without structures that only add to another."""
    rivals = [best]
    for other in sorted(others, key=lambda solution: len(solution.free)):
        own = set(core.extras_of(other))
        parts = [rival for rival in rivals if set(core.extras_of(rival)) <= own]
        if not leaves_less(best, other) and all(leaves_less(other, part) for part in parts):
            rivals.append(other)
    return tuple(rivals[1:])


def _without_idle(problem: Problem, best: Solution, core: Core) -> Solution:
    """Drop extras that no longer improve the fit."""
    for name in core.extras_of(best):
        free = core.free([other for other in core.extras_of(best) if other != name])
        stays = dataclasses.replace(best.parameters, **core.unset_where(free))
        less = solve(problem, stays, free, until=ROUGH)
        if not leaves_less(best, less):
            best = less
    return best
