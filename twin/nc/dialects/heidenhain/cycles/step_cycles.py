"""Old cycles whose parameters stand in steps: 1 pecking, 2 tapping, 4 rectangular and 5 circular pocket.

They count from where the tool is when they are called, which is the set-up clearance above the surface (manual).
"""

import re

from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.cycles import holes, pockets
from twin.nc.dialects.heidenhain.cycles.transformations import DefinitionStep
from twin.nc.dialects.heidenhain.memory import CycleParameters, memory_of

_VALUES = re.compile(r"[-+]?[ \t]*(?:[0-9]*\.?[0-9]+|Q[LR]?[0-9]+)(?=[ \t]|$|[A-Z])", re.IGNORECASE)
_STEPS: dict[int, tuple[tuple[int, ...], ...]] = {
    1: ((), (200,), (201,), (202,), (211,), (206,)),
    2: ((), (200,), (201,), (211,), (206,)),
    4: ((), (200,), (201,), (202, 206), (218,), (219,), (207, 220)),
    5: ((), (200,), (201,), (202, 206), (223,), (207,)),
}
"""Which parameter of the newer cycles each value of each step is."""
_NEWER = {
    1: holes.drilling,
    2: holes.tapping,
    4: pockets.rectangular_pocket,
    5: pockets.circular_pocket,
}
_DIAMETER, _CLIMB, _SURFACE, _CLEARANCE = 223, 351, 203, 200


def take(control: Control, step: DefinitionStep) -> None:
    """A step of an old cycle; its last one defines it."""
    memory, steps = memory_of(control), _STEPS[step.cycle]
    if step.step == 0:
        memory.steps, memory.step = {}, 0
        return
    if step.step >= len(steps) or step.step != memory.step + 1:
        message = f"cycle {step.cycle} has the steps .0 to .{len(steps) - 1}, in order"
        step.fail(control, "unreadable-statement", message)
    parameters, found = steps[step.step], list(_VALUES.finditer(step.text))
    if not found:
        step.fail(control, "cycle-word", f"{step.cycle}.{step.step} needs its value")
    for parameter, match in zip(parameters, found, strict=False):
        value, _ = control.statements.operand(step.text, match.start(), step.column)
        memory.steps[parameter] = control.compute(value, step.column + match.start())
    if "DR-" in step.text.upper():
        memory.steps[_CLIMB] = -1.0
    memory.step = step.step
    if step.step == len(steps) - 1:
        _define(control, step.cycle)


def _define(control: Control, cycle: int) -> None:
    memory, newer = memory_of(control), _NEWER[cycle]
    values = dict(memory.steps)
    if _DIAMETER in values:
        values[_DIAMETER] *= 2.0

    def perform(control: Control, given: CycleParameters) -> None:
        surface = control.motion.programmed[2] / given.unit - given.number(_CLEARANCE)
        newer(control, given.replaced({_SURFACE: surface}))

    memory.cycle, memory.calls_always = perform, False
    memory.parameters = CycleParameters(
        f"cycle {cycle}", values, control.modal.unit, control.block.line, live=False
    )
