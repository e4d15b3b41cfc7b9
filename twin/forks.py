"""Independent copies of running state, for going back to it later."""

import copy
from typing import Any, TypeVar

StateT = TypeVar("StateT")


def forked(state: StateT, **own: Any) -> StateT:
    """A shallow copy of a state, with its own values for what changes in place.

    Args:
        state: What its other attributes refer to is immutable, or is only ever replaced.
        own: By attribute.
    """
    other = copy.copy(state)
    for name, value in own.items():
        setattr(other, name, value)
    return other
