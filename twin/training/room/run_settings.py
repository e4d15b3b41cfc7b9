"""What the interpreter knows about the machine as it is, for a start and for the path before one."""

import dataclasses

from twin.nc.control.settings import ControlSettings, ToolData
from twin.training.program.preview import PathToCome
from twin.training.room.observed import Observed


def run_settings(room: Observed) -> ControlSettings:
    """What the interpreter must know of the machine as it is."""
    tables = room.setup.tables
    names = room.machine.machine.axes.names
    zero = tables.program_zero
    reference = tables.tool.length
    # The panel's control takes the length of the tool in the spindle from its table by itself.
    tools = {
        number: ToolData(radius=tables.radii[number], length=reference)
        for number in sorted(tables.tools, key=lambda number: number != tables.spindle)
    }
    start = room.machine.setpoint.position[0] - zero
    settings = room.scene.preparation.settings
    return dataclasses.replace(
        settings,
        start=dict(zip(names, map(float, start), strict=True)),
        tools=tools,
        machine_zero=dict(zip(names, map(float, -zero), strict=True)),
        # A copy: a run that is made again begins with the table as it was.
        offsets={name: dict(values) for name, values in tables.offsets.items()},
        block_skip=settings.block_skip or room.panel.block_skip,
    )


def path_to_come(room: Observed) -> PathToCome:
    """What a start of the program would begin with; nothing of it changes with the room."""
    tables = room.setup.tables
    return PathToCome(
        source=room.program.source,
        dialect=room.scene.preparation.dialect,
        settings=run_settings(room),
        machine=room.machine.machine,
        search=room.program.searched,
        stand=room.machine.setpoint.position[0].copy(),
        zero=tables.zero.copy(),
        length_difference=tables.longer_by_table(),
        tool=tables.spindle,
        spindle=room.auxiliaries.spindle,
        frame=room.setup.part_frame,
    )
