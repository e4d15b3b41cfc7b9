"""Numba's options of a compilation, compared at once instead of one by one.

Numba looks every function that compiled code calls up by its options, a hundred thousand times a minute.
Its own hash of them is that of their names, which all options share, and its comparison reads all twenty
of both sides: a tenth of what compilation takes.
"""

from typing import Any

from numba.core.targetconfig import TargetConfig


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


def compare_at_once() -> None:
    """Let Numba compare so in this process."""
    TargetConfig.__hash__ = _hash
    TargetConfig.__eq__ = _equal
