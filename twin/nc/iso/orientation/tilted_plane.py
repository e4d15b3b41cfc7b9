"""Tilted planes: a frame turned in space, and rotary axes that set the tool across it.

Decision: where the tool stands across the plane, the rotary axes rest; moves count in the plane, the length of
the tool acts along it, and whatever solution of the angles was taken, the cut is the same.
"""

import math

from twin.kinematics import turns_part
from twin.nc.canonical import FloatArray
from twin.nc.control.control import Control
from twin.nc.geometry.arcs import direction
from twin.nc.geometry.matrices import Matrix, applied, transposed
from twin.nc.geometry.planes import Vector, cross
from twin.nc.iso.orientation.tool_center import begin_tool_center, end_tool_center
from twin.nc.path.tool_center.tool_center import ToolCenter
from twin.nc.text.blocks import Statement

_Z: Vector = (0.0, 0.0, 1.0)
_QUARTER = 90.0
_PARALLEL = 1e-9
"""The sine between two directions below which they are one."""
_ACROSS = 1e-4
"""How far a tool that stands across a plane may lean, by what posts round angles to [rad]."""


def about(axis: int, angle: float) -> Matrix:
    """A turn about X, Y or Z, 0 to 2 [deg]."""
    cosine, sine = direction(angle)
    rows = [[0.0, 0.0, 0.0] for _ in range(3)]
    first, second = (axis + 1) % 3, (axis + 2) % 3
    rows[axis][axis] = 1.0
    rows[first][first] = rows[second][second] = cosine
    rows[first][second], rows[second][first] = -sine, sine
    (a, b, c), (d, e, f), (g, h, i) = rows
    return ((a, b, c), (d, e, f), (g, h, i))


def directions_of(abscissa: Vector, ordinate: Vector) -> Matrix:
    """The directions of a plane whose X goes along a vector, and whose Y lies on the side of another one; as columns.

    Raises:
        ValueError: Both lie along one line.
    """
    normal = cross(abscissa, ordinate)
    x, z = math.hypot(*abscissa), math.hypot(*normal)
    if z <= _PARALLEL * x * math.hypot(*ordinate):
        raise ValueError("two directions that differ name a plane")
    along = (abscissa[0] / x, abscissa[1] / x, abscissa[2] / x)
    up = (normal[0] / z, normal[1] / z, normal[2] / z)
    return transposed((along, cross(up, along), up))


def plane_of_axes(control: Control, angles: dict[int, float]) -> Matrix:
    """The directions of the plane that the tool stands across while rotary axes are at angles; as columns.

    Args:
        control: The control, of a machine with rotary axes.
        angles: Programmed, by column [deg]; the other axes are where they are.
    """
    setup, there = control.settings.setup, list(control.motion.part)
    assert setup is not None
    for column, angle in angles.items():
        there[column] = angle + control.frame.total[column]
    return _matrix(ToolCenter(setup, 0.0, control.frame.zero()).tool_frame(there))


def _matrix(rows: FloatArray) -> Matrix:
    (a, b, c), (d, e, f), (g, h, i) = rows.tolist()
    return ((a, b, c), (d, e, f), (g, h, i))


def point_tool(
    control: Control,
    name: str,
    *,
    sense: float = 0.0,
    at: Statement | None = None,
    about_tip: bool = False,
) -> None:
    """Turn the rotary axes until the tool stands across the plane of the frame, then count in it.

    Args:
        sense: Sign of the axis next to the tool that is preferred; 0: whatever is nearest.
        at: What asks for it; None: the block's code.
        about_tip: They turn about the tip; else X, Y and Z rest.
    """
    end_tool_center(control, name, keeps_length=True)
    axes = rotary_axes_across(control, name, sense=sense, at=at)
    if about_tip:
        turn_about(control, name, axes)
    else:
        control.line_to([*control.motion.programmed[:3], *axes[3:]], rapid=True)
    begin_tool_center(control, name, tilted=True)


def turn_about(
    control: Control, name: str, axes: list[float], below: float = 0.0, *, rapid: bool = True
) -> None:
    """Turn the rotary axes about a point below the tip, where the part is.

    Args:
        axes: Where the rotary axes go to, programmed, shape (k,); X, Y and Z are not looked at.
        below: How far the point lies below the tip [mm].
        rapid: At the machine's own speed.
    """
    begin_tool_center(control, name)
    center = control.path.tool_center
    assert center is not None
    control.motion.lead_tip(center.with_length(center.length_difference + below))
    control.line_to([*control.motion.programmed[:3], *axes[3:]], rapid=rapid)
    control.motion.lead_tip(center)
    end_tool_center(control, name, keeps_length=True)


