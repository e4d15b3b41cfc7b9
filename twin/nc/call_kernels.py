"""Parts of the program that are called or repeated, in the compiled run."""

from twin.nc.canonical import IntArray
from twin.nc.compile_kernels import kernel
from twin.nc.instructions import PART_BITS
from twin.nc.routine_state import (
    AGAIN,
    BACK,
    CALLS,
    DEPTH,
    FIRST,
    LAST,
    LINE,
    NO_PLACE,
    OWN,
    PART,
)

_PART_MASK = (1 << PART_BITS) - 1


@kernel
def end_parts(progress: IntArray, calls: IntArray) -> None:
    """Parts that end by place and have been passed run again, or go back to their caller."""
    while progress[CALLS] > 0:
        call = calls[progress[CALLS] - 1]
        here = progress[LINE] << PART_BITS | progress[PART]
        if call[LAST] == NO_PLACE or here <= call[LAST]:
            return
        to = call[FIRST]
        if call[AGAIN] > 0:
            call[AGAIN] -= 1
        else:
            to = call[BACK]
            progress[CALLS] -= 1
            progress[DEPTH] -= call[OWN]
        progress[LINE], progress[PART] = to >> PART_BITS, to & _PART_MASK


@kernel
def innermost(calls: IntArray, called: int) -> int:
    """How many parts are being run up to the innermost that a word ends; 0: there is none."""
    while called > 0 and calls[called - 1, LAST] != NO_PLACE:
        called -= 1
    return called
