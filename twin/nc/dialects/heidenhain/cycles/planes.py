"""PLANE and cycle 19: the tilted working plane.

Source: user's manuals Klartext of the TNC 640 ("Tilting the working plane"). Decisions:

* The master axis of SEQ and SYM is the one next to the tool; where TURN and MOVE leave the solution open, it is
  the nearest.
* COORD ROT holds where the program says neither it nor TABLE ROT.
* M128 ends where PLANE turns the axes, and comes back when the program says so.
"""

import re

from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.cycles.plane_directions import MATRICES, PlaneWords, spatial
from twin.nc.dialects.heidenhain.cycles.transformations import (
    DefinitionStep,
    apply_transformations,
    axis_values,
)
from twin.nc.dialects.heidenhain.memory import memory_of
from twin.nc.dialects.heidenhain.values import refuse_rest, value_at
from twin.nc.geometry.matrices import IDENTITY, Matrix
from twin.nc.iso.cycle_moves import at_feed
from twin.nc.iso.machine_coordinates import machine_frame
from twin.nc.iso.orientation.tilted_plane import (
    count_in_plane,
    rotary_axes_across,
    turn_about,
    turned_with_plane,
)
from twin.nc.iso.orientation.tool_center import begin_tool_center, end_tool_center
from twin.nc.text.blocks import Statement

_WORD = re.compile(
    r"[ \t]*(?:(?P<value>SP[ABC]|EUL(?:PR|NU|ROT)|PROPR|PROMIN|ROT|P[123][XYZ]|[BN][XYZ]|DIST|ABST"
    r"|MB(?![ \t]*MAX)|F(?![ \t]*(?:MAX|AUTO))|[ABC])(?=[ \t]*[-+.\dQ])"
    r"|(?P<flag>SEQ[-+]|SYM[-+]|TABLE[ \t]+ROT|COORD[ \t]+ROT|MOVE|TURN|STAY|MB[ \t]*MAX|F[ \t]*MAX|F[ \t]*AUTO))",
    re.IGNORECASE,
)
_KIND = re.compile(r"[ \t]*([A-Z]+)", re.IGNORECASE)
_ROTARY_PARAMETERS = {"A": "Q120", "B": "Q121", "C": "Q122"}
_HEIGHT = 2
_SPATIAL_ANGLES = ("SPA", "SPB", "SPC")
"""All three are always defined (manual)."""


def plane(control: Control, statement: Statement) -> None:
    """PLANE: tilts the working plane, and turns the rotary axes as TURN, MOVE or STAY says."""
    kind = _KIND.match(statement.text)
    name = "" if kind is None else kind[1].upper()
    if kind is None or (name != "RESET" and name not in MATRICES):
        known = ", ".join((*MATRICES, "RESET"))
        message = f"PLANE {name} is not simulated" if name else "PLANE needs its kind"
        control.fail("tilted-plane", message, statement, f"these are: {known}")
    words = _words(control, statement, kind.end())
    missing = [each for each in _SPATIAL_ANGLES if each not in words.values]
    if name == "SPATIAL" and missing:
        message = f"PLANE SPATIAL needs {' and '.join(missing)}"
        control.fail("tilted-plane", message, statement, "PLANE SPATIAL SPA+0 SPB+30 SPC+0 TURN")
    if len(words.flags & {"TURN", "MOVE", "STAY"}) > 1:
        control.fail("tilted-plane", "PLANE takes one of TURN, MOVE and STAY", statement)
    matrix = None if name == "RESET" else MATRICES[name](control, statement, words)
    end_tool_center(control, "PLANE", keeps_length=True)
    _tilt(control, matrix)
    if "MBMAX" in words.flags:
        retract(control, None)
    elif "MB" in words.values:
        retract(control, words.values["MB"] * control.modal.unit)
    _turn(control, statement, words)


def define_plane(control: Control, step: DefinitionStep) -> None:
    """19: the working plane by spatial angles; the program turns the rotary axes to Q120 to Q122 itself."""
    if step.step == 0:
        return
    angles = axis_values(control, step, "ABC")
    end_tool_center(control, "PLANE", keeps_length=True)
    if not any(angles.values()):
        _tilt(control, None)
        return
    _tilt(control, spatial(*(angles.get(name, 0.0) for name in "ABC")))
    _write_angles(control, rotary_axes_across(control, "cycle 19"))


def retract(control: Control, distance: float | None, *, rapid: bool = True) -> None:
    """Away from the part along Z by a distance [mm]; None: to machine zero of that axis."""
    if distance is not None:
        target = list(control.motion.programmed)
        target[_HEIGHT] += distance
        control.line_to(target, rapid=rapid)
        return
    with machine_frame(control, "MB MAX"):
        target = list(control.motion.programmed)
        target[_HEIGHT] = 0.0
        if target[_HEIGHT] > control.motion.programmed[_HEIGHT]:
            control.line_to(target, rapid=rapid)


def enter_plane(control: Control) -> None:
    """Before a block moves X, Y or Z in a tilted plane the tool must stand across it; then it counts in it."""
    if memory_of(control).tilt is not None:
        hint = "L A+Q120 C+Q122 FMAX (the axes of the machine) in a block before, or TURN in PLANE"
        count_in_plane(control, "PLANE", hint)


def _words(control: Control, statement: Statement, at: int) -> PlaneWords:
    values: dict[str, float] = {}
    flags = set()
    while statement.text[at:].strip():
        match = _WORD.match(statement.text, at)
        if match is None:
            rest = statement.text[at:].strip()
            refuse_rest(control, statement.text_column + statement.text.index(rest, at), rest)
        at = match.end()
        if match["value"]:
            name = match["value"].upper().replace("ABST", "DIST")
            values[name], at = value_at(control, statement, at)
        else:
            flags.add("".join(match["flag"].upper().split()))
    return PlaneWords(values, frozenset(flags))


def _tilt(control: Control, matrix: Matrix | None) -> None:
    memory = memory_of(control)
    memory.tilt = None if matrix is None or matrix == IDENTITY else matrix
    memory.order = [each for each in memory.order if each != "tilt"]
    if memory.tilt is not None:
        memory.order.append("tilt")
    apply_transformations(control)


def _turn(control: Control, statement: Statement, words: PlaneWords) -> None:
    """TURN, MOVE and STAY; without them as STAY."""
    tilted, turns = memory_of(control).tilt is not None, words.flags & {"TURN", "MOVE"}
    if not tilted and (not turns or control.settings.setup is None):
        return
    axes = rotary_axes_across(
        control, "PLANE", sense=words.sense, only=words.sense != 0.0, at=statement
    )
    if not tilted:
        turning = (name in "ABC" for name in control.settings.axes.names)
        axes = [0.0 if each else value for value, each in zip(axes, turning, strict=True)]
    elif "TABLEROT" in words.flags:
        axes = turned_with_plane(control, axes)
    if not turns:
        _write_angles(control, axes)
        return
    feed = words.values.get("F")
    with at_feed(control, feed if feed is not None else control.motion.feed):
        if "MOVE" in turns:
            distance = words.values.get("DIST", 0.0) * control.modal.unit
            turn_about(control, "PLANE", axes, distance, rapid=feed is None)
        else:
            here = control.motion.programmed[:3]
            control.line_to([*here, *axes[3:]], rapid=feed is None)
    if tilted:
        begin_tool_center(control, "PLANE", tilted=True)


def _write_angles(control: Control, axes: list[float]) -> None:
    for name, value in zip(control.settings.axes.names, axes, strict=True):
        if name in _ROTARY_PARAMETERS:
            control.variables.write(_ROTARY_PARAMETERS[name], value)
