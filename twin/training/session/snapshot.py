"""What a panel needs to know of the running machine, as plain data that nobody can change."""

import dataclasses

import numpy as np

from twin.nc.canonical import FloatArray
from twin.nc.functions import SpindleState
from twin.training.scene.fault_table import FaultTable
from twin.training.scene.scene_file import Mode
from twin.training.session.block_walk import ModalState
from twin.training.session.judge import Verdict
from twin.training.session.live_cut import Loads
from twin.training.session.observed import Notice
from twin.training.session.room import Room
from twin.units import SECONDS_PER_MINUTE

Row = tuple[float, ...]

_STILL = 1e-3
"""Speed below which the feed is that of the table [mm/s]."""


@dataclasses.dataclass(frozen=True, slots=True)
class ToolRow:
    """A row of the tool table: number, kind, diameter; length and radius in the table [mm]."""

    number: int
    kind: str
    diameter: float
    length: float
    radius: float


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Snapshot:
    """The machine at an instant; rows have one value per axis [mm or deg]."""

    time_s: float
    axes: tuple[str, ...]
    units: tuple[str, ...]
    mode: Mode
    running: str
    """``program``, ``mdi``, ``jog`` or nothing."""
    held: bool
    moving: bool
    alarm: Notice | None
    broken: Notice | None
    """What was said of the tool in the spindle when it lost its edge."""
    loads: Loads
    pressed: bool
    position: Row
    """As the control's screen shows it."""
    machine_position: Row
    distance_to_go: Row
    following_error: Row
    load: Row
    """Share of the drive's force limit, 0 to 1."""
    feed: float
    """Of the tool's tip against the machine [mm/min]; of the table where nothing else moves
    [deg/min]."""
    modal: ModalState | None
    feed_override: int
    rapid_override: int
    spindle: SpindleState
    spindle_turning: float | None
    """Speed that it is told, negative counter-clockwise, 0 at a stand; None: not known [1/min]."""
    spindle_override: int
    counter_clockwise: bool
    coolant: bool
    optional_stop: bool
    block_skip: bool
    dry_run: bool
    searched: int
    """Line at which the next start begins, 0 for the first."""
    suspended: bool
    """A program is held, and the axes can be jogged."""
    changed: bool
    """The program has been changed."""
    alarms: tuple[Notice, ...]
    """Those that came, the newest last."""
    offsets: tuple[tuple[str, Row], ...]
    """Work offsets by name."""
    program: tuple[str, ...]
    line: int
    """Source line that runs, 0 for none."""
    entered: str
    tool: int
    tools: tuple[ToolRow, ...]
    zero: Row
    origin: Row
    """Where the control's program zero is, seen from the part, X Y Z [mm]."""
    touches: bool
    """The feeler lamp."""
    verdicts: tuple[Verdict, ...]
    answers: tuple[tuple[int, str], ...]
    hints: int
    score: int
    over: bool
    faults: tuple[FaultTable, ...]
    trail: Row
    """Where the tip is, seen from the part, X Y Z [mm]."""
    frozen: bool = False
    replaying: bool = False
    refusal: str = ""
    """Why the last command was refused."""
    refusals: int = 0
    """How many have been refused: what a page has sent in vain it takes back."""
    signature: str = ""
    """Who is at the panel."""
    speed: float = 1.0
    """Machine time per time on the wall, as it has been of late."""


def take_snapshot(room: Room) -> Snapshot:
    """Look at a room."""
    machine = room.machine.machine
    now = room.samples[-1:]
    setpoint = now.setpoint
    position = now.joint_position[0]
    zero = room.tables.program_zero
    to_go, modal = _from_run(room, zero)
    limits = np.array([machine.axis(name).force_limit or np.inf for name in machine.axes.names])
    tip = room.part_frame.position((position - room.tables.longer)[None])[0]
    return Snapshot(
        time_s=room.time_s,
        axes=machine.axes.names,
        units=tuple("mm" if kind == "linear" else "deg" for kind in machine.axes.kinds),
        mode=room.mode,
        running=room.running,
        held=room.held,
        moving=room.moving,
        alarm=room.alarm,
        broken=room.broken.get(room.tables.spindle),
        loads=room.cut.loads(room.samples.tool),
        pressed=room.pressed,
        position=_row(position - zero + room.label),
        machine_position=_row(position),
        distance_to_go=_row(to_go),
        following_error=_row(setpoint.position[0] - position),
        load=_row(np.abs(now.drive_force[0]) / limits),
        feed=_feed(now.joint_velocity[0]),
        modal=modal,
        feed_override=room.feed_override,
        rapid_override=room.rapid_override,
        spindle=room.spindle,
        spindle_turning=room.spindle.turning,
        spindle_override=room.spindle_override,
        counter_clockwise=room.spindle.counter_clockwise,
        coolant=room.coolant,
        optional_stop=room.switches.optional_stop,
        block_skip=room.switches.block_skip,
        dry_run=room.switches.dry_run,
        searched=room.searched,
        suspended=room.suspended is not None,
        changed=bool(room.edits),
        alarms=tuple(room.alarms),
        offsets=tuple(
            (name, tuple(float(values.get(axis, 0.0)) for axis in machine.axes.names))
            for name, values in room.tables.offsets.items()
        ),
        program=room.lines,
        line=room.line,
        entered=room.entered,
        tool=room.tables.spindle,
        tools=tuple(
            ToolRow(
                number,
                tool.kind,
                tool.diameter,
                room.tables.lengths[number],
                room.tables.radii[number],
            )
            for number, tool in room.tables.tools.items()
        ),
        zero=_row(room.tables.zero),
        origin=_row(room.part_frame.position(zero[None])[0]),
        touches=room.touches,
        verdicts=tuple(room.judge.verdicts),
        answers=tuple(room.judge.evidence.answers.items()),
        hints=room.judge.hints,
        score=room.judge.score,
        over=room.judge.over,
        faults=tuple(room.faults),
        trail=_row(tip),
    )


def _from_run(room: Room, zero: FloatArray) -> tuple[FloatArray, ModalState | None]:
    """Distance to go, and what is in force."""
    if room.run is None:
        return np.zeros(len(zero)), room.modal
    setpoint = room.machine.setpoint
    move = int(setpoint.move[0])
    target = room.run.target(move)
    to_go = np.zeros(len(zero)) if target is None else target[0] + zero - setpoint.position[0]
    # A jog has codes of its own, which are nobody's business.
    return to_go, room.modal if room.running == "jog" else room.run.modal(move)


def _feed(velocity: FloatArray) -> float:
    linear = float(np.linalg.norm(velocity[:3]))
    turning = float(np.abs(velocity[3:]).max(initial=0.0))
    return SECONDS_PER_MINUTE * (linear if linear > _STILL or not turning else turning)


def _row(values: FloatArray) -> Row:
    return tuple(float(value) for value in values)
