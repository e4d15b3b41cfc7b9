"""What the G codes and words of CODESYS SoftMotion do, arcs, curves and the program apart."""

import math

from twin.nc.blends import Blend, BlendKind
from twin.nc.blocks import Word
from twin.nc.control import Control
from twin.nc.dialect import Action, WordAction
from twin.nc.dialects.codesys.program import variables
from twin.nc.offsets import LEFT, RIGHT, compensate
from twin.nc.planes import XY, plane_with_normal

SWITCHES = 3
"""Switch points that one element may have (manual)."""


def dwell(control: Control) -> None:
    """G4: wait T seconds."""
    word = control.take("T")
    if word is None or control.number(word) < 0.0:
        control.fail("dwell", "G4 needs T, its seconds", word, hint="write G4 T1")
    control.dwell(control.number(word))


def free_plane(control: Control) -> None:
    """G16: the plane whose normal is I, J, K.

    Decision: without them the plane in force stays; the manual's example of a jump is written so.
    """
    if not any(letter in control.words for letter in "IJK"):
        return
    i, j, k = (control.take_number(letter) for letter in "IJK")
    if not (i or j or k):
        control.fail("plane-normal", "G16 needs the plane's normal", control.code_word(16))
    control.modal.plane = plane_with_normal((i, j, k))


def probe(control: Control) -> None:
    """G31: move to the end of the probing path and report it.

    Decision: nothing touches the twin's probe, so that the path is run to its end.
    """
    if control.path.cutting_loops:
        control.fail("loops", "a probe cannot run where loops are cut out", hint="write G60")
    control.function("G31", {})
    control.line_to(control.target(), rapid=False)


def left_of_contour(control: Control) -> None:
    """G41 D: compensate; D is the radius."""
    _compensate(control, LEFT)


def right_of_contour(control: Control) -> None:
    """G42 D."""
    _compensate(control, RIGHT)


def _compensate(control: Control, side: float) -> None:
    word = control.take("D")
    if word is not None:
        variables(control).tool_radius = control.length(word)
    compensate(control, side, variables(control).tool_radius)


def smooth_corners(kind: BlendKind) -> Action:
    """G51, G52: every corner between two moves with a feed is blended.

    The points where both moves are cut lie D from the corner, and at most half a move (manual).
    """

    def action(control: Control) -> None:
        memory = variables(control)
        word = control.take("D")
        if word is not None:
            memory.smoothing = control.length(word)
        memory.smoothed_by = kind
        _smooth(control, word)

    return action


def set_smoothing(control: Control, word: Word) -> None:
    """D elsewhere: the distance of the corners that follow (manual, from 4.18)."""
    variables(control).smoothing = control.length(word)
    if variables(control).smoothed_by is not None:
        _smooth(control, word)


def _smooth(control: Control, word: Word | None) -> None:
    memory = variables(control)
    assert memory.smoothed_by is not None
    if memory.smoothing < 0.0:
        control.fail("blend", "the distance of smoothing cannot be negative", word)
    plane = control.part_plane()
    control.path.blend_always(Blend(memory.smoothed_by, memory.smoothing, plane, halves=True))


def keep_corners(control: Control) -> None:
    """G50."""
    variables(control).smoothed_by = None
    control.path.blend_always(None)


def cut_loops(control: Control) -> None:
    """G61: loops are cut out, in 2D mode only (manual)."""
    if control.modal.plane is not XY:
        control.fail("loops", "loops are cut out in the plane X Y only", hint="write G15 before")
    control.path.cut_loops(control.part_plane())


def keep_loops(control: Control) -> None:
    """G60."""
    control.path.keep_loops()


def length_vector(control: Control) -> None:
    """G43 I J K: the tool's vector is added to every position; 0 0 0 is off."""
    i, j, k = (control.length(control.take(letter)) for letter in "IJK")
    shift = [i, j, k, *([0.0] * (len(control.settings.axes) - 3))]
    control.frame.set_shift("length", shift)
    control.reframed()


def reset_shift(control: Control) -> None:
    """G53: decoder and machine coordinates coincide."""
    control.frame.set_shift("offset", [0.0] * len(control.settings.axes))
    control.reframed()


def shift_absolutely(control: Control) -> None:
    """G54: the decoder's zero lies at the given position of the machine's coordinates."""
    _shift(control, [0.0] * len(control.settings.axes))


def shift_relatively(control: Control) -> None:
    """G55: the decoder's zero moves on by the given distances."""
    _shift(control, control.frame.shift("offset"))


def _shift(control: Control, shift: list[float]) -> None:
    for index, word in control.take_axis_words():
        shift[index] += control.axis_value(index, word)
    control.frame.set_shift("offset", shift)
    control.reframed()


def set_reference(control: Control) -> None:
    """G56: the place where the machine stands gets the given coordinates.

    Decision: the manual's page is not fully known; this is what its title says.
    """
    programmed = list(control.programmed)
    for index, word in control.take_axis_words():
        programmed[index] = control.axis_value(index, word)
    control.relabel(programmed, "offset")


