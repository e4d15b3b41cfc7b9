"""PLANE, cycle 19, M128 and FUNCTION TCPM: the tilted working plane, and the tip that is led while axes turn.

Sources: user's manuals Klartext of the TNC 640 ("Tilting the working plane", "FUNCTION TCPM"). Spatial angles turn
about the fixed X, then Y, then Z. Decisions:

* The master axis of SEQ and SYM is the one next to the tool; where TURN and MOVE leave the solution open, it is
  the nearest.
* M128 ends where PLANE turns the axes, and comes back when the program says so.
"""

import math
import re
from collections.abc import Callable, Mapping
from typing import NamedTuple

from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.cycles.transformations import (
    Step,
    apply_transformations,
    axis_values,
)
from twin.nc.dialects.heidenhain.memory import memory_of
from twin.nc.dialects.heidenhain.values import refuse_rest, value_at
from twin.nc.geometry.matrices import IDENTITY, Matrix, product, transposed
from twin.nc.geometry.planes import Vector, cross
from twin.nc.iso.machine_coordinates import machine_frame
from twin.nc.iso.tilted_plane import about, point_tool, rotary_axes_across, stands_across
from twin.nc.iso.tool_center import begin_tool_center, end_tool_center
from twin.nc.path.tool_center import ToolCenter
from twin.nc.text.blocks import Statement

_WORD = re.compile(
    r"[ \t]*(?:(?P<value>SP[ABC]|EUL(?:PR|NU|ROT)|[BN][XYZ]|DIST|MB(?![ \t]*MAX)|F(?![ \t]*(?:MAX|AUTO))|[ABC])(?=[ \t]*[-+.\dQ])"
    r"|(?P<flag>SEQ[-+]|SYM[-+]|TABLE[ \t]+ROT|COORD[ \t]+ROT|MOVE|TURN|STAY|MB[ \t]*MAX|F[ \t]*MAX|F[ \t]*AUTO))",
    re.IGNORECASE,
)
_KIND = re.compile(r"[ \t]*([A-Z]+)", re.IGNORECASE)
_TCPM = re.compile(r"[ \t]*F[ \t]+TCP[ \t]+AXIS[ \t]+POS[ \t]+PATHCTRL[ \t]+AXIS\b", re.IGNORECASE)
_ROTARY_PARAMETERS = {"A": "Q120", "B": "Q121", "C": "Q122"}
_SMALLEST = 1e-9
_HEIGHT = 2

M128 = "M128"


class _Plane(NamedTuple):
    """What a PLANE says: values by word, and words without values."""

    values: Mapping[str, float]
    flags: frozenset[str]

    def vector(self, *names: str) -> Vector:
        """Three values, 0 where they are left out."""
        x, y, z = (self.values.get(name, 0.0) for name in names)
        return (x, y, z)

    @property
    def sense(self) -> float:
        """The sign of the master axis that SEQ or SYM asks for; 0: either."""
        signs = {flag[-1] for flag in self.flags if flag[:3] in ("SEQ", "SYM")}
        return 1.0 if "+" in signs else -1.0 if "-" in signs else 0.0


def plane(control: Control, statement: Statement) -> None:
    """PLANE: tilts the working plane, and turns the rotary axes as TURN, MOVE or STAY says.

    Raises:
        ProgramError: It is of a kind that is not simulated, or the machine cannot.
    """
    kind = _KIND.match(statement.text)
    name = "" if kind is None else kind[1].upper()
    if name == "RESET":
        assert kind is not None
        _reset(control, _words(control, statement, kind.end()))
        return
    if kind is None or name not in _MATRICES:
        known = ", ".join((*_MATRICES, "RESET"))
        message = f"PLANE {name or '...'} is not simulated"
        control.fail("tilted-plane", message, statement, f"these are: {known}")
    words = _words(control, statement, kind.end())
    matrix = _MATRICES[name](control, statement, words)
    _leave(control)
    _tilt(control, matrix)
    _turn(control, statement, words)


def define_plane(control: Control, step: Step) -> None:
    """19: the working plane by spatial angles; the program turns the rotary axes to Q120 to Q122 itself."""
    if step.step == 0:
        return
    angles = axis_values(control, step, "ABC")
    _leave(control)
    if not any(angles.values()):
        _tilt(control, None)
        return
    _tilt(control, _spatial(*(angles.get(name, 0.0) for name in "ABC")))
    _write_angles(control, rotary_axes_across(control, "cycle 19"))


