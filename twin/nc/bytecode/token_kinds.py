"""What the letter of a plain word is: its token kind."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.nc.canonical import IntArray

ByteArray = npt.NDArray[np.uint8]

UNSUPPORTED = -1
"""A letter, a word or a block that has no compiled form, or no entry in a table."""

OTHER, NUMBER, CODE, FEED, FUNCTION, RADIUS, CENTER, AXIS = 0, 1, 2, 3, 4, 5, 6, 9
"""N, G, F, M, R; I, J, K from ``CENTER`` on; axes by their column from ``AXIS``; any other letter."""


class LineTables(NamedTuple):
    """How a dialect's lines are read.

    Attributes:
        token_kinds: What each letter is, shape (26,).
        openings: First bytes of each kind of comment, 0 where there is none, shape (c, 2).
        closings: First bytes of what ends a comment of each kind; 0, 0: the end of the line.
        whole_line: It can only begin its line, shape (c,).
        pointed: Numbers of the letter are plain with a decimal point only, unless 0, shape (26,).
        longest: Bytes of a line that may be plain.
    """

    token_kinds: IntArray
    openings: ByteArray
    closings: ByteArray
    whole_line: npt.NDArray[np.bool_]
    pointed: npt.NDArray[np.bool_]
    longest: int
