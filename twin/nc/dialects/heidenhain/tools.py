"""Tools and the blank: TOOL CALL, TOOL DEF, BLK FORM."""

import re

from twin.nc.control.compensation import NEEDS_TOOL, tool_named, tool_numbered
from twin.nc.control.control import Control, integer_of
from twin.nc.control.settings import ToolData
from twin.nc.dialects.heidenhain.feeds import set_feed
from twin.nc.dialects.heidenhain.memory import Deltas, memory_of
from twin.nc.dialects.heidenhain.values import computed_words, named_word, text_of, word_of
from twin.nc.functions import BLANK
from twin.nc.iso.base import next_tool, set_spindle_speed
from twin.nc.iso.tool_change import change_tool_at
from twin.nc.iso.tool_compensation import set_length
from twin.nc.text.blocks import Statement, Word

_HEAD = re.compile(
    r'[ \t]*(?:(?P<name>"[^"]*"|QS[0-9]+)|(?P<number>[-+.0-9]+|Q[LR]?[0-9]+))?[ \t]*(?P<axis>[XYZUVW](?=[ \t]|$))?',
    re.IGNORECASE,
)
"""What is behind TOOL CALL and TOOL DEF: name or number, and the axis of the tool."""
_CHANGE = change_tool_at(0.0)
"""Decision: the macro that the machine's builder has put behind TOOL CALL lifts the tool to machine zero."""
_CORNER = re.compile(
    r"[ \t]*(?:0\.([12])[ \t]*([XYZ](?=[ \t]))?|(CYLINDER)[ \t]+([XYZ])(?=[ \t])|(ROTATION|FILE))",
    re.IGNORECASE,
)


def call_tool(control: Control, statement: Statement) -> None:
    """TOOL CALL: the tool comes into the spindle, with its length, S, F, DL and DR; without a tool S and F alone."""
    match = _HEAD.match(statement.text)
    assert match is not None
    if match["axis"] and match["axis"].upper() != "Z":
        message = f"the tool lies along Z on this machine, not along {match['axis'].upper()}"
        control.fail("unsupported-word", message, statement, "TOOL CALL 1 Z S3000")
    words = computed_words(control, statement, match.end())
    number = _number_of(control, statement, match)
    if number is None and not words and not match["axis"]:
        message = "TOOL CALL names no tool, no speed and no feed"
        control.fail("tool-number", message, statement, "TOOL CALL 1 Z S3000")
    speed, feed = words.pop("S", None), words.pop("F", None)
    lengths = {name: control.length(words.pop(name, None)) for name in ("DL", "DR", "DR2")}
    if words:
        word = next(iter(words.values()))
        control.fail("unused-word", f"nothing in TOOL CALL uses '{word.text}'", word)
    if lengths["DR2"] != 0.0:
        message = "DR2 changes the corner of the tool, which the twin does not follow"
        control.fail("unsupported-word", message, statement)
    if number is not None:
        _change(control, number)
    if number is not None or lengths["DL"] or lengths["DR"]:
        memory_of(control).deltas = Deltas(lengths["DR"], lengths["DL"])
        _put_length(control)
    if speed is not None:
        control.function("S", {"S": set_spindle_speed(control, speed)})
    memory_of(control).tool_feed = None
    if feed is not None:
        set_feed(control, feed)
        memory_of(control).tool_feed = control.motion.feed


def _number_of(control: Control, statement: Statement, match: re.Match[str]) -> Word | None:
    """The number of the tool that TOOL CALL brings; None: it brings none."""
    if match["name"]:
        word = named_word(statement, 0.0, match.span("name"))
        number = tool_named(control, text_of(control, match["name"]), word)
        return word._replace(value=float(number))
    if not match["number"]:
        return None
    return word_of(control, statement, match.span("number"))


def _change(control: Control, number: Word) -> None:
    """The tool goes into the spindle, which is stopped."""
    index = integer_of(control.number(number))
    defined = memory_of(control).defined.get(index)
    if index != 0 and (control.tools.any is None or defined is None):
        tool_numbered(control, number)
    if defined is None:
        next_tool(control, number)
    else:
        control.tools.selected = index
        control.function(f"T{index}", {"R": defined.radius})
    if index != control.tools.spindle:
        _CHANGE(control)
    control.function("M6", {})
    control.motion.spindle_turns = False


