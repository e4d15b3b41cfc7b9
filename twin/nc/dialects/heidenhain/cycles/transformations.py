"""Cycles that act where they are defined: 7 datum shift, 8 mirror, 9 dwell, 10 rotation, 11 scale, 13, 19, 32, 247.

Shift, mirror, rotation and scale act in the order in which the program has put them into force, each on what comes
before it, so that it turns and mirrors about the datum in force (decision: one that is changed keeps its place).
"""

import re
from collections.abc import Mapping
from typing import NamedTuple

from twin.nc.canonical import Corner
from twin.nc.control.control import Control, refuse_axis
from twin.nc.dialects.heidenhain.memory import memory_of
from twin.nc.geometry.matrices import (
    IDENTITY,
    LARGEST_SCALE,
    SMALLEST_SCALE,
    Matrix,
    applied,
    product,
    rotated,
    stretched,
)
from twin.nc.geometry.planes import Vector
from twin.nc.iso.offsets import offset_of_job, shift_by
from twin.nc.text.blocks import Word

_AXIS = re.compile(r"(I?)([XYZABCUVW])[ \t]*([-+]?[ \t]*(?:[.0-9]+|Q[LR]?[0-9]+))", re.IGNORECASE)
_NAMES = re.compile(r"[XYZABCUVW](?![A-Z0-9])", re.IGNORECASE)
_LAST = re.compile(
    r"(I?)(?:ROT|SCL|T|DWELL|TIME|[A-Z.]*ZEIT|[A-Z.]*)[ \t]*([-+]?[ \t]*(?:[.0-9]+|Q[LR]?[0-9]+))[ \t]*",
    re.IGNORECASE,
)
_ROW = re.compile(r"[ \t]*#[ \t]*([0-9]+|Q[LR]?[0-9]+)[ \t]*", re.IGNORECASE)
_OWN_ROWS = (0, 1)
"""Presets of 247, and rows of the datum table, that are part zero where the job gives them no values (decision)."""


class DefinitionStep(NamedTuple):
    """One block of a definition in steps, such as ``7.1 X+60``.

    Attributes:
        column: Where that begins.
    """

    cycle: int
    step: int
    text: str
    column: int

    def fail(self, control: Control, code: str, message: str, hint: str | None = None) -> None:
        """Refuse what it says."""
        width = len(self.text.strip()) or 1
        begin = self.column + len(self.text) - len(self.text.lstrip())
        control.report.fail(code, message, begin, width, hint)


def _last_value(control: Control, step: DefinitionStep) -> tuple[float, bool]:
    """The value at the end of a step, and whether it is incremental."""
    match = _LAST.fullmatch(step.text.strip())
    if match is None:
        step.fail(control, "cycle-word", f"{step.cycle}.{step.step} needs its value")
        raise AssertionError
    text, column = step.text.strip(), step.column + len(step.text) - len(step.text.lstrip())
    value, _ = control.statements.operand(text, match.start(2), column)
    return control.compute(value, column + match.start(2)), match[1].upper() == "I"


def shift_datum(control: Control, step: DefinitionStep) -> None:
    """7: the datum lies so far from part zero; incremental values count from the datum in force."""
    memory = memory_of(control)
    if step.step == 0:
        return
    row = _ROW.fullmatch(step.text)
    if row is not None:
        _shift_by_row(control, step, row)
        return
    given = list(_AXIS.finditer(step.text))
    if not given or _AXIS.sub("", step.text).strip():
        step.fail(control, "cycle-word", "7 needs an axis and its shift", "CYCL DEF 7.1 X+60")
    for match in given:
        name, at = match[2].upper(), step.column + match.start()
        value, _ = control.statements.operand(step.text, match.start(3), step.column)
        number = control.compute(value, step.column + match.start(3))
        index = control.axis_index.get(name)
        if index is None:
            if number != 0.0:
                refuse_axis(control, Word(name, number, at, len(match[0])))
            continue
        there = memory.shift.get(index, 0.0) if match[1] else 0.0
        memory.shift[index] = there + number * control.motion.unit_of(index)
    _enter(control, "shift", any(memory.shift.values()))


def _shift_by_row(control: Control, step: DefinitionStep, row: re.Match[str]) -> None:
    """7.1 #2: the shift is the row ``DATUM2`` of the job; 0 and 1 shift nothing where the job does not give them."""
    value, _ = control.statements.operand(step.text, row.start(1), step.column)
    number = control.compute(value, step.column + row.start(1))
    word = Word("#", number, step.column + row.start(1) - 1, len(row[1]) + 1)
    given = _values_of_row(control, f"DATUM{number:g}", number, word)
    names = control.settings.axes.names
    memory_of(control).shift = {names.index(name): each for name, each in given.items()}
    _enter(control, "shift", any(given.values()))


def _values_of_row(control: Control, name: str, number: float, word: Word) -> Mapping[str, float]:
    """The values that the job gives a row of the control's tables [mm or deg]."""
    if number in _OWN_ROWS and name not in control.settings.offsets:
        return {}
    return offset_of_job(control, name, word)


