"""What the G codes of CODESYS SoftMotion do, arcs, curves and the program apart."""

import math

from twin.nc.control.codes import Action
from twin.nc.control.compensation import compensate
from twin.nc.control.control import Control, refuse_axis
from twin.nc.control.modal import LineRule
from twin.nc.dialects.codesys.program import memory_of
from twin.nc.geometry.planes import XY, plane_with_normal
from twin.nc.iso import offsets
from twin.nc.iso.declared import refuse_compensated_plane
from twin.nc.path.blends import Blend, BlendKind
from twin.nc.text.blocks import Word

ADDITIONAL = "ABCPQUVW"
"""Letters of additional axes, in the order of their numbers."""
FIRST_ADDITIONAL = 4
"""Number of the first of them, A (manual)."""


def free_plane(control: Control) -> None:
    """G16: the plane whose normal is I, J, K.

    Decision: without them the plane in force stays; the manual's example of a jump is written so.
    """
    if not any(letter in control.words for letter in "IJK"):
        return
    i, j, k = (control.number(control.take(letter)) for letter in "IJK")
    if not (i or j or k):
        control.fail("plane-normal", "G16 needs the plane's normal", control.code_word(16))
    control.modal.plane = plane_with_normal((i, j, k))
    plane_changed(control)


def plane_changed(control: Control) -> None:
    """G15 to G19: compensation that has not moved yet acts in the new plane (ToolRadiusCorr, example 2)."""
    if control.path.compensation.has_moved:
        refuse_compensated_plane(control)
    if control.path.compensation.in_force:
        control.path.compensation.plane = control.motion.part_plane.directions


def compensation_by_radius(side: float) -> Action:
    """G41, G42: compensation by the radius D, else by the one that was given last."""

    def action(control: Control) -> None:
        word, memory = control.take("D"), memory_of(control)
        if word is not None:
            memory.radius = control.length(word)
        compensate(control, side, memory.radius)

    return action


def probe(control: Control) -> None:
    """G31: move to the end of the probing path and report it.

    Decision: nothing touches the twin's probe, so that the path is run to its end.
    """
    if control.path.cutting_loops:
        control.fail("loops", "a probe cannot run where loops are cut out", hint="write G60")
    control.function("G31", {})
    control.line_to(control.target(), rapid=False)


def smooth_corners(kind: BlendKind) -> Action:
    """G51, G52: every corner between two moves with a feed is blended.

    The points where both moves are cut lie D from the corner, and at most half a move (manual).
    """

    def action(control: Control) -> None:
        memory = memory_of(control)
        word = control.take("D")
        if word is not None:
            memory.smoothing = control.length(word)
        memory.smoothed_by = kind
        _smooth(control, word)

    return action


def set_smoothing(control: Control, word: Word) -> None:
    """D elsewhere: the distance of the corners that follow (manual, from 4.18)."""
    memory_of(control).smoothing = control.length(word)
    if memory_of(control).smoothed_by is not None:
        _smooth(control, word)


def _smooth(control: Control, word: Word | None) -> None:
    memory = memory_of(control)
    assert memory.smoothed_by is not None
    if memory.smoothing < 0.0:
        control.fail("blend", "the distance of smoothing cannot be negative", word)
    plane = control.motion.part_plane
    control.path.blend_always(Blend(memory.smoothed_by, memory.smoothing, plane, halves=True))


def keep_corners(control: Control) -> None:
    """G50."""
    memory_of(control).smoothed_by = None
    control.path.blend_always(None)


def cut_loops(control: Control) -> None:
    """G61: loops are cut out, in 2D mode only (manual)."""
    if control.modal.plane is not XY:
        control.fail("loops", "loops are cut out in the plane X Y only", hint="write G15 before")
    control.path.cut_loops(control.motion.part_plane)


def keep_loops(control: Control) -> None:
    """G60."""
    control.path.keep_loops()


def go_evenly(control: Control) -> None:
    """G71 L: the additional axis L goes evenly over the moves up to G70."""
    word = control.take("L")
    if word is None:
        hint = "write G71 L6 for C"
        control.fail("even-axis", "G71 needs L, the number of the axis", hint=hint)
    control.path.go_evenly(_numbered_axis(control, word))


