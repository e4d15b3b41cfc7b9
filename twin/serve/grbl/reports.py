"""What Grbl reports: its status line, parser state and parameters, as version 1.1 writes them."""

import math
from collections.abc import Sequence
from typing import NamedTuple

from twin.nc.control.modal import Modal
from twin.nc.dialects.grbl.memory import SYSTEMS, GrblMemory
from twin.nc.functions import SpindleState
from twin.serve.grbl.serial_buffer import BUFFER_SIZE
from twin.serve.grbl.settings import IN_INCHES, REPORT, GrblSettings
from twin.serve.grbl.stream import MOST_AHEAD
from twin.training.room.room import Room
from twin.units import SECONDS_PER_MINUTE

WELCOME = "\r\nGrbl 1.1h ['$' for help]"
BUILD = ("[VER:1.1h.20190825:mill-twin]", f"[OPT:VML,{MOST_AHEAD},{BUFFER_SIZE}]")
"""V: variable spindle, M: mist, L: no lock when it is switched on, since the twin knows where it is."""
HELP = "[HLP:$$ $# $G $I $N $x=val $Nx=line $J=line $SLP $C $X $H ~ ! ? ctrl-x]"
_INCH = 25.4
_OFFSET_EVERY, _OVERRIDES_EVERY = 30, 20
"""Reports between two that hold the work offset, or the overrides, though they have not changed."""
_GROUPS = ("motion", "offset", "plane", "units", "distance", "feed")


class ParserState(NamedTuple):
    """What is in force.

    Attributes:
        feed: As programmed; 0: none.
        speed: As programmed [1/min].
        memory: Coordinate systems.
    """

    modal: Modal
    feed: float
    speed: float
    memory: GrblMemory


def parser_state(state: ParserState, spindle: SpindleState, *, coolant: bool) -> str:
    """The answer to $G."""
    codes = [f"G{state.modal.active.get(group):g}" for group in _GROUPS]
    turning = "M5" if not spindle.started else "M4" if spindle.counter_clockwise else "M3"
    coolants = "M8" if coolant else "M9"
    words = [turning, coolants, "T0", f"F{state.feed:g}", f"S{state.speed:g}"]
    return f"[GC:{' '.join([*codes, *words])}]"


class ReportWriter:
    """Writes reports of one control."""

    def __init__(self, settings: GrblSettings) -> None:
        self.settings = settings
        self._offset: list[float] = []
        self._overrides: tuple[int, ...] = ()
        self._since_offset = self._since_overrides = 0

    def refresh(self) -> None:
        """The next reports hold offset and overrides, as behind a reset."""
        self._offset, self._overrides = [], ()

    def parameters(self, room: Room, memory: GrblMemory) -> list[str]:
        """The answer to $#; coordinate systems that nobody gave are at machine zero, as in Grbl."""
        zero = room.setup.tables.program_zero
        lines = []
        for number, name in enumerate(SYSTEMS, 1):
            system = memory.systems.get(number)
            place = [0.0] * 3 if system is None else [system[i] + zero[i] for i in range(3)]
            lines.append(f"[{name}:{self._lengths(place)}]")
        lines += [
            f"[G28:{self._lengths(memory.homes[0])}]",
            f"[G30:{self._lengths(memory.homes[1])}]",
        ]
        lines += [
            f"[G92:{self._lengths(memory.preset)}]",
            f"[TLO:{self._lengths([memory.length])}]",
        ]
        return [*lines, f"[PRB:{self._lengths([0.0] * 3)}:0]"]

    def status(self, state: str, room: Room, memory: GrblMemory, free: tuple[int, int]) -> str:
        """The answer to ``?``.

        Args:
            state: Of the machine, such as ``Run``.
            memory: Coordinate systems of its control.
            free: Blocks and bytes that there is room for.
        """
        mask = int(self.settings.values[REPORT])
        place = [float(value) for value in room.machine.position[:3]]
        offset = work_offset(room, memory)
        fields = [state]
        if mask & 1:
            fields.append(f"MPos:{self._lengths(place)}")
        else:
            work = [a - b for a, b in zip(place, offset, strict=True)]
            fields.append(f"WPos:{self._lengths(work)}")
        if mask & 2:
            fields.append(f"Bf:{free[0]},{free[1]}")
        feed = math.hypot(*room.machine.velocity[:3]) * SECONDS_PER_MINUTE / self._unit
        fields.append(f"FS:{feed:.0f},{abs(room.auxiliaries.spindle.turning or 0.0):.0f}")
        pins = "".join(axis for axis in "XYZ" if room.machine.on_limit_switch == axis)
        if pins:
            fields.append(f"Pn:{pins}")
        fields += self._now_and_then(room, offset)
        return f"<{'|'.join(fields)}>"

    def _now_and_then(self, room: Room, offset: list[float]) -> list[str]:
        """Work offset or overrides: when they have changed, and every so often."""
        self._since_offset += 1
        self._since_overrides += 1
        if offset != self._offset or self._since_offset >= _OFFSET_EVERY:
            self._offset, self._since_offset = offset, 0
            return [f"WCO:{self._lengths(offset)}"]
        overrides = (
            room.panel.feed_override,
            room.panel.rapid_override,
            room.panel.spindle_override,
        )
        if overrides == self._overrides and self._since_overrides < _OVERRIDES_EVERY:
            return []
        self._overrides, self._since_overrides = overrides, 0
        fields = [f"Ov:{','.join(map(str, overrides))}"]
        turning = (
            ""
            if not room.auxiliaries.spindle.turns
            else "C"
            if room.auxiliaries.spindle.counter_clockwise
            else "S"
        )
        accessories = turning + ("F" if room.auxiliaries.coolant else "")
        return [*fields, f"A:{accessories}"] if accessories else fields

    @property
    def _unit(self) -> float:
        return _INCH if self.settings.values[IN_INCHES] else 1.0

    def _lengths(self, values: Sequence[float]) -> str:
        digits = 4 if self.settings.values[IN_INCHES] else 3
        return ",".join(
            f"{round(value / self._unit, digits) + 0.0:.{digits}f}" for value in values[:3]
        )


def work_offset(room: Room, memory: GrblMemory) -> list[float]:
    """Machine coordinates of the programmed zero, X, Y and Z [mm]."""
    zero, system = room.setup.tables.program_zero, memory.systems[memory.system]
    offset = [float(zero[axis]) + system[axis] + memory.preset[axis] for axis in range(3)]
    offset[2] += memory.length
    return offset
