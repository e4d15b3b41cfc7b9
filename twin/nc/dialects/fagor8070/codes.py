"""G codes of the Fagor CNC 8070."""

from collections.abc import Mapping
from typing import Unpack

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import Assembler, UnsupportedError
from twin.nc.canonical import Corner
from twin.nc.control.block_words import BlockWords
from twin.nc.control.codes import Action, Compiler, GCode, Interpolation
from twin.nc.control.control import Control
from twin.nc.control.modal import FeedMode, ModalChanges
from twin.nc.dialects.fagor8070 import arcs, corners, frames, polar, transformations
from twin.nc.dialects.fagor8070.cycles.canned_cycles import CYCLES
from twin.nc.dialects.fagor8070.machine_coordinates import refuse_change
from twin.nc.dialects.fagor8070.memory import memory_of
from twin.nc.dialects.fagor8070.offset_table import compile_offset, offset_code
from twin.nc.geometry.planes import XY, YZ, ZX, Plane
from twin.nc.iso import base, fixed_cycles, offsets, tool_compensation
from twin.nc.iso.tool_compensation import compile_compensation_by_tool, compile_end_of_compensation
from twin.nc.text.blocks import Word


def dwell(control: Control) -> None:
    """G04 K: wait its seconds."""
    word = control.take("K")
    if word is None or control.number(word) < 0.0:
        control.fail("dwell", "G04 needs its seconds", word, hint="write G04 K1.5 or G04 1.5")
    control.dwell(control.number(word))


def compile_plain_dwell(block: BlockWords, assembler: Assembler) -> None:
    """G04 1.5, for the compiled tier.

    Raises:
        UnsupportedError: It does not stand alone.
    """
    word = block.words.pop("G04")
    if block.words or block.codes or block.functions:
        raise UnsupportedError
    assembler.word_value(word)
    assembler.emit(opcodes.DWELL)


def plain_dwell(control: Control, word: Word) -> None:
    """G04 1.5: the seconds stand right behind the code."""
    if control.words or len(control.block.words) > 1:
        control.fail("dwell", "G04 must stand alone in its block", word)
    control.dwell(control.number(word))


def auxiliary(control: Control, word: Word) -> None:
    """H: an auxiliary function of the machine."""
    control.function(f"H{control.number(word):g}", {})


def compile_auxiliary(block: BlockWords, assembler: Assembler) -> None:
    """H, for the compiled tier."""
    assembler.word_value(block.words.pop("H"))
    assembler.emit(opcodes.AUXILIARY)


def _compensate(side: float) -> Action:
    def action(control: Control) -> None:
        tool = control.tools.data(control.tools.spindle)
        if tool is None:
            control.fail(
                "no-such-tool",
                "compensation needs a tool, and the job has none",
                None,
                tool_compensation.NO_TOOL,
            )
        tool_compensation.compensate(
            control, side, tool.radius if memory_of(control).offset_on else 0.0
        )

    return action


def forget_polar_values(action: Action | None) -> Action:
    """Work offsets and presets: the last R and Q no longer hold."""

    def both(control: Control) -> None:
        refuse_change(control)
        if action is not None:
            action(control)
        polar.forget_polar(control)

    return both


def _and_forget_polar(compiler: Compiler | None) -> Compiler:
    assert compiler is not None

    def both(block: BlockWords, assembler: Assembler) -> None:
        compiler(block, assembler)
        assembler.emit(opcodes.FORGET_POLAR)

    return both


def _g(meaning: str, group: str = "", **sets: Unpack[ModalChanges]) -> GCode:
    return GCode(meaning=meaning, group=group, sets=sets, ground="manual")


def _motion(meaning: str, interpolation: Interpolation, *, seed: bool = False) -> GCode:
    return GCode(
        meaning=meaning,
        group="motion",
        sets={"interpolation": interpolation, "cycle": None},
        ground="seed" if seed else "manual",
    )


def _once(meaning: str, **sets: Unpack[ModalChanges]) -> GCode:
    return GCode(meaning=meaning, sets=sets, once=True, ground="manual")


def _plane(meaning: str, plane: Plane) -> GCode:
    return GCode(
        meaning=meaning,
        group="plane",
        sets={"plane": plane},
        action=frames.change_plane,
        compiler=base.compile_plane(plane),
        ground="seed",
    )


def _do(
    meaning: str,
    action: Action,
    *,
    group: str = "",
    takes: str = "",
    compiler: Compiler | None = None,
) -> GCode:
    if takes:
        return GCode(
            meaning=meaning,
            group=group,
            perform=action,
            takes=takes,
            compiler=compiler,
            ground="manual",
        )
    return GCode(meaning=meaning, group=group, action=action, compiler=compiler, ground="manual")


