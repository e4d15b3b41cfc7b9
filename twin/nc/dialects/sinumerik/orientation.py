"""TRAORI, which leads the tip of the tool, and CYCLE800, which swivels the plane.

Sources: programming manuals "Job planning" (transformations) and "Measuring cycles, milling" (CYCLE800). In force are
the machine's own rotary axes as they are programmed, or a vector (A3=, B3=, C3=) for which they are computed.
"""

import enum

from twin.nc.control.codes import Action
from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik.frames import put_programmable
from twin.nc.dialects.sinumerik.memory import memory_of
from twin.nc.dialects.sinumerik.variables.expressions import bracketed, split_values
from twin.nc.geometry.arcs import direction
from twin.nc.geometry.frame import chained
from twin.nc.geometry.matrices import IDENTITY, Matrix, product
from twin.nc.geometry.planes import Vector
from twin.nc.iso.machine_coordinates import machine_frame
from twin.nc.iso.orientation.tilted_plane import (
    about,
    directions_of,
    plane_of_axes,
    point_tool,
    refuse_leaning,
)
from twin.nc.iso.orientation.tool_center import begin_tool_center, end_tool_center, point_by_words
from twin.nc.text.blocks import Statement

_RETRACT, _STATUS, _MODE, _ORIGIN, _ANGLES, _SHIFT, _DIRECTION = (
    0, 2, 3, slice(4, 7), slice(7, 10), slice(10, 13), 13,
)  # fmt: skip
"""Places of CYCLE800's parameters: _FR, _ST, _MODE, _X0 to _Z0, _A to _C, _X1 to _Z1, _DIR."""


class _Turn(enum.IntEnum):
    """Bits 6 and 7 of _MODE: what the angles are."""

    BY_AXES = 0
    """About axes one after the other."""
    BY_SOLID_ANGLES = 1
    """About Z and the new Y."""
    BY_PROJECTION = 2
    """Of the plane's traces."""
    DIRECTLY = 3
    """Of the machine's rotary axes themselves."""


_UPRIGHT = 90.0
"""Projection angles lie below it [deg]."""
_VECTOR = ("A3", "B3", "C3")

_FRAME, _TURN = "orientation frame", "orientation"
INTERPOLATIONS = {
    "ORIWKS": (
        "A3= B3= C3= count in the frame, and are reached in the plane of both directions",
        _FRAME,
    ),
    "ORIMKS": ("A3= B3= C3= count without frames, and the rotary axes go to them evenly", _FRAME),
    "ORIVECT": ("A3= B3= C3= are reached in the plane of both directions (a great circle)", _TURN),
    "ORIPLANE": ("as ORIVECT", _TURN),
    "ORIAXES": ("the rotary axes go evenly to A3= B3= C3=", _TURN),
}
"""What codes of orientation say, and the group of each."""


def begin_transformation(control: Control, statement: Statement) -> None:
    """TRAORI, TRAORI(1): the tip is led; F counts its path."""
    inner = statement.text.strip().strip("()").strip()
    if inner not in ("", "1"):
        message = f"the machine has one transformation of orientation, TRAORI, not TRAORI({inner})"
        control.fail("tool-center", message, statement)
    begin_tool_center(control, "TRAORI")


def end_transformation(control: Control) -> None:
    """TRAFOOF: positions are those of the axes; the length of the tool acts along Z."""
    end_tool_center(control, "TRAFOOF", keeps_length=True)


def swivel(control: Control, statement: Statement) -> None:
    """CYCLE800: the plane is turned about a point, and the rotary axes set the tool across it; () ends it.

    Decisions: _FR retracts Z to machine zero before; _DIR is the sign of the axis next to the tool, and where it
    is 0 only the frame turns, so that nothing moves until the tool stands across it.
    """
    inner, column, _ = bracketed(control, statement.text, statement.text_column)
    values = [
        control.compute(control.statements.expression(text, column + at), column + at)
        if text.strip() and not text.strip().startswith('"')
        else 0.0
        for text, at in split_values(inner)
    ]
    values += [0.0] * (_DIRECTION + 1 - len(values))
    memory = memory_of(control)
    end_tool_center(control, "CYCLE800", keeps_length=True)
    if not any(values[_ORIGIN] + values[_ANGLES] + values[_SHIFT]):
        memory.swivel = None
        put_programmable(control, memory.matrix, memory.translation)
        if not inner.strip():
            return
    if control.settings.setup is None and any(values[_ANGLES]):
        message = "CYCLE800 swivels the plane, and no axis of this machine turns"
        control.fail("tilted-plane", message, statement)
    if values[_RETRACT]:
        _retract(control)
    matrix = _matrix(control, statement, int(values[_MODE]), values[_ANGLES])
    before: tuple[Matrix, Vector] = (IDENTITY, (0.0, 0.0, 0.0))
    if int(values[_STATUS]) % 10 == 1 and memory.swivel is not None:
        before = memory.swivel
    turned = chained(before, (matrix, _vector(values[_ORIGIN])))
    memory.swivel = chained(turned, (IDENTITY, _vector(values[_SHIFT])))
    put_programmable(control, memory.matrix, memory.translation)
    if values[_DIRECTION] and control.settings.setup is not None:
        point_tool(control, "CYCLE800", sense=values[_DIRECTION], at=statement)


