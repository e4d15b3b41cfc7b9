"""CYCL DEF: which cycles there are, what each is given, and what it does."""

import re
from collections.abc import Callable, Mapping
from typing import NamedTuple

from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.cycle_values import Parameters
from twin.nc.dialects.heidenhain.cycles import (
    holes,
    patterns,
    planes,
    pockets,
    step_cycles,
    threads,
)
from twin.nc.dialects.heidenhain.cycles import transformations as frames
from twin.nc.dialects.heidenhain.cycles.parameters import take_parameters
from twin.nc.dialects.heidenhain.cycles.transformations import Step
from twin.nc.dialects.heidenhain.memory import memory_of
from twin.nc.text.blocks import Statement, Word

Perform = Callable[[Control, Parameters], None]

_NUMBER = re.compile(r"[ \t]*([0-9]{1,3})(?:[ \t]*\.[ \t]*([0-9]{1,2}))?(?![0-9])[ \t]*")
_NAME = re.compile(r"[ \t]*[^Q=~]*")
_TEXT_OF_NAME = re.compile(r"[^=;]*?(?=\bQ[0-9]{3}[ \t]*=|~|$)")

MEANINGS: Mapping[int, str] = {
    200: "set-up clearance",
    201: "depth",
    202: "plunging depth",
    203: "surface",
    204: "second set-up clearance",
    205: "least plunging depth",
    206: "feed of plunging",
    207: "feed of milling",
    208: "feed of retracting",
    210: "seconds above",
    211: "seconds at the bottom",
    212: "decrement",
    213: "breaks of the chip",
    214: "way off the wall",
    215: "operation",
    216: "centre of the first axis",
    217: "centre of the second axis",
    218: "first side",
    219: "second side",
    220: "corner",
    222: "diameter of the blank",
    223: "diameter",
    224: "angle",
    225: "start of the first axis",
    226: "start of the second axis",
    237: "distance of columns",
    238: "distance of lines",
    239: "pitch",
    241: "number of places",
    242: "columns",
    243: "lines",
    244: "diameter of the circle",
    245: "first angle",
    246: "last angle",
    247: "step of the angle",
    248: "angle of a slot",
    249: "depth of the counterbore",
    250: "thickness of the part",
    251: "how far the tooth reaches beyond the shank",
    252: "height of the tooth above the tip",
    253: "feed of positioning",
    254: "feed of countersinking or back boring",
    255: "seconds in the counterbore",
    256: "lift that breaks the chip",
    257: "depth that breaks the chip",
    258: "upper advanced stop",
    259: "lower advanced stop",
    301: "height between places",
    334: "pitch of the helix",
    335: "diameter",
    336: "angle of the spindle",
    338: "infeed of finishing",
    339: "preset",
    342: "diameter that is drilled",
    343: "depth or diameter",
    344: "diameter of the countersink",
    351: "climb or up-cut",
    355: "threads per step",
    356: "depth of the hole or of countersinking",
    357: "clearance beside",
    358: "depth at the front",
    359: "offset at the front",
    360: "countersunk before or after",
    365: "way between places",
    366: "way of plunging",
    367: "place of the call",
    368: "stock at the side",
    369: "stock at the floor",
    370: "overlap",
    374: "angle",
    375: "diameter of the pitch circle",
    376: "first angle",
    377: "number of slots",
    378: "angle from slot to slot",
    379: "deepened start",
    385: "feed of finishing",
    395: "reference of the depth",
    401: "feed factor",
    403: "factor of retracting",
    424: "first side of the blank",
    425: "second side of the blank",
    426: "direction of the spindle",
    427: "speed of entering",
    428: "speed of drilling",
    429: "coolant on",
    430: "coolant off",
    435: "depth of dwelling",
    437: "place of approach",
    438: "residual material",
    439: "reference of the feed",
    512: "feed of approach",
}
"""What the parameters of cycles are."""


class Definition(NamedTuple):
    """One cycle.

    Attributes:
        meaning: For people.
        perform: What it does: where it is called, or where it is defined.
        needed: Parameters that must be there.
        others: Further ones.
        acts: It acts where it is defined, and is not called.
        only: Parameters of which only one value is followed.
    """

    meaning: str
    perform: Perform
    needed: tuple[int, ...]
    others: tuple[int, ...] = ()
    acts: bool = False
    only: Mapping[int, float] = {}


