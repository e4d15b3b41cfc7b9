"""Where a block of the Fagor CNC 8070 goes: Cartesian, polar, or a coordinate and an angle."""

import dataclasses
import math

from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.memory import memory_of
from twin.nc.iso.polar_words import aim_by_angle, aim_by_polar


@dataclasses.dataclass(frozen=True, slots=True)
class Goal:
    """Where a block goes.

    Attributes:
        target: Programmed position, shape (k,).
        in_plane: The block names a point of the plane.
        polar: It does so by R and Q.
    """

    target: list[float]
    in_plane: bool
    polar: bool


def forget_polar(control: Control) -> None:
    """The last polar values no longer hold: they are computed again from where the tool is."""
    memory = memory_of(control)
    memory.polar_radius = memory.polar_angle = math.nan


def set_polar_origin(control: Control) -> None:
    """G30: I abscissa and J ordinate of the polar origin; neither: where the tool is."""
    abscissa, ordinate = control.take("I"), control.take("J")
    if (abscissa is None) != (ordinate is None):
        control.fail("polar-origin", "G30 needs both I and J, or neither", abscissa or ordinate)
    origin = (control.length(abscissa), control.length(ordinate))
    if abscissa is None:
        origin = control.modal.plane.point(control.motion.programmed)
    memory_of(control).polar_origin = origin
    forget_polar(control)


def refuse_origin_by_g93(control: Control) -> None:
    """G93 I J is the polar origin of the CNC 8055; here G93 is a feed."""
    word = control.words.get("I") or control.words.get("J")
    if word is not None and not any(code.group == "motion" for _, code in control.codes):
        message = "G93 is the feed in seconds; the polar origin by G93 is the CNC 8055's"
        control.fail("polar-origin", message, word, "write G30 I J")


def temporary_polar_origin(control: Control) -> None:
    """G31: for this arc the polar origin is its centre.

    Raises:
        ProgramError: The block draws no arc (E1604).
    """
    if control.modal.active.get("motion") not in (2, 3):
        control.fail("temporary-origin", "G31 needs an arc, G02 or G03", control.code_word(31))
    memory_of(control).temporary = True


def take_goal(control: Control, *, arc: bool) -> Goal:
    """Take the words that say where the block goes."""
    names = control.settings.axes.names
    abscissa, ordinate, _ = (names[index] for index in control.modal.plane.axes)
    words = control.words
    cartesian = (abscissa in words) + (ordinate in words)
    if cartesian == 0 and ("R" in words or "Q" in words):
        return Goal(_polar_target(control, arc=arc), in_plane=True, polar=True)
    angle = control.take("Q") if cartesian == 1 else None
    has_abscissa = abscissa in words
    target = control.target()
    if angle is not None:
        aim_by_angle(control, target, angle, from_abscissa=has_abscissa)
    if cartesian:
        forget_polar(control)
    return Goal(target, in_plane=cartesian > 0, polar=False)


def _polar_target(control: Control, *, arc: bool) -> list[float]:
    if control.modal.active.get("offset") == 53:
        message = "polar coordinates are not allowed while G53 is in force (E1530)"
        control.fail("polar-origin", message, control.words.get("R") or control.words.get("Q"))
    if memory_of(control).part_frame is not None:
        message = "polar coordinates are not allowed while #MCS is in force (E1305)"
        control.fail("polar-origin", message, control.words.get("R") or control.words.get("Q"))
    radius_word, angle_word = control.take("R"), control.take("Q")
    target = control.target()
    memory = memory_of(control)
    memory.polar_radius, memory.polar_angle = aim_by_polar(
        control,
        target,
        memory.polar_origin,
        (memory.polar_radius, memory.polar_angle),
        (radius_word, angle_word),
        incremental=control.modal.incremental,
    )
    if arc and radius_word is not None and memory.polar_radius == 0.0:
        control.fail("polar-radius", "the polar radius 0 must be positive", radius_word)
    return target
