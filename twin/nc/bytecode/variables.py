"""The variables of a running program, kept as columns: both tiers store and read them here."""

import math
from collections.abc import Callable

import numpy as np

from twin.compilation.compilable import compilable, inlined
from twin.nc.bytecode.frames import DEPTH, STORES, Scratch, VariableStore
from twin.nc.canonical import FloatArray, IntArray

_ROOM = 32
"""Variables and calls that the columns begin with."""
NO_SLOT = np.iinfo(np.int64).min
"""No variable."""


@compilable
def slot_of_number(numbered: IntArray, index: float) -> int:
    """Slot of the variable with a number; ``NO_SLOT`` where it has none."""
    if not 0.0 <= index < len(numbered) or index != np.floor(index):
        return NO_SLOT
    if math.copysign(1.0, index) < 0.0:  # -0 is written otherwise than 0
        return NO_SLOT
    return numbered[int(index)]


@compilable
def own_value(memory: VariableStore, depth: int, slot: int) -> float:
    """What the program has given a variable; NaN: nothing."""
    return memory.common[slot] if slot >= 0 else memory.local[depth, ~slot]


@compilable
def load(memory: VariableStore, depth: int, slot: int) -> float:
    """Value of a variable, the job's where it has none of its own; NaN: none at all."""
    value = own_value(memory, depth, slot)
    if np.isnan(value):
        value = memory.given_common[slot] if slot >= 0 else memory.given_local[~slot]
    return value


@compilable
def store(memory: VariableStore, depth: int, slot: int, value: float) -> None:
    """Give a variable a value; NaN takes it away."""
    if slot >= 0:
        memory.common[slot] = value
    else:
        memory.local[depth, ~slot] = value


@inlined
def undo_stores(depth: int, memory: VariableStore, scratch: Scratch) -> None:
    """Give the variables that a block has set their values before it."""
    for change in range(scratch.counts[STORES] - 1, -1, -1):
        store(memory, depth, scratch.slots[change], scratch.before[change])


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
        *,
        vacant: bool = False,
    ) -> None:
        """Without variables.

        Args:
            is_local: Whether calls have a variable of that name anew.
            given: The job's value of a variable, or None.
            progress: How far the program has come; its ``DEPTH`` is the row of ``local`` in use.
            vacant: A program can take the value of a variable away, so that the job's is what the main
                program's variable begins with.
        """
        self._vacant = vacant
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
            if self._vacant:
                self.local[0, number] = given
            else:
                self.given_local[number] = given
            return ~number
        if number == len(self.common):
            self.common, self.given_common = _doubled(self.common), _doubled(self.given_common)
        if self._vacant:
            self.common[number] = given
        else:
            self.given_common[number] = given
        return number

    def read(self, name: str) -> float | None:
        """The value of a variable; where the program has set none the job's, or None."""
        slot = self._slots.get(name)
        if slot is None:
            return self._given(name)
        value = float(load(self.columns, self._progress[DEPTH], slot))
        return value if value == value else None

    def write(self, name: str, value: float) -> None:
        """Set a variable."""
        slot = self.slot(name)  # which may make the columns grow
        store(self.columns, self._progress[DEPTH], slot, value)

    def make_room(self, depth: int) -> None:
        """Let there be a row of local variables for calls so deep."""
        if depth == len(self.local):
            self.local = np.vstack([self.local, np.full_like(self.local, np.nan)])


def _doubled(column: FloatArray) -> FloatArray:
    return np.concatenate([column, np.full_like(column, np.nan)])
