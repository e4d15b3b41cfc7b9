"""Patterns of places at which the modal call acts: HOLES1 on a line, HOLES2 on a circle, CYCLE801 in a grid."""

import math

from twin.nc.dialects.sinumerik.cycles.calls import CycleCall, CycleForm
from twin.nc.dialects.sinumerik.flow.calls import call_after_motion
from twin.nc.dialects.sinumerik.memory import memory_of
from twin.nc.geometry.arcs import Point
from twin.nc.iso.cycle_moves import along, circle, go, grid, row


def _visit(call: CycleCall, places: list[Point]) -> None:
    """Go rapidly to one place after the other; the modal call acts at each."""
    control, memory = call.control, memory_of(call.control)
    if memory.modal_call is None:
        call.refuse("cycle-word", "needs a modal call before it", "write MCALL CYCLE81(...) before")
    for place in places:
        go(control, place, rapid=True)
        depth = control.program_counter.depth
        call_after_motion(control)
        if control.program_counter.depth > depth:
            message = "runs cycles at its places; a subprogram is called at places that are written as blocks"
            call.refuse("unsupported-statement", message)


def _row(call: CycleCall) -> None:
    call.need("SPCA", "SPCO")
    angle = call.get("STA1")
    first = along(call.point("SPCA", "SPCO"), angle, call.length("FDIS"))
    places = row(first, angle, call.length("DBH"), call.count("NUM"))
    here = call.control.modal.plane.point(call.control.motion.programmed)
    if math.dist(here, places[-1]) < math.dist(here, places[0]):
        places.reverse()  # it begins at the nearer end (manual)
    _visit(call, places)


def _circle(call: CycleCall) -> None:
    call.need("CPA", "CPO", "RAD")
    radius, count = call.length("RAD"), call.count("NUM")
    if not radius > 0.0:
        call.refuse("cycle-size", "needs a radius RAD above 0")
    step = call.get("INDA") or 360.0 / count
    _visit(call, circle(call.point("CPA", "CPO"), radius, call.get("STA1"), step, count))


def _grid(call: CycleCall) -> None:
    call.need("SPCA", "SPCO")
    call.only("VARI")
    angle = call.get("STA")
    angles = (angle + call.get("ANG1"), angle + call.get("ANG2"))
    spacing = (call.length("DIS1"), call.length("DIS2"))
    counts = (call.count("NUM1"), call.count("NUM2"))
    _visit(call, grid(call.point("SPCA", "SPCO"), angles, spacing, counts))


PATTERNS = {
    "HOLES1": CycleForm("SPCA SPCO STA1 FDIS DBH NUM VARI UMODE HIDE NSP", _row),
    "HOLES2": CycleForm("CPA CPO RAD STA1 INDA NUM VARI UMODE HIDE NSP", _circle),
    "CYCLE801": CycleForm(
        "SPCA SPCO STA DIS1 DIS2 NUM1 NUM2 VARI UMODE ANG1 ANG2 HIDE NSP DMODE", _grid
    ),
}