def rotary_axes_across(
    control: Control,
    name: str,
    *,
    sense: float = 0.0,
    only: bool = False,
    main: float = 0.0,
    at: Statement | None = None,
) -> list[float]:
    """Programmed position at which the tool stands across the plane of the frame, the tip not being led.

    Args:
        name: As for ``point_tool``.
        sense: Likewise.
        only: A solution with another sign is none.
        main: As for ``rotary_axes_for``.
        at: As for ``point_tool``.
    """
    setup = control.settings.setup
    if setup is None:
        message = f"{name} needs rotary axes, and no axis of this machine turns"
        control.fail("tilted-plane", message, at, "run it on a machine with them")
    center = ToolCenter(setup, 0.0, control.frame.zero())
    try:
        there = center.pointing(_normal(control), control.motion.part, sense, only=only, main=main)
    except ValueError as error:
        control.fail("tilted-plane", f"{name}: {error}", at)
    return [part - shift for part, shift in zip(there, control.frame.total, strict=True)]


def turned_with_plane(control: Control, axes: list[float]) -> list[float]:
    """The same position with a table that turns about the tool turned until X of the plane lies along the machine's X.

    Where no axis of the table turns about the tool, as it stands there, it is the same.
    """
    setup = control.settings.setup
    assert setup is not None
    center = ToolCenter(setup, 0.0, control.frame.zero())
    there = [value + shift for value, shift in zip(axes, control.frame.total, strict=True)]
    tool = center.direction(there)
    abscissa = applied(control.frame.matrix, (1.0, 0.0, 0.0))

    for column in setup.chain.column[turns_part(setup.chain)].tolist():
        turned = list(there)
        turned[column] += _QUARTER
        if math.dist(center.direction(turned), tool) > _ACROSS:
            continue
        x, y, _ = (center.frame_there(there).T @ abscissa).tolist()
        angle = math.degrees(math.atan2(y, x))
        for signed in (angle, -angle):
            turned[column] = there[column] + signed
            x, y, _ = (center.frame_there(turned).T @ abscissa).tolist()
            if abs(y) < _ACROSS < x:
                return [*axes[:column], axes[column] + signed, *axes[column + 1 :]]
    return axes


def refuse_leaning(control: Control, hint: str) -> None:
    """In a tilted plane X, Y and Z move when the tool stands across it, or its tip is led.

    Raises:
        ProgramError: The block moves one of them, and neither is so.
    """
    word = next((control.words[each] for each in "XYZ" if each in control.words), None)
    if word is not None and control.path.tool_center is None:
        message = "the tool does not stand across the tilted plane yet"
        control.fail("tilted-plane", message, word, hint)


def count_in_plane(control: Control, name: str, hint: str) -> None:
    """From the first block on that moves X, Y or Z in a tilted plane the length of the tool acts along it.

    Args:
        name: As for ``point_tool``.
        hint: What sets the tool across the plane.

    Raises:
        ProgramError: The tool does not stand across it, or a rotary axis would move.
    """
    if control.path.tool_center is not None or not any(each in control.words for each in "XYZ"):
        return
    if not _stands_across(control) or any(each in control.words for each in "ABC"):
        refuse_leaning(control, hint)
    elif control.settings.setup is not None:
        begin_tool_center(control, name, tilted=True)


def _stands_across(control: Control) -> bool:
    """Whether the tool, whose tip is not led, stands across the plane of the frame."""
    setup, across = control.settings.setup, _normal(control)
    if setup is None:
        return math.dist(across, _Z) < _ACROSS
    center = ToolCenter(setup, 0.0, control.frame.zero())
    return math.dist(center.direction(control.motion.part), across) < _ACROSS


def _normal(control: Control) -> Vector:
    """Unit vector across the plane of the frame, whatever scales it."""
    x, y, z = applied(control.frame.matrix, _Z)
    length = math.hypot(x, y, z)
    return (x / length, y / length, z / length)


def machine_directions(control: Control) -> Matrix:
    """The directions of the machine's X, Y and Z as the part, whose tip is led, sees them; as columns."""
    center = control.path.tool_center
    assert center is not None
    return _matrix(center.frame_there(control.motion.part))
