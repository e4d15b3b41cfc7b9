"""Columns copied, compiled.

Assigning a slice would bring NumPy's error messages into the kernel, which are made of objects.
"""

from typing import TypeVar

from twin.compilation.compilable import compilable
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
