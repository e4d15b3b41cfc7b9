"""What the words of CODESYS SoftMotion do in addition to its G codes: feed rates, limits, periods, switch points."""

import math

from twin.nc.control.codes import WordAction
from twin.nc.control.control import Control
from twin.nc.dialects.codesys.actions import axis_named, lead_into_length
from twin.nc.dialects.codesys.program import memory_of
from twin.nc.iso.orientation.rotary_targets import go_shorter
from twin.nc.text.blocks import Word

LARGEST_SWITCH = 32_767
"""Largest number of a switch point (manual)."""
SWITCHES = 3
"""Switch points that one element may have (manual)."""


def set_acceleration(control: Control, word: Word) -> None:
    """E: above 0 the path's acceleration, below 0 its deceleration [units/s²].

    Decision: E follows a blank, as the manual separates words: behind a digit it may be an exponent.
    """
    before = control.report.text_of(control.block.line)[: word.column]
    if before[-1:].isdigit():
        message = f"'{word.text}' may be an acceleration or an exponent"
        hint = "write a blank before E, or the number without an exponent"
        control.fail("unreadable", message, word, hint)
    value = control.number(word)
    if value > 0.0:
        control.motion.acceleration = value
    elif value < 0.0:
        control.motion.deceleration = -value
    else:
        control.fail("acceleration-range", "an acceleration of 0 never moves", word)


def set_rapid_feed(control: Control, word: Word) -> None:
    """FF: the feed of G0; 0 gives it back to F."""
    value = control.number(word)
    if value < 0.0:
        control.fail("feed-range", f"the feed {word.text} is negative", word, "write FF100")
    control.motion.rapid_feed = value


def set_rapid_acceleration(control: Control, word: Word) -> None:
    """EF: above 0 the acceleration of G0, below 0 its deceleration; 0 gives both back to E."""
    value = control.number(word)
    if value >= 0.0:
        control.motion.rapid_acceleration = value or math.nan
    if value <= 0.0:
        control.motion.rapid_deceleration = -value or math.nan


def prepare(control: Control) -> None:
    """The program begins: G0 follows F."""
    control.motion.rapid_feed = 0.0


def before_motion(control: Control, _rapid: bool) -> None:
    """What holds for every motion block: slopes, and the shortest path of modulo axes."""
    _refuse_slopes(control)
    turn_shortest(control)
    if any(memory_of(control).length_ramp):
        lead_into_length(control)


def _refuse_slopes(control: Control) -> None:
    """U, V, W with A, B, C are the slopes of these at the end of the element (manual)."""
    for slope, axis in zip("UVW", "ABC", strict=True):
        if slope in control.words and slope not in control.axis_index and axis in control.words:
            message = f"{slope} is the slope of {axis}, and the twin moves {axis} linearly"
            hint = f"leave out {slope}, or write {axis} in pieces"
            control.fail("unsupported-word", message, control.words[slope], hint)


def set_period(letter: str) -> WordAction:
    """PA, PB, ...: the modulo period of an additional axis; 0 makes it linear."""

    def action(control: Control, word: Word) -> None:
        index = axis_named(control, letter, word)
        period = control.number(word)
        if period < 0.0:
            control.fail("period", f"{word.text} is no period", word)
        memory_of(control).periods[index] = period

    return action


def axis_velocity(letter: str) -> WordAction:
    """FX, ...: the largest velocity of one axis; 0 takes it away."""

    def action(control: Control, word: Word) -> None:
        index, value = axis_named(control, letter, word), abs(control.number(word))
        control.motion.axis_limits[index] = value * 60.0
        if value == 0.0:
            del control.motion.axis_limits[index]

    return action


def axis_acceleration(letter: str) -> WordAction:
    """EX10, EX-13: the largest acceleration and deceleration of one axis; 0 takes both away.

    As with E, a value above 0 is the acceleration, one below 0 the deceleration (page of the
    extended velocity checks). Decision: an acceleration alone is the deceleration too.
    """

    def action(control: Control, word: Word) -> None:
        index, value = axis_named(control, letter, word), control.number(word)
        both = control.motion.axis_accelerations, control.motion.axis_decelerations
        if value == 0.0:
            for table in both:
                table.pop(index, None)
        elif value < 0.0:
            control.motion.axis_decelerations[index] = -value
        else:
            control.motion.axis_accelerations[index] = value
            if f"{word.address}-" not in {each.address for each in control.words.values()}:
                control.motion.axis_decelerations[index] = value

    return action


def refuse_profile(control: Control, word: Word) -> None:
    """S: a profile of the additional axes; only 0, none, can be followed."""
    if control.number(word) != 0.0:
        message = "profiles of additional axes are not simulated; S can only be 0"
        control.fail("unsupported-word", message, word)


def turn_shortest(control: Control) -> None:
    """Axes with a period go the shorter path around: the start is relabelled by whole periods."""
    if control.modal.incremental:
        return
    for index, period in memory_of(control).periods.items():
        word = control.words.get(control.settings.axes.names[index])
        if word is None or period == 0.0:
            continue
        go_shorter(control, index, control.axis_value(index, word), period)


def place_switches(control: Control, length: float) -> None:
    """H with O (share of the element) or L (distance from its start, or its end when negative)."""
    words, control.series = control.series, []
    if not words:
        return
    switches = [at for at, word in enumerate(words) if word.address == "H"]
    if len(switches) > SWITCHES:
        control.fail("switch-point", f"an element has {SWITCHES} switch points at most", words[-1])
    for begin, end in zip(switches, [*switches[1:], len(words)], strict=True):
        place = words[begin + 1 : end]
        number = control.number(words[begin])
        if len(place) != 1 or number != int(number) or not 0 < abs(number) <= LARGEST_SWITCH:
            message = f"a switch point is H, 1 to {LARGEST_SWITCH}, with one of O and L after it"
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
