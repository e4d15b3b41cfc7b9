"""The variables of a running program, kept as columns, which the compiled tier computes with as well."""

from collections.abc import Callable, Mapping

import numpy as np

from twin.nc.bytecode.frames import DEPTH, VariableStore
from twin.nc.canonical import FloatArray, IntArray

_ROOM = 32
"""Variables and calls that the columns begin with."""


class Variables:
    """Values by name; NaN stands for none, which no expression gives.

    A slot numbers a name: from 0 those that the whole program shares, ``~0`` and below those that
    each call with variables of its own has anew.

    Attributes:
        common: Values of the shared ones, shape (n,).
        local: Values of the others, of the main program and of each call, shape (calls, m).
        given_common: What the job gives where the program has set none, shape (n,).
        given_local: What the job gives of the others, shape (m,).
    """

    def __init__(
        self,
        is_local: Callable[[str], bool],
        given: Callable[[str], float | None],
        progress: IntArray,
    ) -> None:
        """Without variables.

        Args:
            is_local: Whether calls have a variable of that name anew.
            given: The job's value of a variable, or None.
            progress: How far the program has come; its ``DEPTH`` is the row of ``local`` in use.
        """
        self._is_local = is_local
        self._given = given
        self._slots: dict[str, int] = {}
        self._count = [0, 0]
        self.common = np.full(_ROOM, np.nan)
        self.given_common = np.full(_ROOM, np.nan)
        self.local = np.full((_ROOM, _ROOM), np.nan)
        self.given_local = np.full(_ROOM, np.nan)
        self._progress = progress.data

    @property
    def columns(self) -> VariableStore:
        """The columns, which grow with the names that are known."""
        return VariableStore(self.common, self.given_common, self.local, self.given_local)

    def slot(self, name: str) -> int:
        """The slot of a name."""
        slot = self._slots.get(name)
        if slot is None:
            given = self._given(name)
            slot = self._new_slot(name, np.nan if given is None else given)
            self._slots[name] = slot
        return slot

    def _new_slot(self, name: str, given: float) -> int:
        kind = self._is_local(name)
        number = self._count[kind]
        self._count[kind] += 1
        if kind:
            if number == len(self.given_local):
                self.local = np.hstack([self.local, np.full_like(self.local, np.nan)])
                self.given_local = _doubled(self.given_local)
            self.given_local[number] = given
            return ~number
        if number == len(self.common):
            self.common, self.given_common = _doubled(self.common), _doubled(self.given_common)
        self.given_common[number] = given
        return number

    def read(self, name: str) -> float | None:
        """The value of a variable; where the program has set none the job's, or None."""
        slot = self._slots.get(name)
        if slot is None:
            return self._given(name)
        value = float(self.common[slot] if slot >= 0 else self.local[self._progress[DEPTH], ~slot])
        return value if value == value else self._given(name)

    def write(self, name: str, value: float) -> None:
        """Set a variable."""
        slot = self.slot(name)
        if slot >= 0:
            self.common[slot] = value
        else:
            self.local[self._progress[DEPTH], ~slot] = value

    def forget(self, name: str) -> None:
        """From now on the variable has no value."""
        self.write(name, np.nan)

    def enter(self, values: Mapping[str, float]) -> None:
        """A call begins that has local variables of its own, these at first."""
        depth = self._progress[DEPTH] + 1
        if depth == len(self.local):
            self.local = np.vstack([self.local, np.full_like(self.local, np.nan)])
        self._progress[DEPTH] = depth
        self.local[depth] = np.nan
        for name, value in values.items():
            self.write(name, value)


def _doubled(column: FloatArray) -> FloatArray:
    return np.concatenate([column, np.full_like(column, np.nan)])