def mirror(control: Control, step: DefinitionStep) -> None:
    """8: the axes that it names are mirrored; none ends it."""
    if step.step == 0:
        return
    names = {match[0].upper() for match in _NAMES.finditer(step.text)}
    if _NAMES.sub("", step.text).strip() or not names <= set("XYZ"):
        step.fail(control, "cycle-word", "8 mirrors X, Y and Z", "CYCL DEF 8.1 X")
    x, y, z = (-1.0 if name in names else 1.0 for name in "XYZ")
    memory_of(control).mirrored = (x, y, z)
    _enter(control, "mirror", bool(names))


def rotate(control: Control, step: DefinitionStep) -> None:
    """10: about the datum, by an angle from the abscissa; incremental ones are added."""
    if step.step == 0:
        return
    memory, (value, incremental) = memory_of(control), _last_value(control, step)
    memory.rotation = value + (memory.rotation if incremental else 0.0)
    _enter(control, "rotation", memory.rotation != 0.0)


def scale(control: Control, step: DefinitionStep) -> None:
    """11: all coordinates by a factor."""
    if step.step == 0:
        return
    value, _ = _last_value(control, step)
    if not SMALLEST_SCALE <= value <= LARGEST_SCALE:
        step.fail(control, "scale", f"the factor {value:g} is no scale", "CYCL DEF 11.1 SCL 0.75")
    memory_of(control).scale = value
    _enter(control, "scale", value != 1.0)


def _enter(control: Control, kind: str, active: bool) -> None:
    """A transformation has changed."""
    if control.path.compensation.in_force or control.path.leads is not None:
        message = "coordinates do not change while radius compensation is in force"
        control.fail("compensation-change", message, hint="end it by R0 before")
    order = memory_of(control).order
    if active and kind not in order:
        order.append(kind)
    elif not active and kind in order:
        order.remove(kind)
    apply_transformations(control)


def apply_transformations(control: Control) -> None:
    """Let shift, mirror, rotation and scale act in their order."""
    memory = memory_of(control)
    matrix: Matrix = IDENTITY
    total: Vector = (0.0, 0.0, 0.0)
    shift = [memory.shift.get(index, 0.0) for index in range(len(control.settings.axes))]
    for kind in memory.order:
        x, y, z = applied(matrix, (shift[0], shift[1], shift[2]))
        if kind == "shift":
            total = (total[0] + x, total[1] + y, total[2] + z)
        else:
            matrix = product(matrix, _matrix_of(control, kind))
    control.frame.set_shift("increment", [*total, *shift[3:]])
    control.frame.set_matrix(matrix)
    control.motion.reframed()


def _matrix_of(control: Control, kind: str) -> Matrix:
    memory = memory_of(control)
    if kind == "tilt":
        return memory.tilt or IDENTITY
    if kind == "mirror":
        return stretched(memory.mirrored, 1.0)
    if kind == "scale":
        return stretched((1.0, 1.0, 1.0), memory.scale)
    matrix, _ = rotated(IDENTITY, control.modal.plane.directions, memory.rotation, (0.0, 0.0))
    return matrix


def dwell(control: Control, step: DefinitionStep) -> None:
    """9: wait so many seconds."""
    if step.step == 0:
        return
    value, _ = _last_value(control, step)
    if value < 0.0:
        step.fail(control, "dwell", "a dwell cannot be negative")
    control.dwell(value)


def orient_spindle(control: Control, step: DefinitionStep) -> None:
    """13: the spindle is at an angle, as M19."""
    if step.step > 0:
        control.function("M19", {"R": _last_value(control, step)[0]})


def axis_values(control: Control, step: DefinitionStep, names: str) -> dict[str, float]:
    """The values of axes in a block of a definition, by their names."""
    found = {}
    for match in _AXIS.finditer(step.text):
        if match[2].upper() in names:
            value, _ = control.statements.operand(step.text, match.start(3), step.column)
            found[match[2].upper()] = control.compute(value, step.column)
    return found


def set_tolerance(control: Control, step: DefinitionStep) -> None:
    """32: how far corners may be cut; without a value as before."""
    if step.step == 0 or step.step == 2:
        return
    modal = control.modal
    if not step.text.strip():
        modal.corner, modal.corner_tolerance = Corner.EXACT_PATH, float("nan")
        return
    value, _ = _last_value(control, step)
    if value < 0.0:
        step.fail(control, "cycle-word", "a tolerance cannot be negative", "CYCL DEF 32.1 T0.05")
    modal.corner, modal.corner_tolerance = Corner.CONTINUOUS, value * modal.unit


def select_preset(control: Control, number: float, word: Word) -> None:
    """247: a preset of the job, ``PRESET2``; 0 and 1 are part zero where the job gives them no values."""
    shift_by(control, _values_of_row(control, f"PRESET{number:g}", number, word))
