"""Independent copies of running state: immutable parts are shared, references stay references.

``copy.deepcopy`` makes of a view of a NumPy array an array of its own, and cannot copy a
``memoryview``; an interpreter refers to its columns through many of both. So they are found first, and
made again over the copy of what they show.

Decision: one rule for all states, and no ``fork`` written for each of them. A copy of a room reaches some 70 classes,
37 of them of ``twin.nc``, which refer to each other and to bound methods; each would have to wire both again, and a
field that is forgotten is shared with the room that runs on. That would save 0.1 % of a core and a tenth of the memory.
"""

import abc
import copy
import gc
import types
from collections.abc import Callable
from typing import Any, Self, TypeVar

import numpy as np
import numpy.typing as npt

Thing = TypeVar("Thing")

_LEAVES = (
    type,
    types.ModuleType,
    types.FunctionType,
    types.BuiltinFunctionType,
    int,
    float,
    str,
    bytes,
)
"""What is never copied, nor looked into."""


class Forkable(abc.ABC):
    """A state that is cheaper to copy by a rule of its own."""

    @abc.abstractmethod
    def fork(self) -> Self:
        """An independent copy."""


def copied(thing: Thing, shared: Callable[[type], bool], memo: dict[int, Any]) -> Thing:
    """A copy of all that a thing holds.

    Args:
        thing: Holds no generator, and no function that closes over anything that changes.
        shared: Whether what has a type never changes: the copy holds the same one.
        memo: As ``copy.deepcopy`` has it: what is in the copy for each thing, by its id.
    """
    seen: set[int] = set()
    waiting: list[object] = [thing]
    while waiting:
        one = waiting.pop()
        if isinstance(one, _LEAVES) or id(one) in seen or id(one) in memo:
            continue
        seen.add(id(one))
        if shared(type(one)):
            memo[id(one)] = one
        elif isinstance(one, Forkable):
            memo[id(one)] = one.fork()
        elif isinstance(one, np.ndarray):
            if one.base is not None:
                _look_at_copy(one, one, memo)
        elif isinstance(one, memoryview):
            _look_at_copy(one, np.asarray(one), memo)
        else:
            waiting += gc.get_referents(one)
    return copy.deepcopy(thing, memo)


def _look_at_copy(view: object, seen: npt.NDArray[Any], memo: dict[int, Any]) -> None:
    """Note what a view becomes, given what is seen through it; views of foreign memory are left alone."""
    owner: Any = view
    while isinstance(owner, np.ndarray | memoryview):
        below = owner.base if isinstance(owner, np.ndarray) else owner.obj
        if below is None:
            break
        owner = below
    if not isinstance(owner, np.ndarray):
        return
    if id(owner) not in memo:
        memo[id(owner)] = owner.copy(order="K")
    made = np.ndarray(
        seen.shape,
        seen.dtype,
        memo[id(owner)].ravel(order="K"),
        _address(seen) - _address(owner),
        seen.strides,
    )
    memo[id(view)] = made.data if isinstance(view, memoryview) else made


def _address(array: npt.NDArray[Any]) -> int:
    return array.__array_interface__["data"][0]
