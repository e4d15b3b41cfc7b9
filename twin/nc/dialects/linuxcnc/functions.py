"""M codes of LinuxCNC, and F, S, T."""

from twin.nc.control.codes import Action, MCode
from twin.nc.control.compensation import tool_numbered
from twin.nc.control.control import Control
from twin.nc.dialects.linuxcnc import compensation, saved_state
from twin.nc.dialects.linuxcnc.flow import call_program, return_from_program
from twin.nc.dialects.linuxcnc.memory import memory_of
from twin.nc.dialects.linuxcnc.offsets import lead_axes, lead_tip, refuse_in_compensation
from twin.nc.iso.declared import flow_function
from twin.nc.iso.tool_change import go_to_change_height
from twin.nc.text.blocks import Word

TIMES_OUT = (0.0, 1.0, 2.0, 3.0, 4.0)
"""How M66 waits, by L."""


def set_feed(control: Control, word: Word) -> None:
    """F: the feed; F0 is none."""
    feed = control.number(word)
    if feed < 0.0:
        message = f"the feed {word.text} is negative"
        control.fail(
            "feed-range", message, word, "the sign of the distance says the direction, F how fast"
        )
    control.motion.feed = feed or None
    memory_of(control).converted_feed = None


def select_tool(control: Control, word: Word) -> None:
    """T: the tool that comes next; T0 empties the spindle."""
    number = control.number(word)
    if number < 0.0 or number != int(number):
        control.fail("tool-number", f"{word.text} is no tool number", word)
    control.tools.selected = tool_numbered(control, word) if number else 0
    memory_of(control).prepared = True
    control.function(f"T{int(number)}", {})


def choose_spindle(control: Control, word: Word) -> None:
    """$: the number of the spindle; the twin has one."""
    if control.number(word) not in (0.0, -1.0):
        control.fail("code-words", f"{word.text}: the machine has the spindle $0 alone", word)


def change_tool(control: Control) -> None:
    """M6: the prepared tool goes into the spindle, which is stopped then."""
    refuse_in_compensation(control, "the tool cannot change")
    if not memory_of(control).prepared:
        control.fail("tool-number", "M6 needs a tool that T has prepared", hint="write T1 M6")
    go_to_change_height(control)
    memory_of(control).functions["spindle"] = 5.0
    control.motion.spindle_turns = False
    control.tools.change()


def set_tool(control: Control) -> None:
    """M61 Q: the number of the tool that is in the spindle already."""
    refuse_in_compensation(control, "the tool cannot change")
    word = control.take("Q")
    if word is None:
        control.fail("tool-number", "M61 needs Q, the number of the tool")
    control.tools.spindle = tool_numbered(control, word) if control.number(word) else 0


def _switch(name: str, value: float) -> Action:
    """Remember what an M function switches, for the parameters that tell it."""

    def action(control: Control) -> None:
        memory_of(control).functions[name] = value

    return action


def _end_coolant(control: Control) -> None:
    functions = memory_of(control).functions
    functions["mist"] = functions["flood"] = 0.0


def orient_spindle(control: Control) -> None:
    """M19 R, P, Q: the spindle's angle changes no path.

    Raises:
        ProgramError: R is no angle of one turn, P none of 0, 1 and 2, or Q not above 0.
    """
    angle = control.take("R")
    if angle is not None and not 0.0 <= control.number(angle) <= 360.0:
        message = f"{angle.text} is no angle of one turn"
        control.fail("code-words", message, angle, "0 to 360 degrees")
    turning, seconds = control.take("P"), control.take("Q")
    if turning is not None and control.number(turning) not in (0.0, 1.0, 2.0):
        message = "P of M19 is 0 (the shorter way), 1 (clockwise) or 2 (counter-clockwise)"
        control.fail("code-words", message, turning)
    if seconds is not None and control.number(seconds) <= 0.0:
        control.fail("code-words", "Q of M19, its seconds, must be above 0", seconds)


def read_input(control: Control) -> None:
    """M66 P, E, L, Q: read an input into #5399.

    Decision: inputs of the twin are 0. Reading one at once gives 0; waiting for one to be high or to
    rise runs out after Q seconds and gives -1; waiting for one to be low ends at once.
    """
    refuse_in_compensation(control, "no input can be read")
    digital, analog, kind, limit = (control.take(letter) for letter in "PELQ")
    if (digital is None) == (analog is None):
        message = "M66 reads a digital input P or an analog input E"
        control.fail("code-words", message, hint="M66 P0 L0")
    how = 0.0 if kind is None else control.number(kind)
    if how not in TIMES_OUT:
        control.fail("code-words", "L of M66 is 0 to 4", kind)
    if analog is not None and how != 0.0:
        control.fail("code-words", "an analog input E is read at once", kind, "write L0")
    seconds = 0.0 if limit is None else control.number(limit)
    if how != 0.0 and seconds <= 0.0:
        message = "M66 that waits needs Q, the seconds after which it gives up"
        control.fail("code-words", message, limit, "M66 P0 L3 Q5")
    value = 0.0
    if how in (1.0, 2.0, 3.0):
        control.dwell(seconds)
        value = -1.0
    control.variables.write("#5399", value)


