"""Where a block of the Fagor CNC 8070 goes: Cartesian, polar, or a coordinate and an angle."""

import dataclasses
import math
from collections.abc import Iterable

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import Assembler, UnsupportedError
from twin.nc.bytecode.registers import (
    POLAR_ABSCISSA,
    POLAR_ANGLE,
    POLAR_ORDINATE,
    POLAR_RADIUS,
)
from twin.nc.control.block_compiler import BlockCompiler
from twin.nc.control.codes import GCode
from twin.nc.control.control import Control
from twin.nc.control.interpolation import CycleRule
from twin.nc.dialects.fagor8070.memory import memory_of, polar_origin
from twin.nc.geometry.arcs import direction
from twin.nc.geometry.polar import changed, point_at, seen_from
from twin.nc.text.blocks import Word


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
    """The last polar values no longer hold: they are seen anew from where the tool stands."""
    if not math.isnan(control.registers[POLAR_RADIUS]):  # both are, or none
        control.perform(write_forgotten_polar)


def write_forgotten_polar(assembler: Assembler) -> None:
    """As ``forget_polar``, said as instructions."""
    assembler.empty_register(POLAR_RADIUS)
    assembler.empty_register(POLAR_ANGLE)


def set_polar_origin(control: Control, assembler: Assembler) -> None:
    """G30: I abscissa and J ordinate of the polar origin; neither: where the tool stands.

    Raises:
        ProgramError: Only one of both is given.
    """
    abscissa, ordinate = control.take("I"), control.take("J")
    if (abscissa is None) != (ordinate is None):
        control.fail("polar-origin", "G30 needs both I and J, or neither", abscissa or ordinate)
    if control.words or len(control.codes) > 1:
        assembler.rare()
    given = [word for word in (abscissa, ordinate) if word is not None]
    for axis, register in enumerate((POLAR_ABSCISSA, POLAR_ORDINATE)):
        if given:
            assembler.word_value(given[axis])
            assembler.emit(opcodes.TO_MILLIMETRES)
        else:
            assembler.emit(opcodes.COORDINATE, axis)
        assembler.set_register(register)
    write_forgotten_polar(assembler)


def is_polar(compiler: BlockCompiler, words: Iterable[Word]) -> bool:
    """A block with R or Q goes there, unless it names a coordinate of the plane or makes no move."""
    words, control = list(words), compiler.control
    codes = list(compiler.known_codes(words))
    addresses = {word.address for word in words} - _words_of_cycles(codes)
    names = control.settings.axes.names
    abscissa, ordinate, _ = (names[index] for index in control.modal.plane.axes)
    return (
        not addresses.isdisjoint("RQ")
        and addresses.isdisjoint((abscissa, ordinate, *"IJK"))
        and all(code.perform is None for code in codes)
    )


def _words_of_cycles(codes: Iterable[GCode]) -> set[str]:
    """Letters that belong to the drilling cycle which one of these codes calls."""
    rules = [cycle.rule for code in codes if (cycle := code.sets.get("cycle")) is not None]
    cycles = [rule for rule in rules if isinstance(rule, CycleRule)]
    return {letter for rule in cycles for letter in (*rule.words, *rule.options)}


def compile_polar(compiler: BlockCompiler, words: Iterable[Word]) -> None:
    """Write a polar block for the compiled tier.

    Raises:
        UnsupportedError: It does more than that.
    """
    assembler, control = compiler.assembler, compiler.control
    codes, functions = compiler.sorted(words)
    cycles = [(word, code) for word, code in codes if code.begins_cycle]
    others = [(word, code) for word, code in codes if not code.begins_cycle]
    for _, code in cycles:
        if code.writer is None:
            raise UnsupportedError
        code.writer(control, assembler)
    radius, angle, feed = control.take("R"), control.take("Q"), control.take("F")
    if (
        functions
        or control.words.keys() - control.axis_letters
        or any(code.writer or code.action or code.perform for _, code in others)
        or any(word is not None and word.incremental for word in (radius, angle))
    ):
        raise UnsupportedError
    moving = [] if feed is None else [feed]
    assembler.codes([*(word for word, _ in others), *moving])
    assembler.polar(radius, angle, [*(word for word, _ in cycles), *control.words.values()])


