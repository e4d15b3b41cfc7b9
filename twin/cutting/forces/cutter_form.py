"""A tool of the job as forces see it, and what a material does to its edges."""

import math
from typing import NamedTuple

import numpy as np

from twin.cutting.forces.direction import RADIAL_SHARE
from twin.cutting.forces.materials import Kienzle
from twin.cutting.kernels.teeth import ANGLE_BINS, CutterForm, ForceLaw
from twin.cutting.tools import Profile, profile
from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray

RINGS = 6
"""Rings that the lower end of a cutter is looked at in."""
DRILL_SHARE = 0.5
"""Thrust on an edge of a drill as a share of its tangential force: Ff = 0.5 kc D/2 fn sin(point
angle / 2) (Sandvik Coromant's drilling formula)."""
RAKE = math.radians(5.0)
"""Normal rake of an end mill's edge, where the job says nothing of it [rad]."""


def cutter_form(tool: ToolTable) -> CutterForm:
    """The edges of a tool."""
    edge = profile(tool)
    rings = _rings(edge)
    helix = math.radians(tool.helix_angle)
    rise = math.tau / ANGLE_BINS * edge.radius / math.tan(helix) if helix else math.inf
    return CutterForm(
        profile=edge,
        side_from=float(edge.height(np.array(edge.radius))),
        flute=tool.flute,
        teeth=tool.teeth,
        rise=rise,
        radius=rings.radius,
        height=rings.height,
        span=rings.span,
        width=rings.width,
        outwards=rings.outwards,
        downwards=np.sqrt(1.0 - rings.outwards**2),
    )


def force_law(tool: ToolTable, material: Kienzle) -> ForceLaw:
    """What a material does to the edges of a tool.

    The shares of an edge that is inclined by the helix angle i follow from that of a straight one,
    tan(b - a) with the rake a, by oblique cutting with the chip's flow after Stabler (Altintas,
    Manufacturing Automation, 2nd ed., oblique cutting mechanics):

        radial = sin(b - a) / (cos i D), along = tan i (cos(b - a) - sin b) / D,
        D = cos(b - a) + tan² i sin b.
    """
    straight = math.atan(DRILL_SHARE if tool.kind == "drill" else RADIAL_SHARE)
    helix = math.radians(tool.helix_angle)
    friction = straight + RAKE
    below = math.cos(straight) + math.tan(helix) ** 2 * math.sin(friction)
    return ForceLaw(
        kc=material.kc,
        mc=material.mc,
        radial=math.sin(straight) / (math.cos(helix) * below),
        along=math.tan(helix) * (math.cos(straight) - math.sin(friction)) / below,
    )


class _Rings(NamedTuple):
    """Fields of ``CutterForm``."""

    radius: FloatArray
    height: FloatArray
    span: FloatArray
    width: FloatArray
    outwards: FloatArray


def _rings(edge: Profile) -> _Rings:
    """The rings of a lower end: of its disc, and of its rounding or its cone."""
    parts = [_flat_rings(edge.flat)] if edge.flat else []
    if edge.corner:
        ends = np.linspace(0.0, 0.5 * math.pi, RINGS + 1)
        middle = 0.5 * (ends[1:] + ends[:-1])
        at, height = edge.flat + edge.corner * np.sin(middle), edge.corner * (1.0 - np.cos(ends))
        width = edge.corner * np.diff(ends)
        parts.append(_Rings(at, height[:-1], np.diff(height), width, np.sin(middle)))
    elif edge.radius > edge.flat:
        ends = np.linspace(edge.flat, edge.radius, RINGS + 1)
        slant, height = math.hypot(1.0, edge.slope), edge.slope * (ends - edge.flat)
        outwards = np.full(RINGS, edge.slope / slant)
        at, width = 0.5 * (ends[1:] + ends[:-1]), slant * np.diff(ends)
        parts.append(_Rings(at, height[:-1], np.diff(height), width, outwards))
    return _Rings(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


def _flat_rings(radius: float) -> _Rings:
    ends, nothing = np.linspace(0.0, radius, RINGS + 1), np.zeros(RINGS)
    return _Rings(0.5 * (ends[1:] + ends[:-1]), nothing, nothing, np.diff(ends), nothing)
