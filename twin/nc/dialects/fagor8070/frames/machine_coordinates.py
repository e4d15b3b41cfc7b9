"""#MCS of the Fagor CNC 8070: moves that count from machine zero.

``#MCS G0 Z0`` moves once, ``#MCS ON`` until ``#MCS OFF``. The coordinates are those of the axes: no
work offset, preset, tool length, mirror, scale or rotation acts on them. Decisions: compensation
must have ended, polar coordinates are refused (E1305), and what changes the frame must wait for
#MCS OFF.
"""

from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.memory import memory_of
from twin.nc.dialects.fagor8070.polar import forget_polar
from twin.nc.iso.machine_coordinates import enter_machine_frame, leave_machine_frame
from twin.nc.text.blocks import Statement


def refuse_change(control: Control) -> None:
    """A change of the frame while machine coordinates are in force."""
    if memory_of(control).part_frame is not None:
        message = "offsets, tool and transformations cannot change while #MCS is in force"
        control.fail("machine-coordinates", message, hint="end it by #MCS OFF first")


def refuse_offset_change(control: Control) -> None:
    """A change of work offset or preset while machine coordinates, #CS or #ACS are in force.

    Raises:
        ProgramError: They are.
    """
    refuse_change(control)
    if memory_of(control).is_tilted:
        message = "offsets do not change while a coordinate system is in force"
        control.fail("tilted-plane", message, hint="#CS OFF ALL and #ACS OFF ALL before")


def machine_coordinates(control: Control, statement: Statement) -> None:
    """#MCS ON, #MCS OFF, or #MCS and the words of a move."""
    text = statement.text.strip().upper()
    if text == "ON":
        _enter(control, statement)
    elif text == "OFF":
        if memory_of(control).part_frame is not None:
            _leave(control)
    else:
        _move_once(control, statement)


def _move_once(control: Control, statement: Statement) -> None:
    block, blocks = (
        control.block,
        control.statements.blocks(statement.text, statement.text_column, control.block.line),
    )
    if len(blocks) != 1 or blocks[0].statement is not None:
        hint = "write #MCS G0 Z0, or #MCS ON and #MCS OFF in blocks of their own"
        control.fail("machine-coordinates", "#MCS needs the words of a move", statement, hint)
    lasting = memory_of(control).part_frame is not None
    if not lasting:
        _enter(control, statement)
    control.run(blocks[0]._replace(number=block.number))
    if not lasting:
        _leave(control)


def _enter(control: Control, statement: Statement) -> None:
    memory = memory_of(control)
    if memory.part_frame is not None:
        return
    if control.path.compensation.in_force:
        message = "machine coordinates know no radius compensation"
        hint = "end it by G40 before #MCS"
        control.fail("compensation-change", message, statement, hint)
    memory.part_frame = enter_machine_frame(control, "#MCS")
    forget_polar(control)


def _leave(control: Control) -> None:
    memory = memory_of(control)
    assert memory.part_frame is not None
    leave_machine_frame(control, memory.part_frame)
    memory.part_frame = None
    forget_polar(control)