def _decided(meaning: str, action: Action, *, compiler: Compiler | None = None) -> GCode:
    return GCode(meaning=meaning, perform=action, compiler=compiler)


def _refused(meaning: str, reason: str, numbers: Mapping[int, None] | range) -> dict[int, GCode]:
    code = GCode(meaning=meaning, refused=reason, ground="manual")
    return dict.fromkeys(numbers, code)


def _passed_over(number: int, meaning: str, letters: str) -> GCode:
    """A code whose words change nothing of the path here."""

    def perform(control: Control) -> None:
        word = control.code_word(number)
        assert word is not None
        for letter in letters:
            control.take(letter)
        message = f"{word.text} does not change the path here: {meaning}"
        control.report.notice(word.text, message, word.column, word.width)

    return GCode(meaning=meaning, perform=perform, takes=letters, ground="manual")


_PROBE = "the twin has no probe to touch with"
_LEAD = "where its arc begins is not documented well enough; write the lead as an arc"
_LIMITS = "the limits are the machine file's"
_UNKNOWN = "its effect on the path is not documented well enough to be followed"

INSTEAD: dict[float, str] = {
    21: "millimetres are G71",
    28: "write G53 G00 and the axes",
    43: "D1 brings the tool's length",
    49: "D0 ends the tool's length",
    64: "G05 rounds corners, G50 keeps to the path",
    68: "a rotation is G73 Q",
    69: "a rotation ends by G73 alone",
}
"""Codes of other controls, and what this one has for them."""

