"""What only Klartext remembers: values of cycles, pole, tool data of the program, cycles, labels, transformations."""

import dataclasses
from collections.abc import Callable, Mapping

from twin.nc.control.control import Control
from twin.nc.control.settings import ToolData
from twin.nc.geometry.matrices import Matrix
from twin.nc.geometry.planes import Plane, Vector
from twin.nc.path.feed_rates import FeedMode
from twin.nc.path.move_columns import Segment

RAPID = 99_999.0
"""A feed from here on in a cycle means FMAX (manual)."""
INCH_FEEDS = 0.1
"""F of programs in inches counts tenths of an inch per minute (manual)."""


@dataclasses.dataclass(frozen=True, slots=True)
class CycleParameters:
    """What a cycle was given, in the program's units.

    Attributes:
        values: By number of the Q parameter; a feed that is FMAX is ``RAPID``.
        unit: Of lengths [mm].
        line: Of the definition, from 1.
        live: The program changes them by assigning Q parameters.
    """

    name: str
    values: Mapping[int, float]
    unit: float
    line: int
    live: bool = True

    def number(self, parameter: int, default: float = 0.0) -> float:
        """A value as it is written."""
        return self.values.get(parameter, default)

    def length(self, parameter: int, default: float = 0.0) -> float:
        """A length [mm]; the default counts in the program's unit."""
        return self.values.get(parameter, default) * self.unit

    def feed(self, parameter: int) -> float | None:
        """A feed as F counts it; None: FMAX."""
        value = self.values.get(parameter, 0.0)
        if value >= RAPID:
            return None
        return value if self.unit == 1.0 else value * INCH_FEEDS

    def replaced(self, values: Mapping[int, float]) -> "CycleParameters":
        """The same with other values."""
        return dataclasses.replace(self, values={**self.values, **values})


Cycle = Callable[[Control, CycleParameters], None]


@dataclasses.dataclass(frozen=True, slots=True)
class Deltas:
    """What TOOL CALL adds to a tool.

    Attributes:
        radius: DR [mm].
        length: DL [mm].
    """

    radius: float = 0.0
    length: float = 0.0


@dataclasses.dataclass(slots=True)
class KlartextMemory:
    """The state of the dialect.

    Attributes:
        pole: Of CC, by column of its axes, programmed coordinates [mm].
        circle_plane: That the axes of CC name; None: that of the tool axis.
        rapid: FMAX is in the block that runs.
        was_rapid: It stood in the last block of a path.
        machine: What M91 or M92 has put in the block that runs, or empty.
        tool_feed: F of the last TOOL CALL, for F AUTO; None: it had none.
        per_revolution: M136: F counts millimetres per revolution.
        side: Of radius compensation: 1 left, -1 right, 0 none.
        defined: Tools that TOOL DEF has given values, by number.
        blank: First corner of BLK FORM, programmed coordinates; None before it.
        cycle: The machining cycle that the next call runs; None: none is defined.
        steps: What the steps of an old cycle have given so far, by parameter.
        step: The last of these steps.
        calls_always: M89: it runs behind every block that moves.
        pattern: Places of PATTERN DEF, as they are programmed [mm].
        repeats: How often a block that repeats a part still does so, by its line.
        labels: Line of each label by the first line of its file and its name; None before they were looked for.
        texts: Values of QS parameters.
        shift: Of cycle 7, by column [mm or deg].
        mirrored: Signs of cycle 8.
        rotation: Of cycle 10 [deg].
        scale: Of cycle 11.
        tilt: Directions of the axes of the tilted plane, as columns; None: it is level.
        spatial: Of FUNCTION TCPM AXIS SPAT, the last angles A, B and C [deg]; None: they are axes.
        order: In which of these the program has put them into force.
        chamfered: The move whose end CHF cuts off, or None.
        shortest: M126: rotary axes take the shorter path.
    """

    pole: dict[int, float] = dataclasses.field(default_factory=dict)
    circle_plane: Plane | None = None
    rapid: bool = False
    was_rapid: bool = False
    machine: str = ""
    tool_feed: float | None = None
    per_revolution: bool = False
    side: float = 0.0
    deltas: Deltas = Deltas()
    defined: dict[int, ToolData] = dataclasses.field(default_factory=dict)
    blank: list[float] | None = None
    cycle: Cycle | None = None
    parameters: CycleParameters | None = None
    steps: dict[int, float] = dataclasses.field(default_factory=dict)
    step: int = 0
    calls_always: bool = False
    pattern: list[Vector] = dataclasses.field(default_factory=list)
    repeats: dict[int, int] = dataclasses.field(default_factory=dict)
    labels: dict[tuple[int, str], int] | None = None
    texts: dict[str, str] = dataclasses.field(default_factory=dict)
    shift: dict[int, float] = dataclasses.field(default_factory=dict)
    mirrored: Vector = (1.0, 1.0, 1.0)
    rotation: float = 0.0
    scale: float = 1.0
    tilt: Matrix | None = None
    spatial: Vector | None = None
    order: list[str] = dataclasses.field(default_factory=list)
    chamfered: Segment | None = None
    shortest: bool = False


def memory_of(control: Control) -> KlartextMemory:
    """The dialect's memory."""
    assert isinstance(control.memory, KlartextMemory)
    return control.memory


def acts_on_lines(control: Control) -> bool:
    """A cycle behind every move, shortest ways, a tilted plane, spatial angles, feeds that are none per minute, FMAX before."""
    memory, modal = memory_of(control), control.modal
    counts_otherwise = modal.unit != 1.0 or modal.feed_mode != FeedMode.PER_MINUTE
    return (
        memory.calls_always
        or memory.shortest
        or memory.tilt is not None
        or memory.spatial is not None
        or memory.was_rapid
        or memory.per_revolution
        or counts_otherwise
    )
