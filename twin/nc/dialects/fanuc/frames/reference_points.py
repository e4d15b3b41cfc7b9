"""G27 to G30 and G53 of a Fanuc control: moves to the reference points and in machine coordinates.

The first reference point is machine zero. Decision: the second to fourth (parameters 1241 to 1243)
lie there as well, which is how a control comes from its maker.

G28, G30 and G53 that move Z cancel the tool length, while G43 or G44 stays displayed (manual); it counts again from
the next G43, G44 or H, or with parameter 5001 #6 (EVO) at 1 from the next block. On a Haas G28 cancels it, whatever
axes it names, and G53 holds for its block (its manual of G28 and G53).
"""

from twin.nc.control.control import Control
from twin.nc.dialects.fanuc.memory import memory_of, refuse_transformed
from twin.nc.dialects.fanuc.programs import whole
from twin.nc.iso.machine_coordinates import machine_frame
from twin.nc.iso.tool_compensation import set_length

Z = 2
"""Column of the axis along which tool lengths lie."""
NO_LENGTH = 49
"""Code of the group of tool lengths that ends them."""


def go_to_reference(control: Control) -> None:
    """G30 P2, P3, P4: as G28, to the second, third or fourth reference point."""
    word = control.take("P")
    if word is not None and not 2 <= whole(control, word, "reference-point", "number") <= 4:
        control.fail("reference-point", f"there is no reference point {word.text}", word)
    go_home(control, "G30")


def go_home(control: Control, code: str = "G28") -> None:
    """G28: rapidly to the point of the block, then its axes to machine zero."""
    axes = _named_axes(control)
    if not axes and memory_of(control).variant.home_without_axes:
        axes = list(range(len(control.settings.axes)))
    if not axes:
        message = f"{code} needs the axes that shall go there, with the point that they pass"
        control.fail("reference-point", message, hint=f"G91 {code} Z0")
    refuse_transformed(control, code)
    with machine_frame(control, code):
        pass  # the reference point must be known before anything moves
    control.line_to(control.target(), rapid=True)
    memory_of(control).intermediate = {index: control.motion.part[index] for index in axes}
    with machine_frame(control, code):
        there = list(control.motion.programmed)
        for index in axes:
            there[index] = 0.0
        control.line_to(there, rapid=True)
    if Z in axes or memory_of(control).variant.reference_cancels_any_length:
        _cancel_length(control, code)


def _cancel_length(control: Control, code: str) -> None:
    """The tool length counts no more, where the control's parameters say so."""
    if control.settings.length_returns == "next block":
        return
    if control.modal.active.get("length", NO_LENGTH) != NO_LENGTH:
        memory_of(control).length_cancelled = code
        set_length(control, 0.0)


def warn_of_cancelled_length(control: Control) -> None:
    """A block that moves Z while its tool length is cancelled may go deeper than was meant."""
    code, word = memory_of(control).length_cancelled, control.words.get("Z")
    if code and word is not None and not control.modal.incremental:
        control.report.warn_once(
            "length-cancelled",
            f"{code} has cancelled the tool length: {word.text} counts without it",
            word.column,
            word.width,
            hint="write G43 H again before; G49 says that it is meant so",
        )


def _named_axes(control: Control) -> list[int]:
    """Columns of the axes that the block names; those that the machine lacks are refused later."""
    letters = (name for name in control.words if name in control.axis_letters)
    return [control.axis_index[name] for name in letters if name in control.axis_index]


def leave_reference(control: Control) -> None:
    """G29: by the point of the last G28 or G30 to that of the block."""
    between = memory_of(control).intermediate
    if not between:
        message = "G29 goes by the point of the last G28, and there was none"
        control.fail("reference-point", message, control.code_word(29))
    part = list(control.motion.part)
    for index, value in between.items():
        part[index] = value
    control.line_to(control.frame.to_programmed(part), rapid=True)
    control.line_to(control.target(), rapid=True)


def check_reference(control: Control) -> None:
    """G27: rapidly to the point of the block, which must be the reference point."""
    axes = _named_axes(control)
    if not axes:
        control.fail("reference-point", "G27 needs the axes that shall stand there")
    control.line_to(control.target(), rapid=True)
    with machine_frame(control, "G27"):
        away = {index: control.motion.programmed[index] for index in axes}
    for index, distance in away.items():
        if abs(distance) > _SAME_PLACE:
            name = control.settings.axes.names[index]
            message = f"{name} is {distance:g} from its reference point"
            control.fail("reference-point", message, control.code_word(27))


_SAME_PLACE = 0.001
"""How near G27 takes for the reference point [mm or deg]."""


def machine_move(control: Control) -> None:
    """G53: this block's coordinates count from machine zero.

    Raises:
        ProgramError: G91 is in force, or no axis is named.
    """
    word = control.code_word(53)
    if control.modal.incremental:
        message = "G53 counts from machine zero, and G91 is in force"
        control.fail("reference-point", message, word, "write G90 G53")
    if not control.words.keys() & control.axis_letters:
        control.fail("reference-point", "G53 needs the axes that shall move", word, "G53 Z0")
    motion, by_motion = (
        control.modal.active.get("motion"),
        memory_of(control).variant.machine_by_motion,
    )
    if motion not in (0, 1) and by_motion:
        control.fail("no-motion-code", "G53 moves by G0 or G1", word)
    moves_z = "Z" in control.words
    with machine_frame(control, "G53"):
        control.line_to(control.target(), rapid=motion == 0 or not by_motion)
    if moves_z and not by_motion:
        _cancel_length(control, "G53")
