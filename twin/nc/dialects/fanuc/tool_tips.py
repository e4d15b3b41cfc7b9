"""Tool centre point control and tilted planes of the family: G43.4 or G234, G68.2 with G53.1, G254.

Sources: operator's manuals of the Series 30i (tool center point control type 1, tilted working plane
command) and of Haas mills with G234, G254. Angles of G68.2 are Euler's: I about Z, J about the new X, K about the new Z.
"""

from twin.nc.control.codes import Action
from twin.nc.control.control import Control
from twin.nc.dialects.fanuc.memory import memory_of
from twin.nc.dialects.fanuc.tool_offsets import apply_length
from twin.nc.dialects.fanuc.transformations import set_tilt
from twin.nc.geometry.matrices import Matrix, product
from twin.nc.iso.tilted_plane import about, machine_directions, point_tool
from twin.nc.iso.tool_center import begin_tool_center, end_tool_center


def begin(name: str) -> Action:
    """G43.4 H1, G234 H1: the tip of the tool is led while rotary axes turn; F counts its way."""

    def action(control: Control) -> None:
        end_tool_center(control, name)
        apply_length(control, 1.0, control.codes[-1][0])
        begin_tool_center(control, name)

    return action


def tilt(control: Control) -> None:
    """G68.2 X Y Z I J K: the origin of the tilted plane, and its Euler angles.

    Raises:
        ProgramError: It has another form, or another one is in force.
    """
    mode = control.take("P")
    if mode is not None and control.number(mode) != 0.0:
        message = "of the forms of G68.2 the one by Euler's angles (P0) is simulated"
        control.fail("tilted-plane", message, mode, "G68.2 X0 Y0 Z0 I0 J30. K0")
    if memory_of(control).tilt is not None:
        control.fail("tilted-plane", "a tilted plane is in force", hint="end it by G69 first")
    origin = list(control.motion.programmed[:3])
    for index, word in control.take_axis_words():
        if index > 2:
            control.fail("tilted-plane", f"{word.address} has no place in G68.2", word)
        origin[index] = control.axis_value(index, word)
    angles = [control.number(control.take(letter)) for letter in "IJK"]
    set_tilt(control, euler(*angles), (origin[0], origin[1], origin[2]))


def euler(first: float, second: float, third: float) -> Matrix:
    """Turns about Z, the new X and the new Z [deg]; its columns are the directions of the plane's axes."""
    return product(about(2, first), product(about(0, second), about(2, third)))


def orient(control: Control) -> None:
    """G53.1: rotary axes turn until the tool stands across the tilted plane, rapidly; X, Y and Z rest."""
    if memory_of(control).tilt is None:
        message = "G53.1 sets the tool across a tilted plane, and none is in force"
        control.fail("tilted-plane", message, hint="G68.2 X0 Y0 Z0 I J K before")
    point_tool(control, "G53.1")


def require_orientation(control: Control) -> None:
    """In a tilted plane X, Y and Z move when the tool stands across it.

    Raises:
        ProgramError: It does not yet.
    """
    tilted = memory_of(control).tilt is not None and control.path.tool_center is None
    word = next((control.words[each] for each in "XYZ" if each in control.words), None)
    if tilted and word is not None:
        message = "the tool does not stand across the tilted plane yet"
        control.fail("tilted-plane", message, word, "G53.1 behind G68.2, before X, Y and Z move")


def level(control: Control) -> None:
    """G69: no tilted plane and no rotation; the axes stay where they are."""
    center = control.path.tool_center
    if center is not None and center.tilted:
        end_tool_center(control, "G69", keeps_length=True)
    memory_of(control).rotation = None
    set_tilt(control, None)


def begin_dynamic_offset(control: Control) -> None:
    """G254: the work offset goes with the part as the rotary axes have turned it; directions are the machine's."""
    if memory_of(control).tilt is not None:
        control.fail("tilted-plane", "G254 is in force already", hint="end it by G255 first")
    begin_tool_center(control, "G254", tilted=True)
    set_tilt(control, machine_directions(control))


def end_dynamic_offset(control: Control) -> None:
    """G255."""
    end_tool_center(control, "G255", keeps_length=True)
    set_tilt(control, None)
