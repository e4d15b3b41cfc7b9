"""WORKPIECE: the blank of the simulation on the control's screen, reported for who looks for the stock of a program."""

from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik.cycles.calls import CycleCall, CycleForm, read_call
from twin.nc.functions import BLANK
from twin.nc.text.blocks import Statement

_BOX, _CYLINDER = 112.0, 192.0
"""Modes in which all that is written counts from the datum, as the control's mask writes them."""


def _report(call: CycleCall) -> None:
    """Report a box by two corners, or a cylinder, by heights from the datum; others only in words."""
    shape, mode = call.texts.get("SHAPE", "").upper(), call.get("MODE")
    top, bottom = call.length("ZA"), call.length("ZI")
    if shape == "BOX" and mode == _BOX:
        corners = {
            f"{name}{side}": call.length(f"{name}{side}") for name in "XY" for side in (1, 2)
        }
        call.control.function(BLANK, {**corners, "Z1": bottom, "Z2": top})
    elif shape == "CYLINDER" and mode == _CYLINDER:
        sizes = {"D": call.length("X1"), "L": top - bottom, "Z2": top}
        call.control.function(BLANK, sizes)
    else:
        message = f"{call.statement.keyword} in this form gives the twin no stock: the job does"
        report = call.control.report
        report.notice("WORKPIECE", message, call.statement.column, len(call.statement.keyword))


_FORM = CycleForm("WP REF OFFSET SHAPE MODE ZA ZI ZB X1 Y1 X2 Y2 W1 W2 W3 W4", _report)


def workpiece(control: Control, statement: Statement) -> None:
    """WORKPIECE(, , , "BOX", 112, ZA, ZI, ZB, X1, Y1, X2, Y2)."""
    _FORM.run(read_call(control, statement, _FORM))
