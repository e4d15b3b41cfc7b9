"""M functions of a TNC."""

import dataclasses
from collections.abc import Mapping

from twin.nc.control.codes import Action, MCode
from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.cycles.calls import call_from_now_on, call_last
from twin.nc.dialects.heidenhain.cycles.planes import retract
from twin.nc.dialects.heidenhain.flow import refuse_end_of_called
from twin.nc.dialects.heidenhain.memory import memory_of
from twin.nc.dialects.heidenhain.tool_tip import begin_tcpm, end_tcpm
from twin.nc.iso import base
from twin.nc.iso.drilling.hole import turn_spindle
from twin.nc.iso.orientation.rotary_targets import absolute_targets, go_shorter
from twin.nc.text.blocks import Word


def _refused(number: int, meaning: str, reason: str) -> MCode:
    """A function that the control knows and the twin does not follow."""

    def refuse(control: Control) -> None:
        words = control.block.words
        word = next((each for each in words if each.address == "M" and each.value == number), None)
        control.fail("unsupported-m", f"M{number} ({meaning}): {reason}", word)

    return MCode(meaning=f"{meaning}: refused", action=refuse, silent=True, basis="manual")


def _silent(meaning: str, action: Action | None = None, *, after_motion: bool = False) -> MCode:
    return MCode(
        meaning=meaning, action=action, silent=True, after_motion=after_motion, basis="manual"
    )


def _passed(meaning: str) -> MCode:
    """A function that changes nothing of the path here."""
    return _silent(f"{meaning}; changes nothing of the path here")


def _starts(function: str) -> Action:
    """M13, M14: the spindle and the coolant."""

    def action(control: Control) -> None:
        turn_spindle(control, function)
        control.motion.spindle_turns = True
        control.function("M8", {})

    return action


def _from_machine(code: str) -> Action:
    """M91, M92: the coordinates of the block count from there."""

    def action(control: Control) -> None:
        memory_of(control).machine = code

    return action


def reduce_rotary(control: Control, word: Word | None = None) -> None:
    """M94, M94 C: what the screen shows of rotary axes is brought below a turn before the block moves."""
    names = control.settings.axes.names if word is None else word.address[-1]
    programmed = [
        value if linear or name not in names else value % 360.0
        for name, value, linear in zip(
            control.settings.axes.names,
            control.motion.programmed,
            control.motion.linear,
            strict=True,
        )
    ]
    control.motion.set_position(programmed, "turns")


def _go_shortest(shortest: bool) -> Action:
    """M126, M127: rotary axes take the shorter path, or go as written."""

    def action(control: Control) -> None:
        memory_of(control).shortest = shortest

    return action


def turn_shortest(control: Control) -> None:
    """With M126 the start of each rotary axis is relabelled by whole turns, so that it turns by the shorter angle."""
    if not memory_of(control).shortest:
        return
    for index, _, target in absolute_targets(control):
        go_shorter(control, index, target)


def _feed_per_turn(turning: bool) -> Action:
    """M136, M137: F counts per revolution, or per minute."""

    def action(control: Control) -> None:
        memory_of(control).per_revolution = turning

    return action


def _retract(control: Control) -> None:
    """M140 MB: away from the part along the tool axis, with F or as fast as the machine can.

    Decision: MB MAX goes to machine zero of that axis, since nobody tells the control where its travel ends.
    """
    most, word = control.take("MBMAX"), control.take("MB")
    own = any(each.address == "F" for each in control.block.words)
    if most is None and word is None:
        hint = "write M140 MB 50 or M140 MB MAX"
        control.fail("missing-words", "M140 needs its distance MB", hint=hint)
    if control.path.compensation.in_force or control.path.leads is not None:
        message = "the tool does not retract while radius compensation is in force"
        control.fail("compensation-change", message, hint="end it by R0 before")
    retract(control, None if most is not None else control.length(word), rapid=not own)


_TCPM = "M128 or FUNCTION TCPM leads the tip"
_REFUSED: Mapping[int, tuple[str, str]] = {
    **dict.fromkeys((90, 112), ("smoothed corners of old controls", "write CYCL DEF 32")),
    97: ("small steps of the contour", "a contour smaller than the tool is refused here"),
    98: ("open corners of the contour", "the path there is not known"),
    102: ("tool change at the end of its life", "the twin's tools do not wear"),
    103: ("feed factor of plunging", "write F for the plunge itself"),
    109: ("feed at the edge on arcs", "F counts the tool's centre"),
    110: ("feed at the edge on inside arcs", "F counts the tool's centre"),
    114: ("compensation of rotary axes", _TCPM),
    116: ("feed of rotary axes in mm/min", "F counts degrees where rotary axes move alone"),
    118: ("the handwheel beside the path", "there is none"),
    124: ("points of the contour that are left out", "the path would not be the programmed one"),
    130: ("points in the level system", "only the tilted plane of PLANE is followed"),
    134: ("exact stop of rotary axes", "corners are those of CYCL DEF 32"),
    138: ("rotary axes of the tilted plane", "only the tilted plane of PLANE is followed"),
    143: ("the end of a basic rotation", "the twin keeps none"),
    144: ("kinematics in the path", _TCPM),
    197: ("corners of the parallel path", "corners are rolled around"),
}

FUNCTIONS: Mapping[int, MCode] = {
    **{
        number: dataclasses.replace(base.M_CODES[number], basis="manual")
        for number in (0, 1, 3, 4, 5, 8, 9)
    },
    **{
        number: MCode(
            meaning=meaning,
            group="stop",
            after_motion=True,
            ends=True,
            action=refuse_end_of_called,
            basis="manual",
        )
        for number, meaning in ((2, "end of program"), (30, "end of program and back to its start"))
    },
    6: MCode(meaning="tool change by the machine's builder", basis="manual"),
    7: MCode(meaning="mist on", basis="decision"),
    13: _silent("spindle clockwise and coolant on", _starts("M3")),
    14: _silent("spindle counter-clockwise and coolant on", _starts("M4")),
    89: _silent(
        "the cycle runs behind every block that moves", call_from_now_on, after_motion=True
    ),
    91: _silent("this block counts from machine zero", _from_machine("M91")),
    92: _silent("this block counts from the datum M92 of the job", _from_machine("M92")),
    94: _silent("what is shown of rotary axes is brought below a turn", reduce_rotary),
    99: _silent("the cycle runs", call_last, after_motion=True),
    126: _silent("rotary axes go the shorter way", _go_shortest(True)),
    128: _silent("the tip is led while rotary axes turn", begin_tcpm),
    129: _silent("M128 off", end_tcpm),
    127: _silent("rotary axes go as written", _go_shortest(False)),
    136: _silent("F per revolution of the spindle", _feed_per_turn(True)),
    137: _silent("F per minute", _feed_per_turn(False)),
    140: _silent("retract along the tool axis: MB", _retract),
    101: _passed("tool change at the end of a tool's life"),
    107: _passed("a replacement tool may be larger"),
    108: _passed("M107 off"),
    111: _passed("M109 and M110 off"),
    115: _passed("M114 off"),
    117: _passed("M116 off"),
    120: _silent(
        "the contour is looked at ahead: LA; changes nothing of the path here",
        lambda control: control.words.pop("LA", None) and None,
    ),
    141: _passed("the probe is not watched"),
    145: _passed("M144 off"),
    148: _passed("the tool is lifted where the program is stopped"),
    149: _passed("M148 off"),
    **{number: _refused(number, *told) for number, told in _REFUSED.items()},
}
