"""Tool centre point control and tilted planes of the family: G43.4, G43.5 or G234, G53.1, G254.

Sources: operator's manuals of the Series 30i (tool center point control type 1, tilted working plane
command) and of Haas mills with G234, G254. Angles of G68.2 are Euler's: I about Z, J about the new X, K about the new Z.
"""

from twin.nc.control.codes import Action
from twin.nc.control.control import Control
from twin.nc.dialects.fanuc.frames.transformations import set_tilt
from twin.nc.dialects.fanuc.memory import memory_of
from twin.nc.dialects.fanuc.tools.tool_offsets import apply_length
from twin.nc.iso.orientation.tilted_plane import machine_directions, point_tool, refuse_leaning
from twin.nc.iso.orientation.tool_center import begin_tool_center, end_tool_center, point_by_words

VECTORS = "G43.5"
_BY_VECTORS = 43.5


def begin(name: str) -> Action:
    """G43.4 H1, G43.5 H1, G234 H1: the tip of the tool is led while rotary axes turn; F counts its path.

    G43.4 P1 and G43.5 P1 turn the tool in the plane of both directions (tool posture control); P0, or no P, does not.
    """

    def action(control: Control) -> None:
        end_tool_center(control, name)
        posture = control.take("P") if name in ("G43.4", VECTORS) else None
        if posture is not None and control.number(posture) not in (0.0, 1.0):
            message = f"{name} takes P0, rotary axes go evenly, or P1, the tool turns in a plane"
            control.fail("tool-center", message, posture)
        inclination = control.take("Q") if name == VECTORS else None
        if inclination is not None and control.number(inclination) != 0.0:
            message = "an inclination Q of the tool is not followed"
            control.fail("tool-center", message, inclination, "post vectors of the tool itself")
        apply_length(control, 1.0, control.codes[-1][0])
        in_plane = posture is not None and control.number(posture) == 1.0
        begin_tool_center(control, name, in_plane=in_plane)

    return action


def point_by_vector(control: Control) -> None:
    """I, J and K of a block in G43.5: the direction of the tool at its end, from its tip to the spindle."""
    if control.modal.active.get("length") != _BY_VECTORS or control.path.tool_center is None:
        return
    names = control.settings.axes.names
    turning = next(
        (control.words[each] for each in "ABC" if each in names and each in control.words), None
    )
    if turning is not None:
        message = f"in {VECTORS} vectors I J K point the tool, and no rotary axis is named"
        control.fail("tool-center", message, turning, "G43.4 takes the rotary axes")
    words = [control.take(letter) for letter in "IJK"]
    first = next((word for word in words if word is not None), None)
    if first is not None:
        x, y, z = (control.number(word) for word in words)
        point_by_words(control, (x, y, z), first)


def orient(name: str, plane: str, *, about_tip: bool = False) -> Action:
    """G53.1, G53.6, G253: rotary axes turn until the tool stands across the tilted plane, rapidly.

    Args:
        about_tip: They turn about the tip (G53.6); else X, Y and Z rest.
    """

    def action(control: Control) -> None:
        if memory_of(control).tilt is None:
            message = f"{name} sets the tool across a tilted plane, and none is in force"
            control.fail("tilted-plane", message, hint=f"{plane} before")
        if about_tip:
            _refuse_distance(control)
        point_tool(control, name, about_tip=about_tip)

    return action


def _refuse_distance(control: Control) -> None:
    word = control.take("R")
    if word is not None and control.number(word) != 0.0:
        message = "G53.6 turns about the tip here, and not about a place at a distance R from it"
        control.fail("tilted-plane", message, word, "leave R out, and retract before")


def require_orientation(control: Control) -> None:
    """In a tilted plane X, Y and Z move when the tool stands across it."""
    if memory_of(control).tilt is not None:
        refuse_leaning(control, "G53.1 behind G68.2, or G253 behind G268, before X, Y and Z move")


def level(control: Control) -> None:
    """G69, G269: no tilted plane and no rotation; the axes stay where they are."""
    center = control.path.tool_center
    if center is not None and center.tilted:
        end_tool_center(control, "the end of the tilted plane", keeps_length=True)
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
