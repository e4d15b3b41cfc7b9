"""Canonical moves: the common result of every dialect's program.

The verbs between a dialect and the rest of the twin are few: straight moves and arcs (a helix is
an arc that also advances along its normal), dwells, and functions such as M3. Every one carries
the source line that caused it.

Conventions, for all packages:

* Positions are the part's (program zero of the job), in mm and degrees, continuous: a table that
  turned twice is at 720.
* The first three axes are always X, Y, Z. Any further axes follow, linear or rotary.
* An arc's ``sweep`` is signed: positive is counter-clockwise about ``normal``, and it counts every
  turn. With u from 0 to 1 the tool is at
  ``center + rotate(normal, u * sweep) (start - center) + u * advance * normal``, where ``advance``
  is the component of ``end - start`` along the normal; all other axes go linearly with u.
* A curve is a part of a move under tool centre point control: the axes go by the polynomials of ``curve``,
  and the tip goes straight in the part, or on an arc: then ``normal`` is seen from the part, and so is
  ``center``, which leads from the tip at the start to the arc's centre. ``length`` is the tip's.
* ``length`` is what the feed counts: mm along the path of X Y Z, or, where these stand still, the
  length of the other linear axes, and where those stand still too, the degrees of the rotary axes
  (Euclidean where several move).
* A rapid starts and ends at standstill, and so does whatever touches a dwell or a function.
"""

import dataclasses
import enum
from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from twin.units import AxisKind

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]
CodeArray = npt.NDArray[np.uint8]

SPATIAL_AXES = ("X", "Y", "Z")
"""The axes that arcs and path feeds are about; every machine has them, and first."""

NO_BLOCK_NUMBER = -1
"""In ``Moves.block``: the block carries no N number."""


class Motion(enum.IntEnum):
    """How fast a move wants to go."""

    RAPID = 0
    FEED = 1


class Shape(enum.IntEnum):
    """The geometry of a move."""

    LINE = 0
    ARC = 1
    CURVE = 2
    """Every axis goes by a polynomial of the path fraction (``Moves.curve``)."""


class FeedUnit(enum.IntEnum):
    """What the feed of a move counts."""

    MM_PER_MIN = 0
    DEG_PER_MIN = 1


FEED_UNIT_NAMES = {FeedUnit.MM_PER_MIN: "mm/min", FeedUnit.DEG_PER_MIN: "deg/min"}


class Corner(enum.IntEnum):
    """How the end of a move is passed."""

    EXACT_STOP = 0
    """The axes come to rest."""
    EXACT_PATH = 1
    """The path is kept; the speed falls only as far as the corner demands."""
    CONTINUOUS = 2
    """The corner may be rounded, by ``corner_tolerance`` at most."""


@dataclasses.dataclass(frozen=True, slots=True)
class Axes:
    """The axes of a stream of moves, in the order of the columns.

    Attributes:
        names: X, Y, Z first.
        kinds: ``linear`` or ``rotary``, one per name.
    """

    names: tuple[str, ...]
    kinds: tuple[AxisKind, ...]

    def __post_init__(self) -> None:
        if self.names[:3] != SPATIAL_AXES or len(self.names) != len(self.kinds):
            raise ValueError(f"axes must begin with X, Y, Z and each have a kind: {self}")

    def __len__(self) -> int:
        return len(self.names)

    def index(self, name: str) -> int:
        """Column of the axis called ``name``."""
        return self.names.index(name)

    def rotary(self) -> npt.NDArray[np.bool_]:
        """Mask of the rotary axes, shape (k,)."""
        return np.array([kind == "rotary" for kind in self.kinds])

    def named(self, values: Iterable[float]) -> dict[str, float]:
        """Pair one row of values with the axis names."""
        return {name: float(value) for name, value in zip(self.names, values, strict=True)}


