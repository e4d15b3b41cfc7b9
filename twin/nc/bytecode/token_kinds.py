"""What the letter of a plain word is: its token kind."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.nc.canonical import IntArray
from twin.nc.text.comments import CommentMarks

ByteArray = npt.NDArray[np.uint8]

UNSUPPORTED = -1
"""A letter, a word or a block that has no compiled form, or no entry in a table."""

OTHER, NUMBER, CODE, FEED, FUNCTION, RADIUS, CENTER, AXIS = 0, 1, 2, 3, 4, 5, 6, 9
"""N, G, F, M, R; I, J, K from ``CENTER`` on; axes by their column from ``AXIS``; any other letter."""


class LineTables(NamedTuple):
    """How a dialect's lines are read.

    Attributes:
        token_kinds: What each letter is, shape (26,).
        comments: How comments are marked.
        pointed: Numbers of the letter are plain with a decimal point only, unless 0, shape (26,).
        longest: Bytes of a line that may be plain.
    """

    token_kinds: IntArray
    comments: CommentMarks
    pointed: npt.NDArray[np.bool_]
    longest: int