def require_orientation(control: Control) -> None:
    """In a swivelled plane X, Y and Z move when the tool stands across it."""
    swivelled = memory_of(control).swivel
    if swivelled and swivelled[0] != IDENTITY:
        refuse_leaning(control, "CYCLE800 with _DIR -1 or 1, or TRAORI")


def _retract(control: Control) -> None:
    with machine_frame(control, "the retraction of CYCLE800"):
        there = list(control.motion.programmed)
        if there[2] < 0.0:
            there[2] = 0.0
            control.line_to(there, rapid=True)


def _matrix(control: Control, statement: Statement, mode: int, angles: list[float]) -> Matrix:
    """The turn that the angles say; its columns are the directions of the swivelled axes."""
    axes = [(mode >> 2 * place & 3) - 1 for place in range(3)]
    kind = mode >> 6 if any(angles) else _Turn.BY_AXES
    if kind == _Turn.BY_SOLID_ANGLES:
        return product(about(2, angles[0]), about(1, angles[1]))
    if kind == _Turn.BY_PROJECTION:
        return _by_projection(control, statement, axes, angles)
    if kind == _Turn.DIRECTLY:
        return _directly(control, statement, angles)
    matrix = IDENTITY
    for axis, angle in zip(axes, angles, strict=True):
        if axis >= 0 and angle:
            # Bits 0 and 1 name the first axis; each turns about where those before it have left it.
            matrix = product(matrix, about(axis, angle))
    return matrix


def _by_projection(
    control: Control, statement: Statement, axes: list[int], angles: list[float]
) -> Matrix:
    """The plane whose traces in Y/Z and Z/X lie at angles; its X lies in Z/X, and the third angle turns it (manual)."""
    if sorted(axes[:2]) != [0, 1] or max(abs(angle) for angle in angles[:2]) >= _UPRIGHT:
        message = (
            "CYCLE800 by projection angles is simulated about X and Y, below 90, and the new Z"
        )
        control.fail("tilted-plane", message, statement, "_MODE 185 or 182")
    (level, rise), (ahead, fall) = (direction(angles[axes.index(axis)]) for axis in (0, 1))
    return product(directions_of((ahead, 0.0, -fall), (0.0, level, rise)), about(2, angles[2]))


def _directly(control: Control, statement: Statement, angles: list[float]) -> Matrix:
    """The plane across the tool while the first and the second rotary axis, from the tool on, stand at angles."""
    setup = control.settings.setup
    if setup is None:
        control.fail(
            "tilted-plane", "CYCLE800 turns axes, and none of this machine does", statement
        )
    columns = setup.chain.column[setup.chain.rotary].tolist()
    return plane_of_axes(control, dict(zip(columns, angles, strict=False)))


def interpolate(name: str) -> Action:
    """ORIVECT, ORIPLANE, ORIAXES; ORIWKS, ORIMKS: how a vector is reached, and what it counts in.

    Decision: ORIAXES, ORIVECT and ORIPLANE say how as soon as the program has one of them, as with machine data 21104 at 1;
    before, ORIWKS and ORIMKS do, as it comes from its maker.
    """

    def action(control: Control) -> None:
        memory = memory_of(control)
        if name in ("ORIWKS", "ORIMKS"):
            memory.machine_vectors = name == "ORIMKS"
        else:
            memory.vector_turns = name != "ORIAXES"

    return action


def point_by_vector(control: Control) -> None:
    """A3=, B3= and C3= of a block: the direction of the tool, from its tip to the spindle, in the part.

    It turns in the plane of both directions, or the rotary axes go evenly; these do, too, to their own words (manual: rotary
    axis interpolation). With ORIMKS no frame turns the vector.
    """
    words = [control.take(name) for name in _VECTOR]
    first = next((word for word in words if word is not None), None)
    control.motion.in_plane = False
    if first is None:
        return
    if control.path.tool_center is None:
        message = "a direction of the tool needs TRAORI"
        control.fail("tool-center", message, first, "write TRAORI before, or the rotary axes")
    memory = memory_of(control)
    x, y, z = (control.number(word) for word in words)
    point_by_words(control, (x, y, z), first, in_frame=not memory.machine_vectors)
    turns = memory.vector_turns
    control.motion.in_plane = not memory.machine_vectors if turns is None else turns


def _vector(values: list[float]) -> Vector:
    x, y, z = values
    return (x, y, z)
