"""CYCLE72: milling along a contour that is a subprogram, or is between two labels.

The contour's first move says where it begins; the tool comes there by a lead. Decision: its blocks run once for each
pass.
"""

import dataclasses
import enum
import re

from twin.nc.dialects.sinumerik.cycles.calls import CycleCall, CycleForm
from twin.nc.dialects.sinumerik.cycles.drilling import MODES, Heights, heights_of
from twin.nc.dialects.sinumerik.flow.calls import call_subprogram
from twin.nc.dialects.sinumerik.flow.repeats import call_part
from twin.nc.iso.cycle_moves import go_to_height
from twin.nc.iso.leads import Lead, LeadKind, approach, depart, stand_at_height
from twin.nc.iso.milling.clearing import MOST_PASSES, levels_between
from twin.nc.iso.tool_compensation import radius_in_spindle
from twin.nc.text.blocks import Block

_SIDES = {40.0: 0.0, 41.0: 1.0, 42.0: -1.0}
_SHAPES = {1.0: (LeadKind.TANGENT, 0.0), 2.0: (LeadKind.ARC, 90.0), 3.0: (LeadKind.ARC, 180.0)}
_PART = re.compile(r"(\w+)[ \t]*:[ \t]*(\w+)")


class _Rise(enum.IntEnum):
    """Hundreds of VARI: how far the tool rises after each pass."""

    TO_RETURN = 0
    TO_SAFETY = 1
    BY_SAFETY = 2
    NOT_AT_ALL = 3


@dataclasses.dataclass(slots=True)
class _Milling:
    """A contour that is being milled, pass by pass; called when its blocks have run.

    Attributes:
        heights: Of the surface, the bottom and around them [mm].
        levels: Heights of the passes that are to come [mm].
        leads: The approach to the contour and the retraction.
        rises: How far behind each pass.
        feed: That was in force before.
    """

    call: CycleCall
    block: Block
    heights: Heights
    levels: list[float]
    leads: tuple[Lead, Lead]
    rises: int
    feed: float | None

    def begin(self) -> None:
        """Lead to the next pass, and let the contour's blocks run."""
        control, level = self.call.control, self.levels.pop(0)
        motion, across = control.motion, control.modal.plane.axes[2]
        motion.feed = self.leads[0].feed
        above = min(self.heights.safe, motion.programmed[across]) - level
        approach(control, dataclasses.replace(self.leads[0], above=max(above, 0.0)), None)
        stand_at_height(control, level, nowhere=True)
        name = self.call.texts["KNAME"]
        part = _PART.fullmatch(name)
        if part is not None:
            call_part(control, self.call.statement, part[1].upper(), part[2].upper())
        else:
            call_subprogram(control, self.call.statement, name.upper())
        control.program_counter.calls[-1].then = self

    def __call__(self) -> None:
        """A pass has ended: away from the contour, and to the next one."""
        control, across = self.call.control, self.call.control.modal.plane.axes[2]
        control.block, control.words, control.codes = self.block, {}, ()
        control.report.line = self.block.line
        depart(control, self.leads[1], None)
        here, safe = control.motion.programmed[across], self.heights.safe
        rise: dict[int, float] = {
            _Rise.TO_RETURN: self.heights.back,
            _Rise.TO_SAFETY: safe,
            _Rise.BY_SAFETY: here + safe - self.heights.surface,
            _Rise.NOT_AT_ALL: here,
        }
        go_to_height(control, rise[self.rises])
        if self.levels:
            self.begin()
            return
        go_to_height(control, self.heights.back)
        control.motion.feed = self.feed


def _mill_contour(call: CycleCall) -> None:
    """Check what the call gives, and begin."""
    control, heights, feed = call.control, heights_of(call), call.control.motion.feed
    if "KNAME" not in call.texts:
        call.refuse("cycle-word", "needs KNAME, the contour: its name or labels in quotes", '"A:B"')
    kind, between = call.get("VARI") % 10.0, int(call.get("VARI") // 10.0 % 10.0)
    rises = int(call.get("VARI") // 100.0)
    if kind not in (1.0, 2.0) or between not in (0, 1) or not 0 <= rises <= _Rise.NOT_AT_ALL:
        call.refuse("cycle-word", "takes VARI 1 or 2, in tens 0 or 1, in hundreds 0 to 3")
    rest = abs(call.length("FALD")) if kind == 1.0 else 0.0
    depth = abs(call.length("MID")) or heights.surface - heights.bottom
    if (heights.surface - heights.bottom) / depth > MOST_PASSES:
        call.refuse("cycle-size", f"would need more than {MOST_PASSES} passes")
    levels = levels_between(heights.surface, heights.bottom + rest, depth)
    if not levels:
        call.refuse("cycle-depth", f"leaves {rest:g} at the bottom, where no more is to be milled")
    leads = _lead(call, "AS1", "LP1", kind), _lead(call, "AS2", "LP2", kind)
    go_to_height(control, heights.back)
    _Milling(call, control.block, heights, list(levels), leads, rises, feed).begin()


def _lead(call: CycleCall, shape: str, size: str, kind: float) -> Lead:
    """The approach to the contour or the retraction."""
    control, side = call.control, _SIDES.get(call.get("RL"))
    chosen = _SHAPES.get(call.get(shape))
    if side is None or chosen is None or (side == 0.0 and chosen[0] is not LeadKind.TANGENT):
        shapes = "1 straight, 2 a quarter or 3 half a circle; with RL 40 only 1"
        call.refuse("cycle-word", f"takes RL 40, 41 or 42, and {shape} {shapes}")
    length, allowance = abs(call.length(size)), abs(call.length("FAL")) if kind == 1.0 else 0.0
    offset = radius_in_spindle(control) + allowance if side else 0.0
    if chosen[0] is LeadKind.TANGENT:
        length += radius_in_spindle(control)
    if length <= 0.0:
        call.refuse("cycle-size", f"needs {size}, the length or radius of the lead, above 0")
    feed = call.get("FFP1") or control.motion.feed
    return Lead(
        kind=chosen[0],
        size=length,
        angle=chosen[1],
        side=side,
        offset=offset,
        feed_before=call.get("FF3") or feed,
        feed=feed,
        rapid=int(call.get("VARI") // 10.0 % 10.0) == 0,
        feed_down=call.get("FFD") or None,
    )


CONTOURS = {
    "CYCLE72": CycleForm(
        f"KNAME RTP RFP SDIS DP MID FAL FALD FFP1 FFD VARI RL AS1 LP1 FF3 AS2 LP2 UMODE FS ZFS {MODES}",
        _mill_contour,
    )
}