def set_position(control: Control) -> None:
    """G92: the path goes on from the given position.

    Before the first move it is where the path begins. The path jumps there later, which no machine
    can: its axes travel as fast as they can (the manual's ``bAvoidGaps``). Of several in a row the
    last counts (manual).
    """
    words = control.words.keys() & control.dialect.axis_letters
    if not words:
        control.fail("preset", "G92 needs the position from which the path goes on")
    target = control.target()
    following = control.flow.following()
    if following is not None and any(w.address == "G" and w.value == 92.0 for w in following.words):
        return
    if control.has_moved:
        control.rapid_feed = math.nan
        control.line_to(target, rapid=True)
    else:
        control.stand_at(target)


# --- words


def set_acceleration(control: Control, word: Word) -> None:
    """E: above 0 the path's acceleration, below 0 its deceleration [units/s²]."""
    value = control.number(word)
    if value > 0.0:
        control.acceleration = value
    elif value < 0.0:
        control.deceleration = -value
    else:
        control.fail("acceleration-range", "an acceleration of 0 never moves", word)


def set_rapid_feed(control: Control, word: Word) -> None:
    """FF: the feed of G0; 0 gives it back to F."""
    value = control.number(word)
    if value < 0.0:
        control.fail("feed-range", f"the feed {word.text} is negative", word)
    variables(control).rapid_feed = value


def set_rapid_acceleration(control: Control, word: Word) -> None:
    """EF: above 0 the acceleration of G0, below 0 its deceleration; 0 gives both back to E."""
    value = control.number(word)
    if value >= 0.0:
        control.rapid_acceleration = value or math.nan
    if value <= 0.0:
        control.rapid_deceleration = -value or math.nan


def before_motion(control: Control, rapid: bool) -> None:
    """What holds for every motion block: the pace of G0, and the shortest way of modulo axes."""
    if rapid:
        feed = variables(control).rapid_feed or control.feed
        control.rapid_feed = math.nan if feed is None else feed * 60.0
    _refuse_slopes(control)
    take_shortest_way(control)


def _refuse_slopes(control: Control) -> None:
    """U, V, W beside A, B, C are the slopes of these at the end of the element (manual)."""
    for slope, axis in zip("UVW", "ABC", strict=True):
        if slope in control.words and slope not in control.axis_index and axis in control.words:
            message = f"{slope} is the slope of {axis}, and the twin moves {axis} linearly"
            hint = f"leave out {slope}, or write {axis} in pieces"
            control.fail("unsupported-word", message, control.words[slope], hint)


def set_period(letter: str) -> WordAction:
    """PA, PB, ...: the modulo period of an additional axis; 0 makes it linear."""

    def action(control: Control, word: Word) -> None:
        index = control.axis_index.get(letter)
        if index is None:
            control.refuse_axis(word._replace(address=letter))
        period = control.number(word)
        if period < 0.0:
            control.fail("period", f"{word.text} is no period", word)
        variables(control).periods[index] = period

    return action


def axis_limit(letter: str, *, acceleration: bool) -> WordAction:
    """FX, EX, ...: the largest velocity or acceleration of one axis; 0 takes it away."""

    def action(control: Control, word: Word) -> None:
        index = control.axis_index.get(letter)
        if index is None:
            control.refuse_axis(word._replace(address=letter))
        value = abs(control.number(word))
        table = control.axis_accelerations if acceleration else control.axis_limits
        if value == 0.0:
            table.pop(index, None)
        else:
            table[index] = value if acceleration else value * 60.0

    return action


def refuse_profile(control: Control, word: Word) -> None:
    """S: a profile of the additional axes; only 0, none, can be followed."""
    if control.number(word) != 0.0:
        message = "profiles of additional axes are not simulated; S can only be 0"
        control.fail("unsupported-word", message, word)


def pass_label(_control: Control, _word: Word) -> None:
    """L!: a place to jump to; nothing happens there."""


def take_shortest_way(control: Control) -> None:
    """Axes with a period go the shorter way round: the start is relabelled by whole periods."""
    if control.modal.incremental:
        return
    for index, period in variables(control).periods.items():
        word = control.words.get(control.settings.axes.names[index])
        if word is None or period == 0.0:
            continue
        target, here = control.axis_value(index, word), control.programmed[index]
        turns = round((target - here) / period)
        if turns:
            programmed = list(control.programmed)
            programmed[index] += turns * period
            control.relabel(programmed, "turns")


def place_switches(control: Control, length: float) -> None:
    """H with O (share of the element) or L (distance from its start, or its end when negative).

    Raises:
        ProgramError: Too many, none of O and L, or a place outside the element.
    """
    words, control.series = control.series, []
    switches = [at for at, word in enumerate(words) if word.address == "H"]
    if len(switches) > SWITCHES:
        control.fail("switch-point", f"an element has {SWITCHES} switch points at most", words[-1])
    for begin, end in zip(switches, [*switches[1:], len(words)], strict=True):
        place = words[begin + 1 : end]
        number = control.number(words[begin])
        if len(place) != 1 or number == 0.0 or number != int(number):
            message = "a switch point is H with one of O and L after it"
            control.fail("switch-point", message, words[begin])
        value = control.number(place[0])
        if place[0].address == "O":
            share = value
        else:
            share = (value if value >= 0.0 else length + value) / length
        if not 0.0 <= share <= 1.0:
            control.fail("switch-point", "the switch point lies outside its element", place[0])
        on = 1.0 if number > 0.0 else 0.0
        control.function(f"H{abs(number):g}", {"on": on}, share)
