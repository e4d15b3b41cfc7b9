"""G codes as the tables of dialects declare them, a line each: by the manual of their control."""

from collections.abc import Mapping
from typing import Unpack

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import Assembler
from twin.nc.bytecode.registers import ROTATION
from twin.nc.control.codes import Action, CodeWriter, GCode, Ground, Interpolation, MCode
from twin.nc.control.control import Control
from twin.nc.control.modal import ModalChanges
from twin.nc.geometry.planes import PLANE_ORDER, Plane
from twin.nc.iso.findings import PLANE_COMPENSATED, PLANE_ROTATED


def modal(
    meaning: str,
    group: str = "",
    action: Action | None = None,
    *,
    compiler: CodeWriter | None = None,
    once: bool = False,
    ground: Ground = "manual",
    **sets: Unpack[ModalChanges],
) -> GCode:
    """A code that puts something into force, or does something before the block moves."""
    return GCode(
        meaning=meaning,
        group=group,
        sets=sets,
        action=action,
        compiler=compiler,
        once=once,
        ground=ground,
    )


def instead(
    meaning: str, perform: Action, group: str = "", *, takes: str = "", ground: Ground = "manual"
) -> GCode:
    """A code that stands in the place of a move."""
    return GCode(meaning=meaning, group=group, perform=perform, takes=takes, ground=ground)


def motion_code(meaning: str, interpolation: Interpolation, ground: Ground = "manual") -> GCode:
    """A code by which axis words become a move; it ends a cycle."""
    return modal(meaning, "motion", ground=ground, interpolation=interpolation, cycle=None)


def plane_code(
    meaning: str, plane: Plane, action: Action | None = None, ground: Ground = "manual"
) -> GCode:
    """A code of a working plane; ``action``: what the interpreter tier does in its place."""

    def write(_control: Control, assembler: Assembler) -> None:
        write_plane(PLANE_ORDER.index(plane), assembler)

    def choose(control: Control) -> None:
        if not control.path.compensates_in(control.part_plane()):  # else it is in force already
            control.perform(lambda assembler: write(control, assembler))

    return modal(meaning, "plane", action or choose, compiler=write, ground=ground, plane=plane)


def write_plane(number: int, assembler: Assembler) -> None:
    """The plane with a number of ``planes.PLANE_ORDER`` becomes active."""
    assembler.check(opcodes.UNCOMPENSATED, PLANE_COMPENSATED)
    assembler.register(ROTATION)
    assembler.check(opcodes.ABSENT, PLANE_ROTATED)
    assembler.drop()
    assembler.emit(opcodes.PLANE, number)


def refused(meaning: str, reason: str, *numbers: float, group: str = "") -> Mapping[float, GCode]:
    """Codes that the control knows and the twin does not follow."""
    code = GCode(meaning=meaning, group=group, refused=reason, ground="manual")
    return dict.fromkeys(numbers, code)


def flow_function(meaning: str, action: Action, group: str = "") -> MCode:
    """An M code of the program's flow: it acts when the block has moved, and the machine hears nothing of it."""
    return MCode(
        meaning=meaning, group=group, late=True, action=action, silent=True, ground="manual"
    )


def go_back(assembler: Assembler) -> None:
    """The end of a subprogram: back behind its call."""
    assembler.check_return()
    assembler.end_call()
