"""Patterns of places at which the modal call acts: HOLES1 on a line, HOLES2 on a circle, CYCLE801 in a grid."""

import math

from twin.nc.dialects.sinumerik.cycles.calls import CycleCall, CycleForm
from twin.nc.dialects.sinumerik.memory import memory_of
from twin.nc.dialects.sinumerik.subprograms import call_after_motion
from twin.nc.geometry.arcs import Point, direction

_MOST_HOLES = 10_000


def _count(call: CycleCall, name: str) -> int:
    value = call.get(name)
    if value != int(value) or not 1.0 <= value <= _MOST_HOLES:
        call.refuse("cycle-word", f"needs {name}, 1 to {_MOST_HOLES} places")
    return int(value)


def _visit(call: CycleCall, places: list[Point]) -> None:
    """Go rapidly to one place after the other; the modal call acts at each.

    Raises:
        ProgramError: No call is in force, or it is a subprogram.
    """
    control, memory = call.control, memory_of(call.control)
    if memory.modal_call is None:
        call.refuse("cycle-word", "needs a modal call before it", "write MCALL CYCLE81(...) before")
    for place in places:
        target = list(control.motion.programmed)
        control.modal.plane.aim(target, place)
        control.line_to(target, rapid=True)
        depth = control.program_counter.depth
        call_after_motion(control)
        if control.program_counter.depth > depth:
            message = "runs cycles at its places; a subprogram is called at places that are written as blocks"
            call.refuse("unsupported-statement", message)


def _row(call: CycleCall) -> None:
    call.need("SPCA", "SPCO", "NUM")
    cosine, sine = direction(call.get("STA1"))
    ways = [
        call.length("FDIS") + number * call.length("DBH") for number in range(_count(call, "NUM"))
    ]
    first, second = call.length("SPCA"), call.length("SPCO")
    places = [(first + way * cosine, second + way * sine) for way in ways]
    here = call.control.modal.plane.point(call.control.motion.programmed)
    if math.dist(here, places[-1]) < math.dist(
        here, places[0]
    ):  # it begins at the nearer end (manual)
        places.reverse()
    _visit(call, places)


def _circle(call: CycleCall) -> None:
    call.need("CPA", "CPO", "RAD", "NUM")
    radius, count = call.length("RAD"), _count(call, "NUM")
    if not radius > 0.0:
        call.refuse("cycle-size", "needs a radius RAD above 0")
    step = call.get("INDA") or 360.0 / count
    places = list[Point]()
    for number in range(count):
        cosine, sine = direction(call.get("STA1") + number * step)
        places.append((call.length("CPA") + radius * cosine, call.length("CPO") + radius * sine))
    _visit(call, places)


def _grid(call: CycleCall) -> None:
    call.need("_SPCA", "_SPCO", "_NUM1", "_NUM2")
    call.only("_VARI")
    cosine, sine = direction(call.get("_STA"))
    first, second = call.length("_SPCA"), call.length("_SPCO")
    columns, rows = _count(call, "_NUM1"), _count(call, "_NUM2")
    places = list[Point]()
    for row in range(rows):
        line = list[Point]()
        for column in range(columns):
            along, across = column * call.length("_DIS1"), row * call.length("_DIS2")
            line.append(
                (first + along * cosine - across * sine, second + along * sine + across * cosine)
            )
        places += line if row % 2 == 0 else reversed(line)  # in a zigzag
    _visit(call, places)


PATTERNS = {
    "HOLES1": CycleForm(("SPCA", "SPCO", "STA1", "FDIS", "DBH", "NUM", "_VARI", "_UMODE", "_HIDE", "_NSP"), _row),
    "HOLES2": CycleForm(("CPA", "CPO", "RAD", "STA1", "INDA", "NUM", "_VARI", "_UMODE", "_HIDE", "_NSP"), _circle),
    "CYCLE801": CycleForm(
        ("_SPCA", "_SPCO", "_STA", "_DIS1", "_DIS2", "_NUM1", "_NUM2", "_VARI", "_UMODE", "_ANG1", "_ANG2", "_HIDE",
         "_NSP", "_DMODE"),
        _grid,
    ),
}  # fmt: skip