def refuse_origin_by_g93(control: Control) -> None:
    """G93 I J is the polar origin of the CNC 8055; here G93 is a feed.

    Raises:
        ProgramError: The block has I or J and no motion that would use them.
    """
    word = control.words.get("I") or control.words.get("J")
    if word is not None and not any(code.group == "motion" for _, code in control.codes):
        message = "G93 is the feed in seconds; the polar origin by G93 is the CNC 8055's"
        control.fail("polar-origin", message, word, "write G30 I J")


def temporary_polar_origin(control: Control) -> None:
    """G31: for this arc the polar origin is its centre.

    Raises:
        ProgramError: The block draws no arc (E1604).
    """
    if control.active.get("motion") not in (2, 3):
        control.fail("temporary-origin", "G31 needs an arc, G02 or G03", control.code_word(31))
    memory_of(control).temporary = True


def current_polar(control: Control) -> tuple[float, float]:
    """R and Q of where the tool stands: as last programmed, else measured [mm, deg]."""
    here, registers = control.modal.plane.point(control.programmed), control.registers
    return seen_from(polar_origin(control), here, registers[POLAR_RADIUS], registers[POLAR_ANGLE])


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
        _along_angle(control, target, angle, from_abscissa=has_abscissa)
    if cartesian:
        forget_polar(control)
    return Goal(target, in_plane=cartesian > 0, polar=False)


def _polar_target(control: Control, *, arc: bool) -> list[float]:
    plane = control.modal.plane
    if control.active.get("offset") == 53:
        message = "polar coordinates are not allowed while G53 is in force (E1530)"
        control.fail("polar-origin", message, control.words.get("R") or control.words.get("Q"))
    if memory_of(control).part_frame is not None:
        message = "polar coordinates are not allowed while #MCS is in force (E1305)"
        control.fail("polar-origin", message, control.words.get("R") or control.words.get("Q"))
    radius_word, angle_word = control.take("R"), control.take("Q")
    target = control.target()
    seen = (radius_word is not None) + 2 * (angle_word is not None)
    words = (control.length(radius_word), 0.0 if angle_word is None else control.number(angle_word))
    relative = (_counts_on(control, radius_word), _counts_on(control, angle_word))
    radius, angle = changed(seen, current_polar(control), words, relative)
    if radius_word is not None and (radius < 0.0 or (arc and radius == 0.0)):
        message = f"the polar radius {radius:g} must be positive" + ("" if arc else " or 0")
        control.fail("polar-radius", message, radius_word)
    end = point_at(polar_origin(control), plane.point(control.programmed), radius, angle)
    plane.aim(target, end)
    control.registers[POLAR_RADIUS], control.registers[POLAR_ANGLE] = radius, angle
    return target


def _counts_on(control: Control, word: Word | None) -> bool:
    """Whether a word counts from where the tool stands."""
    return control.modal.incremental or (word is not None and word.incremental)


def _along_angle(control: Control, target: list[float], word: Word, *, from_abscissa: bool) -> None:
    """One coordinate and Q: the chord leaves the start in the direction Q."""
    plane = control.modal.plane
    cosine, sine = direction(control.number(word))
    along, across = (cosine, sine) if from_abscissa else (sine, cosine)
    if abs(along) < 1e-9:
        control.fail("chord-angle", "in this direction the coordinate is never reached", word)
    start, end = plane.local(control.programmed), plane.local(target)
    if from_abscissa:
        other = start.ordinate + (end.abscissa - start.abscissa) * across / along
        plane.aim(target, (end.abscissa, other))
    else:
        other = start.abscissa + (end.ordinate - start.ordinate) * across / along
        plane.aim(target, (other, end.ordinate))
