"""What a panel needs to know of the running machine, as plain data that nobody can change."""

import dataclasses

import numpy as np

from twin.nc.canonical import FloatArray
from twin.nc.functions import SpindleState
from twin.training.program.block_tracker import ModalState
from twin.training.room.judging.judge import TaskState
from twin.training.room.observed import RoomAlarm
from twin.training.room.room import Room
from twin.training.room.setup.live_cut import SliceLoads
from twin.training.scene.scene_file import FaultTable, Mode
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
    alarm: RoomAlarm | None
    broken: RoomAlarm | None
    """What was said of the tool in the spindle when it lost its edge."""
    loads: SliceLoads
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
    """Commanded speed, negative counter-clockwise, 0 at a standstill; None: not known [1/min]."""
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
    alarms: tuple[RoomAlarm, ...]
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
    finder: Row
    """How far the edge finder's tip is pushed aside, seen from the part, X and Y [mm]; empty: there is no sound one in
    the spindle."""
    verdicts: tuple[TaskState, ...]
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
    """Machine time per wall-clock time, of the last seconds."""


def take_snapshot(room: Room) -> Snapshot:
    """Look at a room."""
    machine = room.machine.machine
    now = room.samples[-1:]
    setpoint = now.setpoint
    position = now.joint_position[0]
    zero = room.setup.tables.program_zero
    to_go, modal = _from_run(room, zero)
    limits = np.array([machine.axis(name).force_limit or np.inf for name in machine.axes.names])
    tip = room.setup.part_frame.position((position - room.setup.tables.length_difference)[None])[0]
    return Snapshot(
        time_s=room.time_s,
        axes=machine.axes.names,
        units=tuple("mm" if kind == "linear" else "deg" for kind in machine.axes.kinds),
        mode=room.panel.mode,
        running=room.slot.running,
        held=room.slot.held,
        moving=room.machine.moving,
        alarm=room.alarm,
        broken=room.alarms.broken.get(room.setup.tables.spindle),
        loads=room.setup.cut.loads(room.samples.tool),
        pressed=room.panel.stop_pressed,
        position=_row(position - zero + room.slot.label),
        machine_position=_row(position),
        distance_to_go=_row(to_go),
        following_error=_row(setpoint.position[0] - position),
        load=_row(np.abs(now.drive_force[0]) / limits),
        feed=_feed(now.joint_velocity[0]),
        modal=modal,
        feed_override=room.panel.feed_override,
        rapid_override=room.panel.rapid_override,
        spindle=room.auxiliaries.spindle,
        spindle_turning=room.auxiliaries.spindle.turning,
        spindle_override=room.panel.spindle_override,
        counter_clockwise=room.auxiliaries.spindle.counter_clockwise,
        coolant=room.auxiliaries.coolant,
        optional_stop=room.panel.optional_stop,
        block_skip=room.panel.block_skip,
        dry_run=room.panel.dry_run,
        searched=room.program.searched,
        suspended=room.slot.suspended is not None,
        changed=bool(room.program.edits),
        alarms=tuple(room.alarms.history),
        offsets=tuple(
            (name, tuple(float(values.get(axis, 0.0)) for axis in machine.axes.names))
            for name, values in room.setup.tables.offsets.items()
        ),
        program=room.program.lines,
        line=room.line,
        entered=room.panel.entered,
        tool=room.setup.tables.spindle,
        tools=tuple(
            ToolRow(
                number,
                "edge_finder" if number == room.setup.tables.finder else tool.kind,
                tool.diameter,
                room.setup.tables.lengths[number],
                room.setup.tables.radii[number],
            )
            for number, tool in room.setup.tables.tools.items()
        ),
        zero=_row(room.setup.tables.zero),
        origin=_row(room.setup.part_frame.position(zero[None])[0]),
        touches=room.setup.touches(room.auxiliaries.spindle),
        finder=_finder(room),
        verdicts=tuple(room.judge.verdicts),
        answers=tuple(room.judge.evidence.answers.items()),
        hints=room.judge.hints,
        score=room.judge.score,
        over=room.judge.over,
        faults=tuple(room.faults.active),
        trail=_row(tip),
    )


def _finder(room: Room) -> Row:
    finder = room.setup.sound_finder
    return () if finder is None else tuple(round(value, 2) for value in finder.deflection)


def _from_run(room: Room, zero: FloatArray) -> tuple[FloatArray, ModalState | None]:
    """Distance to go, and what is in force."""
    if room.slot.run is None:
        return np.zeros(len(zero)), room.slot.modal
    setpoint = room.machine.setpoint
    move = int(setpoint.move[0])
    target = room.slot.run.reader.moves.target(move)
    to_go = np.zeros(len(zero)) if target is None else target[0] + zero - setpoint.position[0]
    # A jog has codes of its own, which are nobody's business.
    return to_go, room.slot.modal if room.slot.running == "jog" else room.slot.run.modal(move)


def _feed(velocity: FloatArray) -> float:
    linear = float(np.linalg.norm(velocity[:3]))
    turning = float(np.abs(velocity[3:]).max(initial=0.0))
    return SECONDS_PER_MINUTE * (linear if linear > _STILL or not turning else turning)


def _row(values: FloatArray) -> Row:
    return tuple(float(value) for value in values)
