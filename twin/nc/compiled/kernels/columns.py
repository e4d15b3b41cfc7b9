"""Columns copied, compiled.

Assigning a slice would bring NumPy's error messages into the kernel, which are made of objects.
"""

from typing import TypeVar

from twin.compilation.kernel import kernel
from twin.nc.canonical import FloatArray, IntArray

Column = TypeVar("Column", FloatArray, IntArray)


@kernel
def copy(source: Column, target: Column) -> None:
    """Copy a column to the first places of another."""
    for index in range(len(source)):
        target[index] = source[index]


@kernel
def copy_rows(source: FloatArray, target: FloatArray) -> None:
    """Copy a table, shape (n, k)."""
    for row in range(source.shape[0]):
        for index in range(source.shape[1]):
            target[row, index] = source[row, index]