_POCKET = (201, 202, 203, 200, 206, 207)
_POCKET_TOO = (204, 215, 351, 366, 367, 368, 369, 338, 370, 385, 439, 224, 220)
_STUD_TOO = (204, 215, 351, 367, 368, 369, 338, 370, 385, 437, 224, 220, 376, 439)

DEFINITIONS: Mapping[int, Definition] = {
    200: Definition(
        "drilling", holes.drilling, (200, 201, 206, 202, 203), (204, 210, 211, 395), only={395: 0}
    ),
    201: Definition("reaming", holes.reaming, (200, 201, 206, 208, 203), (204, 211)),
    202: Definition("boring", holes.boring, (200, 201, 206, 208, 203), (204, 211, 214, 336)),
    203: Definition(
        "universal drilling",
        holes.universal_drilling,
        (200, 201, 206, 202, 203),
        (204, 205, 208, 210, 211, 212, 213, 256, 395),
        only={395: 0},
    ),
    204: Definition(
        "back boring",
        holes.back_boring,
        (200, 249, 250, 251, 252, 253, 254, 203, 214),
        (204, 255, 336),
    ),
    205: Definition(
        "universal pecking",
        holes.universal_pecking,
        (200, 201, 206, 202, 203),
        (204, 205, 208, 211, 212, 253, 256, 257, 258, 259, 379, 395),
        only={395: 0},
    ),
    206: Definition(
        "tapping with a floating chuck", holes.tapping, (200, 201, 206, 203), (204, 211)
    ),
    207: Definition("rigid tapping", holes.rigid_tapping, (200, 201, 239, 203), (204,)),
    208: Definition(
        "bore milling",
        threads.bore_milling,
        (200, 201, 206, 334, 203, 335),
        (204, 342, 351, 370),
        only={370: 0},
    ),
    209: Definition(
        "tapping with chip breaking",
        holes.tapping_with_breaks,
        (200, 201, 239, 203, 257),
        (204, 256, 336, 403),
    ),
    220: Definition(
        "pattern on a circle",
        patterns.polar_pattern,
        (216, 217, 244, 245, 246, 247, 241),
        (200, 203, 204, 301, 365),
        acts=True,
    ),
    221: Definition(
        "pattern of lines",
        patterns.linear_pattern,
        (225, 226, 237, 238, 242, 243),
        (224, 200, 203, 204, 301),
        acts=True,
    ),
    240: Definition(
        "centring", holes.centring, (200, 201, 206, 203), (204, 211, 343, 344, 342, 253)
    ),
    241: Definition(
        "single-lip deep-hole drilling",
        holes.single_lip_drilling,
        (200, 201, 206, 203, 253, 208),
        (204, 211, 379, 426, 427, 428, 429, 430, 435, 401, 202, 212, 205, 258, 259, 395),
    ),
    251: Definition(
        "rectangular pocket", pockets.rectangular_pocket, (218, 219, *_POCKET), _POCKET_TOO
    ),
    252: Definition("circular pocket", pockets.circular_pocket, (223, *_POCKET), _POCKET_TOO),
    253: Definition("slot", pockets.slot, (218, 219, *_POCKET), (*_POCKET_TOO, 374)),
    254: Definition(
        "curved slots",
        pockets.curved_slot,
        (219, 375, 376, 248, *_POCKET),
        (*_POCKET_TOO, 216, 217, 377, 378),
    ),
    256: Definition(
        "rectangular stud", pockets.rectangular_stud, (218, 424, 219, 425, *_POCKET), _STUD_TOO
    ),
    257: Definition("circular stud", pockets.circular_stud, (223, 222, *_POCKET), _STUD_TOO),
    262: Definition(
        "thread milling",
        threads.thread_milling,
        (335, 239, 201, 200, 203, 207),
        (204, 253, 351, 355, 512),
    ),
    263: Definition(
        "thread milling and countersinking",
        threads.thread_milling_and_countersinking,
        (335, 239, 201, 356, 200, 203, 207),
        (204, 253, 254, 351, 357, 358, 359, 512),
    ),
    264: Definition(
        "thread drilling and milling",
        threads.thread_drilling_and_milling,
        (335, 239, 201, 356, 202, 200, 203, 206, 207),
        (204, 253, 256, 257, 258, 351, 358, 359, 512),
    ),
    265: Definition(
        "helical thread drilling and milling",
        threads.helical_thread_drilling,
        (335, 239, 201, 200, 203, 207),
        (204, 253, 254, 358, 359, 360),
    ),
    267: Definition(
        "outside thread milling",
        threads.outside_thread_milling,
        (335, 239, 201, 200, 203, 207),
        (204, 253, 254, 351, 355, 357, 358, 359, 512),
    ),
}
"""Cycles with Q parameters."""