def _put_length(control: Control) -> None:
    """The length of the tool in the spindle counts, with DL."""
    tool, number = control.tools.data(control.tools.spindle), control.tools.spindle
    control.tools.length_call = number
    length_difference = (
        0.0 if tool is None or number == 0 else control.tools.length_difference(tool)
    )
    set_length(control, length_difference + memory_of(control).deltas.length)


def define_tool(control: Control, statement: Statement) -> None:
    """TOOL DEF: the tool that comes next; with L and R its data, of which R counts where the job lists no tools."""
    match = _HEAD.match(statement.text)
    assert match is not None
    number = _number_of(control, statement, match)
    if number is None:
        control.fail("tool-number", "TOOL DEF needs a tool", statement, "TOOL DEF 1 L+0 R+5")
    words = computed_words(control, statement, match.end())
    length, radius = words.pop("L", None), words.pop("R", None)
    if words:
        word = next(iter(words.values()))
        control.fail("unused-word", f"nothing in TOOL DEF uses '{word.text}'", word)
    if radius is not None:
        data = ToolData(control.length(radius), control.length(length))
        if data.radius < 0.0:
            control.fail("compensation-radius", f"a tool cannot have {radius.text}", radius)
        memory_of(control).defined[integer_of(control.number(number))] = data


def compensation_radius(control: Control) -> float:
    """Radius of the tool in the spindle with DR [mm].

    Decision: where the job lists no tools that of TOOL DEF counts.
    """
    memory, number = memory_of(control), control.tools.spindle
    tool = control.tools.data(number)
    if control.tools.any is not None and number in memory.defined:
        tool = memory.defined[number]
    if tool is None or number == 0:
        message = "radius compensation needs a tool, and none is in the spindle"
        control.fail("no-such-tool", message, hint=NEEDS_TOOL)
    return tool.radius + memory.deltas.radius


# --- the blank


def blank(control: Control, statement: Statement) -> None:
    """BLK FORM: the blank, reported for who looks for the stock of a program; nothing moves by it."""
    match = _CORNER.match(statement.text)
    if match is None:
        hint = "BLK FORM 0.1 Z X+0 Y+0 Z-40, then BLK FORM 0.2 X+100 Y+100 Z+0"
        control.fail("unreadable-statement", "BLK FORM is 0.1, 0.2 or CYLINDER", statement, hint)
    if match[5]:
        message = f"BLK FORM {match[5].upper()} gives the twin no stock: the job does"
        control.report.notice("BLK FORM", message, statement.column, len(statement.keyword))
        return
    words = computed_words(control, statement, match.end())
    if match[3]:
        _cylinder(control, statement, words)
        return
    memory, corner = memory_of(control), []
    for index, name in enumerate("XYZ"):
        word = words.pop(name, None)
        if word is None:
            message = "BLK FORM 0.1 and 0.2 each need X, Y and Z"
            hint = "BLK FORM 0.1 Z X+0 Y+0 Z-20, and BLK FORM 0.2 X+100 Y+60 Z+0 below"
            control.fail("unreadable-statement", message, statement, hint)
        base = memory.blank[index] if memory.blank is not None and word.incremental else 0.0
        corner.append(control.length(word) + base)
    if match[1] == "1":
        memory.blank = corner
    elif memory.blank is None:
        control.fail("unreadable-statement", "BLK FORM 0.1 must stand before 0.2", statement)
    else:
        sides = zip("XYZ", memory.blank, corner, strict=True)
        values = {
            f"{name}{side}": value
            for name, *ends in sides
            for side, value in zip((1, 2), ends, strict=True)
        }
        control.function(BLANK, values)


def _cylinder(control: Control, statement: Statement, words: dict[str, Word]) -> None:
    """BLK FORM CYLINDER: R or D, L and DIST, of its top above the datum."""
    radius, diameter = words.pop("R", None), words.pop("D", None)
    length, top = words.pop("L", None), words.pop("DIST", None)
    words.pop("RI", None)
    if (radius is None) == (diameter is None) or length is None:
        message = "BLK FORM CYLINDER needs R or D, and L"
        control.fail(
            "unreadable-statement", message, statement, "BLK FORM CYLINDER Z R50 L40 DIST+0"
        )
    across = 2.0 * control.length(radius) + control.length(diameter)
    control.function(BLANK, {"D": across, "L": control.length(length), "Z2": control.length(top)})