def retract(control: Control, way: float | None, *, rapid: bool = True) -> None:
    """Away from the part along Z by a way [mm]; None: to machine zero of that axis."""
    if way is not None:
        target = list(control.motion.programmed)
        target[_HEIGHT] += way
        control.line_to(target, rapid=rapid)
        return
    with machine_frame(control, "MB MAX"):
        target = list(control.motion.programmed)
        target[_HEIGHT] = 0.0
        if target[_HEIGHT] > control.motion.programmed[_HEIGHT]:
            control.line_to(target, rapid=rapid)


def begin_tcpm(control: Control) -> None:
    """M128: the tip is led while rotary axes turn; F counts its way."""
    begin_tool_center(control, M128)


def end_tcpm(control: Control) -> None:
    """M129."""
    center = control.path.tool_center
    if center is not None and not center.tilted:
        end_tool_center(control, "M129", keeps_length=True)


def function(control: Control, statement: Statement) -> None:
    """FUNCTION TCPM, RESET TCPM; MODE MILL changes nothing here.

    Raises:
        ProgramError: It is another one.
    """
    text = " ".join(statement.text.upper().split())
    if text.startswith("RESET TCPM"):
        end_tcpm(control)
    elif text.startswith("TCPM"):
        rest = statement.text[statement.text.upper().index("TCPM") + 4 :]
        if _TCPM.match(rest) is None:
            message = "FUNCTION TCPM is simulated as F TCP AXIS POS PATHCTRL AXIS"
            control.fail("tool-center", message, statement)
        begin_tool_center(control, "FUNCTION TCPM")
    elif not text.startswith("MODE MILL"):
        name = " ".join(statement.text.split()[:2])
        message = f"FUNCTION {name} is not followed"
        hint = "FUNCTION TCPM, FUNCTION RESET TCPM and FUNCTION MODE MILL are"
        control.fail("unsupported-statement", message, statement, hint)


def enter_plane(control: Control) -> None:
    """Before a block moves X, Y or Z in a tilted plane the tool must stand across it; then it counts in it.

    Raises:
        ProgramError: It does not.
    """
    if memory_of(control).tilt is None or control.path.tool_center is not None:
        return
    word = next((control.words[each] for each in control.words if each in "XYZ"), None)
    if word is None:
        return
    if not stands_across(control) or any(each in control.words for each in "ABC"):
        message = "the tool does not stand across the tilted plane yet"
        hint = "L A+Q120 C+Q122 FMAX (the axes of the machine) in a block before, or TURN in PLANE"
        control.fail("tilted-plane", message, word, hint)
    begin_tool_center(control, "PLANE", tilted=True)


def _words(control: Control, statement: Statement, at: int) -> _Plane:
    values: dict[str, float] = {}
    flags = set()
    while statement.text[at:].strip():
        match = _WORD.match(statement.text, at)
        if match is None:
            rest = statement.text[at:].strip()
            refuse_rest(control, statement.text_column + statement.text.index(rest, at), rest)
        at = match.end()
        if match["value"]:
            values[match["value"].upper()], at = value_at(control, statement, at)
        else:
            flags.add("".join(match["flag"].upper().split()))
    return _Plane(values, frozenset(flags))


# --- directions


def _spatial(a: float, b: float, c: float) -> Matrix:
    return product(about(2, c), product(about(1, b), about(0, a)))


def _by_spatial(_control: Control, _statement: Statement, words: _Plane) -> Matrix:
    return _spatial(*words.vector("SPA", "SPB", "SPC"))


def _by_euler(_control: Control, _statement: Statement, words: _Plane) -> Matrix:
    first, second, third = words.vector("EULPR", "EULNU", "EULROT")
    return product(about(2, first), product(about(0, second), about(2, third)))


def _by_vectors(control: Control, statement: Statement, words: _Plane) -> Matrix:
    normal, base = words.vector("NX", "NY", "NZ"), words.vector("BX", "BY", "BZ")
    length = math.hypot(*normal)
    if length < _SMALLEST:
        control.fail("tilted-plane", "PLANE VECTOR needs its normal NX NY NZ", statement)
    z = (normal[0] / length, normal[1] / length, normal[2] / length)
    y = cross(z, base)
    width = math.hypot(*y)
    if width < _SMALLEST:
        message = "the base vector BX BY BZ must not stand across the plane"
        control.fail("tilted-plane", message, statement)
    y = (y[0] / width, y[1] / width, y[2] / width)
    return transposed((cross(y, z), y, z))


