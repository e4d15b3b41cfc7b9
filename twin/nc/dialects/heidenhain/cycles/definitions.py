"""CYCL DEF: which cycles there are (``cycles.toml``), what each is given, and what it does."""

import re
import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from twin.nc.control.control import Control
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
from twin.nc.dialects.heidenhain.cycles.transformations import DefinitionStep
from twin.nc.dialects.heidenhain.memory import CycleParameters, memory_of
from twin.nc.text.blocks import Statement, Word

Perform = Callable[[Control, CycleParameters], None]

_NUMBER = re.compile(r"[ \t]*([0-9]{1,3})(?:[ \t]*\.[ \t]*([0-9]{1,2}))?(?![0-9])[ \t]*")


class Definition(NamedTuple):
    """One cycle.

    Attributes:
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


_OF_BUILDERS = range(300, 400)
"""Numbers that the manuals leave to the machine's builder."""
_FILE = Path(__file__).with_name("cycles.toml")
_MODULES = (holes, patterns, pockets, threads)


def _performing(name: str) -> Perform:
    """The function of a cycle, by its name."""
    return next(getattr(module, name) for module in _MODULES if hasattr(module, name))


def _definition(data: Mapping[str, Any]) -> Definition:
    only = {int(number): value for number, value in data.get("only", {}).items()}
    return Definition(
        data["meaning"],
        _performing(data["perform"]),
        tuple(data["needed"]),
        tuple(data.get("others", ())),
        data.get("acts", False),
        only,
    )


_DATA = tomllib.loads(_FILE.read_text(encoding="utf-8"))
MEANINGS: Mapping[int, str] = {int(number): said for number, said in _DATA["parameters"].items()}
"""What the parameters of cycles are."""
DEFINITIONS: Mapping[int, Definition] = {
    int(number): _definition(data) for number, data in _DATA["cycles"].items()
}
"""Cycles with Q parameters."""
REFUSED: Mapping[int, str] = {
    int(number): said for numbers, said in _DATA["refused"].items() for number in numbers.split(",")
}
"""Cycles that the control knows and the twin does not follow."""
STEPS: Mapping[int, Callable[[Control, DefinitionStep], None]] = {
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
        STEPS[number](control, DefinitionStep(number, step, text.rstrip("~ \t"), column))
        return
    definition = DEFINITIONS.get(number)
    if number != 247 and definition is None:
        near = sorted({*STEPS, *DEFINITIONS, 247}, key=lambda each: abs(each - number))[:5]
        known = ", ".join(map(str, sorted(near)))
        message = f"there is no cycle {number}"
        hint = f"cycles near it: {known}; all of them: twin dialects heidenhain"
        if number in _OF_BUILDERS:
            message = (
                f"cycle {number} is one of the machine's builder, and what it does is not known"
            )
            hint = "leave it out where it moves nothing, with its Q lines; else write its moves"
        control.report.fail("unsupported-cycle", message, statement.text_column, match.end(), hint)
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
        first = missing[0].split()[0]
        hint = f"{name.upper().replace('CYCLE', 'CYCL DEF')} ~, and {first}=2 in a line below"
        control.fail("cycle-word", f"{name} needs {', '.join(missing)}", statement, hint)
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
