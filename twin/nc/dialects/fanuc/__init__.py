"""Fanuc 0i-MF and 30i, milling, and the Haas mills, whose language is much the same."""

from twin.nc.control.codes import WordEffect
from twin.nc.control.control import Control
from twin.nc.control.dialect import Dialect
from twin.nc.dialects.fanuc import (
    block_compiler,
    codes,
    corners,
    decimal_point,
    flow,
    macro_calls,
    offsets,
    programs,
    tool_offsets,
    variables,
)
from twin.nc.dialects.fanuc.decisions import DECISIONS
from twin.nc.dialects.fanuc.memory import FANUC as FANUC_VARIANT
from twin.nc.dialects.fanuc.memory import FanucMemory, acts_on_plain_blocks, memory_of
from twin.nc.iso import base
from twin.nc.text.syntax import HEADING, Comment, Mark, Syntax


def prepare(control: Control) -> None:
    """Look over the program before it runs."""
    memory, lines = memory_of(control), control.program_counter.lines
    programs.begin(control)
    memory.writes_offsets = lines.any_holds(offsets.WRITES_OFFSETS)
    memory.bare_compensation = lines.any_holds(tool_offsets.BARE_COMPENSATION)
    offsets.put_into_force(control)
    corners.prepare(control)


def after_motion(control: Control) -> None:
    """A block has moved."""
    corners.blend_after_motion(control)
    macro_calls.call_after_motion(control)


FANUC = Dialect(
    name="fanuc",
    title="Fanuc 0i-MF, 30i (milling)",
    code_page="cp1252",
    syntax=Syntax(
        address=r",[CR]|[A-Z]",
        comments=(Comment("(", ")"), HEADING),
        skip_levels=True,
        block_end=";",
        expressions=variables.EXPRESSIONS,
        statement=flow.PATTERN,
        assigned="#",
        open_assignments=True,
        inner_comments=True,
    ),
    groups=codes.GROUPS,
    g=codes.codes(FANUC_VARIANT),
    instead=codes.INSTEAD,
    start=codes.START,
    m=codes.M_CODES,
    words={
        "O": programs.heading,
        "F": base.set_feed,
        "S": WordEffect(base.spindle_speed),
        "T": WordEffect(base.next_tool),
        "H": tool_offsets.set_length_number,
        "D": tool_offsets.set_radius_number,
    },
    words_first=True,
    word_meanings={
        "O": "number of the program",
        "N": "block number",
        "G": "preparatory code",
        **dict.fromkeys("XYZABCUVW", "axis"),
        "I": "centre along X, from the start of the arc; scale of X",
        "J": "centre along Y; scale of Y",
        "K": "centre along Z; scale of Z; holes that a cycle's block drills",
        ",R": "radius that rounds the corner at the block's end",
        ",C": "chamfer of the corner at the block's end",
        "R": "radius of the arc, negative: the larger of the two; plane where a cycle's feed begins; angle of G68",
        "P": "milliseconds of a dwell; program or block; work offset of G54.1; scale of G51",
        "Q": "depth of a peck; shift of G76 and G87",
        "L": "how often a subprogram runs; kind of data of G10",
        "D": "row of the tool radius",
        "H": "row of the tool length",
        "F": "feed",
        "S": "spindle speed",
        "T": "tool",
        "M": "machine function",
    },
    units='mm, inches (G20), degrees; numbers without a point count 0.001 mm, 0.0001 inch or 0.001 degree, unless decimal_point = "calculator"; F in mm/min',
    decisions=DECISIONS,
    marks=(
        Mark(r"^[ \t]*O[ \t]*[0-9]{1,8}(?![0-9<])[ \t]*(?:$|[ (])", "O1000 (a program's number)"),
    ),
    start_state={"square_corners": True},
    memory=FanucMemory,
    prepare=prepare,
    read_variable=variables.read_variable,
    write_variable=variables.write_variable,
    is_local=variables.is_local,
    live_variables=variables.ControlVariables(),
    after_motion=after_motion,
    statements={**flow.STATEMENTS, **macro_calls.CALLS_BY_CODE},
    finish=programs.finish,
    library=programs.with_subprograms,
    compile_block=block_compiler.compile_block,
    disturbed=acts_on_plain_blocks,
    pointless=decimal_point.pointless,
    count=decimal_point.count,
)
