"""Two slow steps of Numba's compilation, replaced by faster ones.

Options of a compilation are compared at once. Numba looks every function that compiled code calls up by its options, a
hundred thousand times a minute: its own hash of them is that of their names, which all options share, and its
comparison reads all twenty of both sides.

An array that does not fit the slice that it is assigned to raises an error of constant text. Numba's names both shapes, for
which it compiles the making of texts into every kernel that assigns an array to a slice.
"""

import functools
from collections.abc import Callable
from typing import Any

from numba.core.targetconfig import TargetConfig
from numba.extending import overload


def _changed(self: TargetConfig) -> dict[str, Any]:
    """Options that differ from what they are by default."""
    values: dict[str, Any] = self._values
    options: Any = type(self).options
    return {name: value for name, value in values.items() if value != options[name].default}


def _hash(self: TargetConfig) -> int:
    return hash(frozenset(_changed(self)))  # of names: values need not be hashable


def _equal(self: TargetConfig, other: object) -> bool:
    if self is other:
        return True
    return isinstance(other, TargetConfig) and _changed(self) == _changed(other)


def _raise_without_shapes(source: object, slice_: object) -> None:
    """Stands for Numba's ``raise_with_shape_context``, of whose kind a target may have its own."""


def _raising(source: object, slice_: object) -> Callable[[object, object], None]:
    del source, slice_

    def form(source: object, slice_: object) -> None:  # noqa: ARG001 (what Numba calls it with)
        raise ValueError("cannot assign slice from input of different size")

    return form


def take_shortcuts() -> None:
    """Let Numba compare options so in this process."""
    TargetConfig.__hash__ = _hash
    TargetConfig.__eq__ = _equal


@functools.cache
def take_array_shortcut() -> None:
    """Let Numba raise that error of an array in this process; it loads what only a compilation needs."""
    from numba.np import arrayobj

    overload(_raise_without_shapes)(_raising)
    arrayobj.raise_with_shape_context = _raise_without_shapes
