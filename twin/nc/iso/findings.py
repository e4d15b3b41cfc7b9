"""What is said where a check of an effect does not hold, for effects that several dialects share."""

from twin.nc.bytecode.assembler import Finding
from twin.nc.control.compensation import NEEDS_TOOL

_END_IT = "end it by G40 first"

NEGATIVE_SPEED = Finding("spindle-range", "the speed {word} is negative")
NO_TOOL_NUMBER = Finding("tool-number", "{word} is no tool number")
NEGATIVE_DWELL = Finding("dwell", "a dwell cannot be negative")
SCALE_RANGE = Finding("scale", "a scale lies between 0.001 and 1000")
NO_TOOL = Finding(
    "no-such-tool",
    "compensation needs a tool, and the job has none",
    NEEDS_TOOL,
    blames_word=False,
)
PLANE_COMPENSATED = Finding(
    "compensation-plane",
    "the plane cannot change while compensation is in force",
    _END_IT,
    blames_word=False,
)
PLANE_ROTATED = Finding(
    "rotation-active",
    "the plane cannot change while a rotation turns it",
    "end it by G73 alone",
    blames_word=False,
)
TRANSFORM_COMPENSATED = Finding(
    "compensation-change",
    "mirror, scale and rotation cannot change while compensation is in force",
    _END_IT,
    blames_word=False,
)