STEPS: Mapping[int, Callable[[Control, Step], None]] = {
    7: frames.shift_datum,
    8: frames.mirror,
    9: frames.dwell,
    10: frames.rotate,
    11: frames.scale,
    13: frames.orient_spindle,
    19: planes.define_plane,
    32: frames.set_tolerance,
    **dict.fromkeys((1, 2, 4, 5), step_cycles.take),
}
"""Cycles that are defined in steps, such as 7.1."""

REFUSED: Mapping[int, str] = {
    3: "slot milling of old controls: write CYCL DEF 253",
    12: "a program as a cycle: write CALL PGM",
    **dict.fromkeys(
        (14, 20, 21, 22, 23, 24, 25, 270, 271, 272, 273, 274), "contours of subprograms (SL, OCM)"
    ),
    17: "tapping of old controls: write CYCL DEF 207",
    18: "thread cutting",
    26: "a scale of its own for each axis: write CYCL DEF 11",
    **dict.fromkeys((27, 28, 29, 39), "the surface of a cylinder"),
    **dict.fromkeys(
        (210, 211, 212, 213, 214, 215), "an older pocket, slot or stud: write CYCL DEF 251 to 257"
    ),
    **dict.fromkeys((224, 225), "engraving"),
    **dict.fromkeys((230, 231, 232, 233), "face milling"),
    **dict.fromkeys((238, 239), "the state of the machine and the load of its table"),
    258: "a stud of many sides",
    **dict.fromkeys((275, 276, 277), "trochoidal milling and contours"),
    **dict.fromkeys((290, 291, 292, 880), "turning and gears"),
}
"""Cycles that the control knows and the twin does not follow."""


def define(control: Control, statement: Statement) -> None:
    """CYCL DEF: a step of a cycle in steps, or a cycle with its parameters."""
    match = _NUMBER.match(statement.text)
    if match is None:
        control.fail(
            "unreadable-statement",
            "CYCL DEF needs the number of a cycle",
            statement,
            "CYCL DEF 200 DRILLING ~",
        )
    number, text = int(match[1]), statement.text[match.end() :]
    column = statement.text_column + match.end()
    if number in REFUSED:
        message = f"cycle {number} is not followed: {REFUSED[number]}"
        control.report.fail("unsupported-cycle", message, statement.text_column, match.end())
    if number in STEPS:
        step = 0 if match[2] is None else int(match[2])
        STEPS[number](control, Step(number, step, text.rstrip("~ \t"), column))
        return
    definition = DEFINITIONS.get(number)
    if number != 247 and definition is None:
        near = sorted({*STEPS, *DEFINITIONS, 247}, key=lambda each: abs(each - number))[:5]
        known = ", ".join(map(str, sorted(near)))
        message = f"there is no cycle {number}"
        control.report.fail(
            "unsupported-cycle",
            message,
            statement.text_column,
            match.end(),
            f"cycles near it: {known}; all of them: twin dialects heidenhain",
        )
    _define_with_parameters(control, statement, number, match.end(), definition)


def _define_with_parameters(
    control: Control, statement: Statement, number: int, at: int, definition: Definition | None
) -> None:
    known = (339,) if definition is None else (*definition.needed, *definition.others)
    name = f"cycle {number}"
    given = take_parameters(control, statement, name, {each: MEANINGS[each] for each in known})
    needed = known if definition is None else definition.needed
    missing = [f"Q{each} ({MEANINGS[each]})" for each in needed if each not in given.values]
    if missing:
        control.fail("cycle-word", f"{name} needs {', '.join(missing)}", statement)
    if definition is None:
        word = Word("Q339=", given.number(339), statement.text_column, at)
        frames.select_preset(control, given.number(339), word)
        return
    for parameter, value in definition.only.items():
        if given.number(parameter, value) != value:
            message = (
                f"{name} is followed with Q{parameter}={value:g} alone ({MEANINGS[parameter]})"
            )
            control.fail("cycle-word", message, statement)
    if definition.acts:
        definition.perform(control, given)
        return
    memory = memory_of(control)
    memory.cycle, memory.parameters, memory.calls_always = definition.perform, given, False
