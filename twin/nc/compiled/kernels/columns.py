"""Columns copied, compiled: single ones, what is in force, and a whole state.

Assigning a slice would bring NumPy's error messages into the kernel, which are made of objects.
"""

from typing import TypeVar

from twin.compilation.compilable import compilable
from twin.nc.bytecode.registers import State
from twin.nc.canonical import FloatArray, IntArray

Column = TypeVar("Column", FloatArray, IntArray)


@compilable
def copy(source: Column, target: Column) -> None:
    """Copy a column to the first places of another."""
    for index in range(len(source)):
        target[index] = source[index]


@compilable
def copy_rows(source: FloatArray, target: FloatArray) -> None:
    """Copy a table, shape (n, k)."""
    for row in range(source.shape[0]):
        for index in range(source.shape[1]):
            target[row, index] = source[row, index]


@compilable
def copy_active_codes(
    modal: FloatArray, active_codes: IntArray, to_modal: FloatArray, to_active_codes: IntArray
) -> None:
    """Copy what is in force."""
    copy(modal, to_modal)
    copy(active_codes, to_active_codes)


@compilable
def copy_state(source: State, target: State) -> None:
    """Copy every column of a state."""
    copy_active_codes(source.modal, source.active_codes, target.modal, target.active_codes)
    copy(source.programmed, target.programmed)
    copy(source.part, target.part)
    copy(source.registers, target.registers)
    copy(source.total, target.total)
    copy_rows(source.shifts, target.shifts)
    target.event_count[0] = source.event_count[0]