CODES: dict[float, GCode] = {
    0: _motion("rapid positioning", arcs.RAPID),
    1: _motion("straight line", arcs.FEED),
    2: _motion("arc clockwise, Cartesian or polar", arcs.CLOCKWISE, seed=True),
    3: _motion("arc counter-clockwise, Cartesian or polar", arcs.COUNTER_CLOCKWISE, seed=True),
    4: GCode(
        meaning="dwell, seconds in K or right behind",
        perform=dwell,
        compiler=base.compile_dwell("K"),
        ground="manual",
    ),
    5: _g("round corner", "corner", corner=Corner.CONTINUOUS),
    6: _once("centre in absolute coordinates, this block", center_absolute=True),
    7: _g("square corner", "corner", corner=Corner.EXACT_STOP),
    8: _once("arc tangent to the last move, this block", interpolation=arcs.TANGENT, cycle=None),
    9: _once("arc through the point I J, this block", interpolation=arcs.THREE_POINTS, cycle=None),
    10: _do(
        "mirror off",
        transformations.mirror_off,
        compiler=transformations.compile_mirror_off,
    ),
    11: _do("mirror X", transformations.mirror_x, compiler=transformations.compile_mirror(0)),
    12: _do("mirror Y", transformations.mirror_y, compiler=transformations.compile_mirror(1)),
    13: _do("mirror Z", transformations.mirror_z, compiler=transformations.compile_mirror(2)),
    14: _decided(
        "mirror the given axes: X-1",
        transformations.mirror_axes,
        compiler=transformations.compile_mirror_axes,
    ),
    17: _plane("plane X Y", XY),
    18: _plane("plane Z X", ZX),
    19: _plane("plane Y Z", YZ),
    20: GCode(meaning="any plane: X1 Z2", group="plane", action=frames.any_plane, ground="manual"),
    30: _do(
        "polar origin: I J, or where the tool stands",
        polar.set_polar_origin,
        compiler=polar.compile_polar_origin,
    ),
    31: _do("temporary polar origin at the arc's centre", polar.temporary_polar_origin),
    33: GCode(meaning="threading", refused="the twin's spindle has no angle", ground="manual"),
    36: _decided("corner rounded by the radius I", corners.round_corner),
    **_refused("tangential entry, tangential exit", _LEAD, range(37, 39)),
    39: _decided("corner chamfered at the distance I", corners.chamfer_corner),
    40: _do(
        "radius compensation off",
        tool_compensation.end_compensation,
        group="compensation",
        compiler=compile_end_of_compensation,
    ),
    41: _do(
        "compensation, tool left",
        _compensate(tool_compensation.LEFT),
        group="compensation",
        compiler=compile_compensation_by_tool(tool_compensation.LEFT),
    ),
    42: _do(
        "compensation, tool right",
        _compensate(tool_compensation.RIGHT),
        group="compensation",
        compiler=compile_compensation_by_tool(tool_compensation.RIGHT),
    ),
    **_refused("tangential control", "the twin has no axis that turns the tool", range(45, 46)),
    50: _g("semi-rounded corner", "corner", corner=Corner.EXACT_PATH),
    51: _passed_over(51, "look-ahead of the CNC 8055: tolerance E and angle A", "AE"),
    53: _do("offsets cancelled", forget_polar_values(offsets.cancel_offset), group="offset"),
    **{
        number: _do(
            f"work offset G{number} of the job",
            forget_polar_values(offset_code(number)),
            group="offset",
            compiler=_and_forget_polar(compile_offset(number)),
        )
        for number in range(54, 60)
    },
    60: _once("square corner, this block", corner=Corner.EXACT_STOP),
    61: _once("round corner, this block", corner=Corner.CONTINUOUS),
    63: GCode(meaning="rigid tapping", refused="the twin's spindle has no angle", ground="manual"),
    70: _g("inches", "units", unit=25.4),
    71: _g("millimetres", "units", unit=1.0),
    72: _do(
        "scale S, about part zero",
        transformations.scale,
        takes="S",
        compiler=transformations.compile_scale,
    ),
    73: GCode(
        meaning="rotation by Q about I J; alone: off",
        perform=transformations.rotate,
        compiler=transformations.compile_rotation,
        ground="manual",
    ),
    74: GCode(meaning="home search", refused="the twin starts homed", ground="manual"),
    **CYCLES,
    90: _g("absolute coordinates", "distance", incremental=False),
    91: _g("incremental coordinates", "distance", incremental=True),
    92: GCode(
        meaning="preset part zero",
        perform=forget_polar_values(offsets.preset),
        compiler=_and_forget_polar(offsets.compile_set_position("preset")),
        ground="manual",
    ),
    93: GCode(
        meaning="feed as seconds of the block",
        group="feed",
        sets={"feed_mode": FeedMode.SECONDS_PER_BLOCK},
        action=polar.refuse_origin_by_g93,
        ground="manual",
    ),
    94: _g("feed per minute", "feed", feed_mode=FeedMode.PER_MINUTE),
    95: _g("feed per revolution", "feed", feed_mode=FeedMode.PER_REVOLUTION),
    96: GCode(
        meaning="constant cutting speed", refused="a mill's radius is the tool's", ground="manual"
    ),
    97: _g("constant spindle speed", "spindle"),
    **fixed_cycles.RETURN,
    **_refused("probing", _PROBE, range(100, 105)),
    108: _g("feed blending at the start of the block", "feed blending"),
    109: _g("feed blending at the end of the block", "feed blending"),
    **_refused("change of the parameter set", _UNKNOWN, range(112, 113)),
    **_refused("acceleration and jerk", _LIMITS, range(130, 136)),
    136: _g("compensation rounds outside corners", "compensation corners", square_corners=False),
    137: _g("compensation extends outside corners", "compensation corners", square_corners=True),
    138: _g("leads of compensation go straight", "compensation leads", indirect_leads=False),
    139: GCode(
        meaning="leads of compensation go around the contour's ends",
        group="compensation leads",
        sets={"indirect_leads": True},
    ),
    151: GCode(meaning="programming in diameters", refused="a mill has none", ground="manual"),
    152: _g("programming in radii", "diameters"),
    157: GCode(meaning="axes without offset", refused=_UNKNOWN, ground="manual"),
    158: GCode(
        meaning="incremental offset",
        perform=frames.incremental_offset,
        compiler=frames.compile_increment,
        ground="manual",
    ),
    **_refused("multiple machining", "write the positions one by one", range(160, 166)),
    **_refused("Hirth axes", _UNKNOWN, range(170, 172)),
    174: GCode(meaning="set the machine coordinate", refused=_UNKNOWN, ground="manual"),
    **_refused("subroutines of the machine's builder", "they are not known", range(180, 190)),
    193: _g("feed interpolation", "feed blending"),
    **_refused("spindle limit", _LIMITS, range(192, 193)),
    196: GCode(meaning="constant feed of the cutting point", refused=_UNKNOWN, ground="manual"),
    197: _g("constant feed of the tool's centre", "feed point"),
    **_refused("axis limits", _LIMITS, range(198, 200)),
    **_refused("manual intervention", "nobody stands at the twin", range(200, 203)),
    **_refused("circular probing", _PROBE, range(210, 213)),
    261: _g("centre in absolute coordinates", "centre", center_absolute=True),
    262: _g("centre relative to the start", "centre", center_absolute=False),
    264: _g("arc centre not corrected", "centre correction", correct_center=False),
    265: _g("arc centre corrected", "centre correction", correct_center=True),
    500: _passed_over(500, "high-speed machining off", ""),
    501: _passed_over(501, "high-speed machining on: tolerance, acceleration, frequency", "AEJM"),
    266: GCode(meaning="feed override at 100 %", refused=_UNKNOWN, ground="manual"),
}