@dataclasses.dataclass(frozen=True, slots=True)
class Moves:
    """A chunk of n canonical moves over k axes, as columns.

    Attributes:
        axes: Names and kinds of the k axes.
        motion: ``Motion`` codes, shape (n,).
        shape: ``Shape`` codes, shape (n,).
        line: Source line, counted from 1, shape (n,).
        block: N number of the block or ``NO_BLOCK_NUMBER``, shape (n,).
        start: Position before the move, shape (n, k) [mm or deg].
        end: Position after the move, shape (n, k) [mm or deg].
        display: What the control's screen shows at the end, shape (n, k) [mm or deg].
        feed: Shape (n,) [mm/min or deg/min by ``feed_unit``]; NaN for rapids.
        feed_unit: ``FeedUnit`` codes, shape (n,).
        length: What the feed counts, shape (n,) [mm or deg].
        center: Centre of arcs at the height of their start, shape (n, 3) [mm]; NaN for lines.
        normal: Unit normal of arcs, shape (n, 3); NaN for lines.
        radius: Shape (n,) [mm]; NaN for lines.
        sweep: Signed angle of arcs, all turns counted, shape (n,) [deg]; 0 for lines.
        corner: ``Corner`` codes of the moves' ends, shape (n,).
        corner_tolerance: Largest rounding of a continuous corner, shape (n,) [mm]; NaN: the
            machine's.
        acceleration: Programmed limit along the path, shape (n,) [mm/s² or deg/s² by
            ``feed_unit``]; NaN: the machine's.
        deceleration: Programmed limit for slowing down, positive, in the units of ``acceleration``,
            shape (n,).
        curve: What curves add to ``start``, coefficients by powers 1 to 5 of u, 0 for other shapes, shape
            (n, k, 5) [mm or deg]; None: there is no curve.
        screen: What a millimetre of X, Y and Z, of a curve of the tip in the part, adds to what the screen shows, as
            columns, shape (n, 3, 3); None: everywhere the same.
    """

    axes: Axes
    motion: CodeArray
    shape: CodeArray
    line: IntArray
    block: IntArray
    start: FloatArray
    end: FloatArray
    display: FloatArray
    feed: FloatArray
    feed_unit: CodeArray
    length: FloatArray
    center: FloatArray
    normal: FloatArray
    radius: FloatArray
    sweep: FloatArray
    corner: CodeArray
    corner_tolerance: FloatArray
    acceleration: FloatArray
    deceleration: FloatArray
    curve: FloatArray | None = None
    screen: FloatArray | None = None

    def __len__(self) -> int:
        return len(self.line)

    def __getitem__(self, index: slice | npt.NDArray[np.bool_] | IntArray) -> "Moves":
        """A selection of the moves, as columns again."""
        columns = {name: getattr(self, name)[index] for name in _COLUMNS}
        curve = None if self.curve is None else self.curve[index]
        screen = None if self.screen is None else self.screen[index]
        return Moves(self.axes, **columns, curve=curve, screen=screen)

    def __iter__(self) -> Iterator[dict[str, float | int]]:
        """One flat row a move, for people and data frames; calculations take the columns."""
        table = self.table()
        for row in zip(*(column.tolist() for column in table.values()), strict=True):
            yield dict(zip(table, row, strict=True))

    def table(self) -> dict[str, npt.NDArray[np.generic]]:
        """Flat columns of n values by name, vectors taken apart (``end_X``): for a data frame."""
        columns: dict[str, npt.NDArray[np.generic]] = {}
        for name in _COLUMNS:
            column = getattr(self, name)
            parts = self.axes.names if name in _AXIS_ROWS else SPATIAL_AXES
            if column.ndim == 1:
                columns[name] = column
            else:
                columns |= {f"{name}_{part}": column[:, at] for at, part in enumerate(parts)}
        return columns

    @staticmethod
    def empty(axes: Axes) -> "Moves":
        """No moves over the given axes."""
        return concatenate([], axes)


_COLUMNS = tuple(
    field.name
    for field in dataclasses.fields(Moves)
    if field.name not in ("axes", "curve", "screen")
)
_CODES = ("motion", "shape", "feed_unit", "corner")
_INTEGERS = ("line", "block")
_VECTORS = ("center", "normal")
_AXIS_ROWS = ("start", "end", "display")


def concatenate(parts: Iterable[Moves], axes: Axes) -> Moves:
    """Join chunks of moves into one; no parts give no moves."""
    parts = list(parts)
    columns = {}
    for name in _COLUMNS:
        arrays = [getattr(part, name) for part in parts]
        columns[name] = np.concatenate(arrays) if arrays else _empty_column(name, len(axes))
    curve = _joined(parts, [part.curve for part in parts], np.zeros((len(axes), 5)))
    screen = _joined(parts, [part.screen for part in parts], np.eye(3))
    return Moves(axes, **columns, curve=curve, screen=screen)


def _joined(
    parts: Sequence[Moves], columns: Sequence[FloatArray | None], usual: FloatArray
) -> FloatArray | None:
    """A column that some parts lack, with a row's usual value there; None where all of them do."""
    if all(column is None for column in columns):
        return None
    return np.concatenate(
        [
            np.tile(usual, (len(part), 1, 1)) if column is None else column
            for part, column in zip(parts, columns, strict=True)
        ]
    )


def _empty_column(name: str, axis_count: int) -> npt.NDArray[np.generic]:
    if name in _CODES:
        return np.zeros(0, np.uint8)
    if name in _INTEGERS:
        return np.zeros(0, np.int64)
    if name in _VECTORS:
        return np.zeros((0, 3))
    if name in _AXIS_ROWS:
        return np.zeros((0, axis_count))
    return np.zeros(0)


@dataclasses.dataclass(frozen=True, slots=True)
class Dwell:
    """The machine waits.

    Attributes:
        before: Index of the move of the same chunk that comes next; the chunk's length at its end.
    """

    before: int
    line: int
    seconds: float


@dataclasses.dataclass(frozen=True, slots=True)
class Function:
    """A word that does something other than move: M3, M30, T2.

    Attributes:
        before: As in ``Dwell``.
        word: The word without leading zeros, such as ``M3``.
        arguments: Further words that belong to it, such as S.
        at: How much of the next move's path lies behind when it happens, 0 to 1; above 0 only for
            switch points, which do not stop the path.
    """

    before: int
    line: int
    word: str
    arguments: Mapping[str, float]
    at: float = 0.0


Event = Dwell | Function


@dataclasses.dataclass(frozen=True, slots=True)
class Chunk:
    """A few thousand moves with the events between them, in program order."""

    moves: Moves
    events: Sequence[Event] = ()