def _by_axes(control: Control, statement: Statement, words: _Plane) -> Matrix:
    setup = control.settings.setup
    names = control.settings.axes.names
    lacking = [name for name in "ABC" if name in words.values and name not in names]
    if setup is None or lacking:
        message = f"the machine has no axis {lacking[0] if lacking else 'that turns'}"
        control.fail("tilted-plane", message, statement)
    there = list(control.motion.part)
    for name in "ABC":
        if name in words.values:
            column = names.index(name)
            there[column] = words.values[name] + control.frame.total[column]
    (a, b, c), (d, e, f), (g, h, i) = (
        ToolCenter(setup, 0.0, control.frame.zero()).frame_there(there).tolist()
    )
    return ((a, b, c), (d, e, f), (g, h, i))


def _by_increment(control: Control, statement: Statement, words: _Plane) -> Matrix:
    given = [
        (axis, words.values[name])
        for axis, name in enumerate(("SPA", "SPB", "SPC"))
        if name in words.values
    ]
    if len(given) != 1:
        control.fail("tilted-plane", "PLANE RELATIV needs one of SPA, SPB and SPC", statement)
    return product(memory_of(control).tilt or IDENTITY, about(*given[0]))


_MATRICES: Mapping[str, Callable[[Control, Statement, _Plane], Matrix]] = {
    "SPATIAL": _by_spatial,
    "EULER": _by_euler,
    "VECTOR": _by_vectors,
    "AXIAL": _by_axes,
    "RELATIV": _by_increment,
}


# --- what turns


def _leave(control: Control) -> None:
    end_tool_center(control, "PLANE", keeps_length=True)


def _tilt(control: Control, matrix: Matrix | None) -> None:
    memory = memory_of(control)
    memory.tilt = None if matrix is None or matrix == IDENTITY else matrix
    memory.order = [each for each in memory.order if each != "tilt"]
    if memory.tilt is not None:
        memory.order.append("tilt")
    apply_transformations(control)


def _turn(control: Control, statement: Statement, words: _Plane) -> None:
    how = words.flags & {"TURN", "MOVE", "STAY"}
    if len(how) > 1:
        control.fail("tilted-plane", "PLANE takes one of TURN, MOVE and STAY", statement)
    if "MBMAX" in words.flags:
        retract(control, None)
    elif "MB" in words.values:
        retract(control, words.values["MB"])
    if not how or "STAY" in how:
        if memory_of(control).tilt is not None:
            axes = rotary_axes_across(control, "PLANE", sense=words.sense, at=statement)
            _write_angles(control, axes)
        return
    if "MOVE" in how:
        if words.values.get("DIST", 0.0):
            message = "PLANE ... MOVE is simulated about the tip itself, without DIST"
            control.fail("tilted-plane", message, statement, "write TURN, or STAY and the axes")
        target = rotary_axes_across(control, "PLANE", sense=words.sense, at=statement)
        begin_tool_center(control, "PLANE")
        here = list(control.motion.programmed)
        control.line_to([*here[:3], *target[3:]], rapid=True)
    point_tool(control, "PLANE", sense=words.sense, at=statement)


def _reset(control: Control, words: _Plane) -> None:
    """PLANE RESET: the level plane; TURN and MOVE bring the rotary axes to 0."""
    _leave(control)
    _tilt(control, None)
    if "MBMAX" in words.flags:
        retract(control, None)
    elif "MB" in words.values:
        retract(control, words.values["MB"])
    if words.flags & {"TURN", "MOVE"} and control.settings.setup is not None:
        target = list(control.motion.programmed)
        turning = (name in "ABC" for name in control.settings.axes.names)
        level = [0.0 if turns else value for value, turns in zip(target, turning, strict=True)]
        control.line_to(level, rapid=True)


def _write_angles(control: Control, axes: list[float]) -> None:
    for name, value in zip(control.settings.axes.names, axes, strict=True):
        if name in _ROTARY_PARAMETERS:
            control.variables.write(_ROTARY_PARAMETERS[name], value)