def go_as_programmed(control: Control) -> None:
    """G70 L: it goes with each move again; without L all do."""
    word = control.take("L")
    axes = range(len(control.settings.axes)) if word is None else [_numbered_axis(control, word)]
    for axis in axes:
        control.path.go_as_programmed(axis)


def _numbered_axis(control: Control, word: Word) -> int:
    """Column of the additional axis with a number: 4 is A, 11 is W (manual)."""
    number = control.number(word) - FIRST_ADDITIONAL
    if number not in range(len(ADDITIONAL)):
        control.fail("even-axis", f"{word.text} numbers no additional axis", word, "4 is A, 6 is C")
    return axis_named(control, ADDITIONAL[int(number)], word)


def axis_named(control: Control, letter: str, word: Word) -> int:
    """Column of the axis with a letter; a word asks for it."""
    index = control.axis_index.get(letter)
    if index is None:
        refuse_axis(control, word._replace(address=letter))
    return index


def length_vector(control: Control) -> None:
    """G43 I J K: the tool's vector is added to every position; 0 0 0 is off.

    The next move leads into it or out of it: from where the axes are to its end with the vector
    (page of the preprocessor), also where it names another axis.
    """
    vector = [control.length(control.take(letter)) for letter in "IJK"]
    if control.path.compensation.in_force:
        message = "the tool's length cannot change while radius compensation is in force"
        control.fail("compensation-change", message, hint="end it by G40 first")
    memory, old = memory_of(control), control.frame.shift("length")
    x, y, z = (
        pending + new - before
        for pending, new, before in zip(memory.length_ramp, vector, old[:3], strict=True)
    )
    memory.length_ramp = (x, y, z)
    control.frame.set_shift("length", [*vector, *([0.0] * (len(control.settings.axes) - 3))])


def lead_into_length(control: Control) -> None:
    """A move goes to its end with the tool's vector, which has changed before it."""
    memory = memory_of(control)
    across = memory.length_ramp
    memory.length_ramp = (0.0, 0.0, 0.0)
    normal, mode = control.modal.plane.normal, control.modal.interpolation
    height = sum(a * n for a, n in zip(across, normal, strict=True))
    beside = max(abs(a - height * n) for a, n in zip(across, normal, strict=True))
    if mode is not None and not isinstance(mode.rule, LineRule) and beside > 0.0:
        message = "the tool's length is led into on the next move, which must be a straight one"
        control.fail("length-ramp", message, hint="write G0 or G1 behind G43")


def _keep_ramp(control: Control) -> None:
    """The frame has changed: a length that no move has led into yet still lies before the control."""
    for axis, pending in enumerate(memory_of(control).length_ramp):
        control.motion.programmed[axis] += pending


def reset_shift(control: Control) -> None:
    """G53: decoder and machine coordinates coincide."""
    offsets.shift_by(control, {}, ends_preset=False)
    _keep_ramp(control)


def shift_absolutely(control: Control) -> None:
    """G54: the decoder's zero lies at the given position of the machine's coordinates."""
    offsets.programmed_shift(control, "offset")
    _keep_ramp(control)


def shift_relatively(control: Control) -> None:
    """G55: the decoder's zero moves on by the given distances."""
    shift = control.frame.shift("offset")
    for index, word in control.take_axis_words():
        shift[index] += control.axis_value(index, word)
    control.frame.set_shift("offset", shift)
    control.motion.reframed()
    _keep_ramp(control)


def set_reference(control: Control) -> None:
    """G56: the place where the machine is gets the given coordinates.

    Decision: the manual's page is not fully known; this is what its title says.
    """
    offsets.set_position(control, control.take_axis_words(), "offset")


def set_position(control: Control) -> None:
    """G92: the path goes on from the given position.

    Before the first move it is where the path begins. The path jumps there later, which no machine
    can: its axes travel as fast as they can (the manual's ``bAvoidGaps``). Of several in a row the
    last counts (manual).
    """
    words = control.words.keys() & control.axis_letters
    if not words:
        control.fail("preset", "G92 needs the position from which the path goes on")
    target = control.target()
    following = control.program_counter.following()
    if following is not None and any(w.address == "G" and w.value == 92.0 for w in following.words):
        return
    if control.motion.last is not None:
        programmed, control.motion.rapid_feed = control.motion.rapid_feed, math.nan
        control.line_to(target, rapid=True)
        control.motion.rapid_feed = programmed
    else:
        control.motion.begin_at(target)
