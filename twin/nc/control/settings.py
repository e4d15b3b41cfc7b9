"""What the interpreter must be given about the machine and the job, without knowing either."""

import dataclasses
import re
from collections.abc import Callable, Iterator, Mapping
from typing import Literal, TypeVar

from twin.nc.canonical import Axes
from twin.nc.path.tool_center.tool_center import PartOnMachine
from twin.nc.text.blocks import Block

V = TypeVar("V")

_WORK_OFFSET = re.compile(
    r"G5[4-9](\.[123])?|G5(0[5-9]|[1-9]\d)|G(54\.1|154) P[1-9]\d*|G159=[1-9]\d*|(PRESET|DATUM)\d+|M92"
)


def is_work_offset(name: str) -> bool:
    """Whether some control calls a work offset so: a job may list some that one of its programs does not call."""
    return _WORK_OFFSET.fullmatch(name) is not None


class Consulted(Mapping[str, V]):
    """Values by name that record which of them were read."""

    def __init__(self, values: Mapping[str, V]) -> None:
        self._values = dict(values)
        self.unread = set(self._values)

    def __getitem__(self, name: str) -> V:
        value = self._values[name]
        self.unread.discard(name)
        return value

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)


@dataclasses.dataclass(frozen=True, slots=True)
class ToolData:
    """What the control's tool table knows of a tool.

    Attributes:
        radius: Of its cutting edge [mm].
        length: From the spindle nose to its tip [mm].
        name: By which a program may call it; empty: by its number alone.
    """

    radius: float
    length: float
    name: str = ""


@dataclasses.dataclass(frozen=True, slots=True)
class MachineFunction:
    """An M code that the machine's builder has made.

    Attributes:
        dwell: How long the program waits for it [s].
    """

    meaning: str
    dwell: float = 0.0


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ControlSettings:
    """The control's configuration for one run of a program."""

    axes: Axes
    """The axes that the machine has."""

    periodic: frozenset[str] = frozenset()
    """Names of the rotary axes that are declared periodic."""

    default_feed: float = 1000.0
    """Feed of a program that sets none [mm/min]."""

    default_rotary_feed: float = 3600.0
    """Feed of moves of rotary axes alone in a program that sets none [deg/min]."""

    start: Mapping[str, float] = dataclasses.field(default_factory=dict)
    """Where the axes are when the program starts, part coordinates [mm or deg]; missing is 0."""

    recalculate_on_rapid: bool = False
    """``gost``: G102 also relabels the start of G0 blocks (dialects.md: decision, default off)."""

    tools: Mapping[int, ToolData] = dataclasses.field(default_factory=dict)
    """The tool table by tool number; the first is in the spindle when the program starts."""

    tool_of_call: Callable[[str, int], ToolData | None] | None = None
    """What a tool that the job does not name measures, by its name and the line that calls it first; None: nobody knows."""

    any_tool: bool = False
    """Nobody gave a tool table: every number means the first tool."""

    offsets: Mapping[str, Mapping[str, float]] = dataclasses.field(default_factory=dict)
    """Work offsets by name (``G54``), each by axis, from part zero [mm or deg]."""

    setup: PartOnMachine | None = None
    """The part on the machine, for tool centre point control and tilted planes; None: not known."""

    offset_rows: Mapping[int, int] = dataclasses.field(default_factory=dict)
    """``fanuc``, ``haas``: rows of the offset memory, by H and D, that hold the data of a tool of another number."""

    machine_zero: Mapping[str, float] | None = None
    """Part coordinates of machine zero by axis [mm or deg]; None: not known, G53 is refused."""

    written_zero: Mapping[str, float] | None = None
    """What the program writes into the control's table for the work offset at part zero, by axis [mm or deg]; None: it
    counts from machine zero."""

    variables: Mapping[str, float] = dataclasses.field(default_factory=dict)
    """Values of variables that the program reads but does not set, by their name in it."""

    m_functions: Mapping[int, MachineFunction] = dataclasses.field(default_factory=dict)
    """M codes by number that the machine's builder has made, or made to take time."""

    module_rotary: bool = False
    """``fagor8070``, ``linuxcnc``: the sign of an absolute rotary target is the direction of rotation."""

    rollover: Literal["shorter", "sign"] | None = None
    """``fanuc``: absolute rotary targets are those of a turn, by the shorter path or in the direction of their sign; None: as written."""

    axis_words: Mapping[str, str | None] = dataclasses.field(default_factory=dict)
    """Words of axes that the machine lacks: the axis that each is for, or None where it is left out while it
    stays at 0."""

    helical_feed: Literal["arc", "path"] | None = None
    """``fanuc``: F of a helix counts the arc in its plane, or the path (parameter 1403 #5); None: as the
    control does when it comes from its maker."""

    rotary_diameter: float | None = None
    """``haas``: diameter at which F counts the path of rotary axes (setting 34) [mm]."""

    feed_of_all_axes: bool = False
    """``fagor8070``: F counts rotary axes together with the main axes (FEEDND)."""

    length_returns: Literal["by code", "next block"] = "by code"
    """``fanuc``: when a tool length counts again that G28, G30 or G53 has cancelled (parameter 5001 #6)."""

    tool_change_height: float | None = None
    """Z that the control rises to by itself before a tool changes, machine coordinates [mm]; None: as the control
    does when it comes from its maker."""

    strict: bool = False
    """Turn warnings into errors."""

    block_skip: bool = False
    """Blocks that begin with a slash are left out."""

    block_skip_levels: frozenset[int] = frozenset()
    """Those whose slash has one of these numbers are left out."""

    step_limit: int = 20_000
    """Blocks that may be run again through jumps and loops before a program counts as endless."""

    decimal_point: Literal["calculator", "increments"] | None = None
    """What a number without a point counts: whole units, or least increments (0.001 mm); None: as
    the control does when it comes from its maker."""

    units: Literal["mm", "inch"] | None = None
    """In which units a program begins that names none; None: as the control does when it comes from its maker."""

    @property
    def never_read(self) -> dict[str, list[str]]:
        """Variables, work offsets and their zero that no program has asked for, by the job's table."""
        tables = {
            "variables": self.variables,
            "offsets": self.offsets,
            "written_zero": self.written_zero,
        }
        return {
            name: sorted(table.unread)
            for name, table in tables.items()
            if isinstance(table, Consulted) and table.unread
        }

    def skips(self, block: Block) -> bool:
        """Whether a block is left out."""
        return block.skippable and (self.block_skip or block.skip_level in self.block_skip_levels)