def _end_early(control: Control) -> None:
    control.motion.spindle_turns = False
    memory_of(control).functions["spindle"] = 5.0


def _function(number: int, meaning: str, letters: str, *, optional: bool = False) -> MCode:
    """An output or an override, which changes no path, with its words."""

    def action(control: Control) -> None:
        refuse_in_compensation(control, "outputs and overrides cannot change")
        words = {letter: control.take(letter) for letter in letters}
        missing = [letter for letter, word in words.items() if word is None and not optional]
        if missing:
            hint = f"M{number} {' '.join(f'{letter}0' for letter in letters)}: {meaning}"
            control.fail("code-words", f"M{number} needs {' and '.join(missing)}", hint=hint)

    group = f"function {meaning}"
    return MCode(meaning=meaning, group=group, action=action, silent=True, basis="manual")


_OVERRIDES = {
    48: ("feed and speed overrides on", ""),
    49: ("feed and speed overrides off", ""),
    50: ("feed override, P1 on, P0 off", "P"),
    51: ("speed override, P1 on, P0 off", "P"),
    52: ("adaptive feed, P1 on, P0 off", "P"),
    53: ("feed hold, P1 on, P0 off", "P"),
}
_OUTPUTS = {
    62: ("output P on with the next move", "P"),
    63: ("output P off with the next move", "P"),
    64: ("output P on", "P"),
    65: ("output P off", "P"),
    67: ("analog output E set to Q with the next move", "EQ"),
    68: ("analog output E set to Q", "EQ"),
}
M_CODES = {
    **{number: _function(number, *words, optional=True) for number, words in _OVERRIDES.items()},
    **{number: _function(number, *words) for number, words in _OUTPUTS.items()},
    0: MCode(meaning="program stop", group="stop", after_motion=True, basis="manual"),
    1: MCode(meaning="optional stop", group="stop", after_motion=True, basis="manual"),
    2: MCode(meaning="end of program", group="stop", after_motion=True, ends=True,
             action=compensation.end, basis="manual"),
    3: MCode(meaning="spindle clockwise", group="spindle", action=_switch("spindle", 3.0),
             basis="manual"),
    4: MCode(meaning="spindle counter-clockwise", group="spindle",
             action=_switch("spindle", 4.0), basis="manual"),
    5: MCode(meaning="spindle stop", group="spindle", action=_end_early, basis="manual"),
    6: MCode(meaning="tool change", group="tool", action=change_tool, basis="manual"),
    7: MCode(meaning="mist on", group="mist", action=_switch("mist", 1.0), basis="manual"),
    8: MCode(meaning="coolant on", group="flood", action=_switch("flood", 1.0), basis="manual"),
    9: MCode(meaning="mist and coolant off", group="coolant", action=_end_coolant,
             basis="manual"),
    19: MCode(meaning="spindle at the angle R, turning by P, within Q seconds", group="spindle",
              action=orient_spindle, basis="manual"),
    30: MCode(meaning="end of program, pallets exchanged", group="stop", after_motion=True, ends=True, action=compensation.end,
              basis="manual"),
    60: MCode(meaning="pallets exchanged, program stop", group="stop", after_motion=True, basis="manual"),
    61: MCode(meaning="number of the tool in the spindle, Q", group="tool", action=set_tool,
              silent=True, basis="manual"),
    66: MCode(meaning="input P or E read into #5399, L how, Q seconds at most", group="input",
              action=read_input, silent=True, basis="manual"),
    70: MCode(meaning="what is in force is put aside", group="state", action=saved_state.save(until_return=False),
              silent=True, basis="manual"),
    71: MCode(meaning="what was put aside is dropped", group="state", action=saved_state.forget,
              silent=True, basis="manual"),
    72: MCode(meaning="what was put aside is put back", group="state",
              action=saved_state.restore, silent=True, basis="manual"),
    73: MCode(meaning="what is in force is put aside until the subroutine ends", group="state",
              action=saved_state.save(until_return=True), silent=True, basis="manual"),
    428: MCode(meaning="the tip is led while rotary axes turn", group="kinematics", action=lead_tip, silent=True),
    429: MCode(meaning="positions are those of the axes", group="kinematics", action=lead_axes, silent=True),
    98: flow_function("the program O P is run, L times", call_program, "call"),
    99: flow_function("end of that program; the main program starts again", return_from_program, "call"),
}  # fmt: skip
