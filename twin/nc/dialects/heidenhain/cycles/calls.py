"""Calls of the cycle that was defined last: CYCL CALL, CYCL CALL POS, CYCL CALL PAT, M99, M89."""

from twin.nc.control.codes import Interpolation
from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.memory import CycleParameters, memory_of
from twin.nc.dialects.heidenhain.paths.paths import LINE
from twin.nc.iso.cycle_moves import go_to_height
from twin.nc.text.blocks import Statement

HEIGHT = 2
"""Column of the tool axis."""
SURFACE, SECOND_CLEARANCE, CLEARANCE, DEPTH = 203, 204, 200, 201


def call_cycle(control: Control) -> None:
    """M99, or CYCL CALL: the cycle runs where the tool is."""
    parameters = defined(control)
    if control.path.compensation.in_force or control.path.leads is not None:
        message = "a cycle is not called while radius compensation is in force"
        control.fail("compensation-change", message, hint="end it by R0 before")
    _run(control, parameters)


def _run(control: Control, parameters: CycleParameters) -> None:
    """Run the cycle that was defined last; a depth of 0 runs nothing (manual)."""
    if parameters.values.get(DEPTH) == 0.0:
        control.report.warn(
            "cycle-depth", f"{parameters.name} does nothing: its depth Q{DEPTH} is 0"
        )
        return
    cycle = memory_of(control).cycle
    assert cycle is not None
    cycle(control, parameters)


def call_from_now_on(control: Control) -> None:
    """M89: the cycle runs behind every block that moves, the one of M89 included."""
    memory_of(control).calls_always = True


def call_last(control: Control) -> None:
    """M99: the cycle runs once, which also ends M89."""
    memory_of(control).calls_always = False
    call_cycle(control)


def after_block(control: Control, start: list[float]) -> None:
    """A block of a path has run that began at a position: M89 calls the cycle where it has moved."""
    if memory_of(control).calls_always and control.motion.programmed[:2] != start[:2]:
        call_cycle(control)


def call_here(control: Control, statement: Statement) -> None:
    """CYCL CALL, with M functions."""
    control.run(control.block._replace(statement=None))
    memory_of(control).rapid = False
    control.block = control.block._replace(statement=statement)
    call_cycle(control)


def call_at(control: Control, statement: Statement) -> None:
    """CYCL CALL POS: over the place, then the cycle there; Z raises its surface (manual)."""
    memory, modal = memory_of(control), control.modal

    def go(control: Control) -> None:
        word = control.take("Z")
        raised = 0.0 if word is None else control.axis_value(HEIGHT, word)
        target = control.target()
        parameters = defined(control)
        clearance = parameters.length(SURFACE) + parameters.length(CLEARANCE) + raised
        go_over(control, target, clearance, rapid=memory.rapid)
        run_raised(control, raised)

    modal.interpolation = Interpolation(go)
    control.run(control.block._replace(statement=None))
    modal.interpolation, memory.rapid = LINE, False
    if not control.axis_letters & {word.address for word in control.block.words}:
        control.fail("missing-words", "CYCL CALL POS needs the place of its cycle", statement)


def call_pattern(control: Control, statement: Statement) -> None:
    """CYCL CALL PAT: the cycle at every place of PATTERN DEF."""
    memory = memory_of(control)
    control.run(control.block._replace(statement=None))
    memory.rapid = False
    if not memory.pattern:
        hint = "write PATTERN DEF POS1 (X+10 Y+20 Z+0) before"
        control.fail("cycle-call", "no pattern is defined", statement, hint)
    parameters = defined(control)
    second = max(parameters.length(SECOND_CLEARANCE), parameters.length(CLEARANCE))
    for x, y, z in memory.pattern:
        target = [x, y, *control.motion.programmed[2:]]
        go_over(control, target, parameters.length(SURFACE) + second + z, rapid=True)
        run_raised(control, z)


def defined(control: Control) -> CycleParameters:
    """The parameters of the cycle that was defined last, as Q parameters have them now."""
    parameters = memory_of(control).parameters
    if parameters is None:
        hint = "write CYCL DEF 200 before; cycles such as 7, 10, 220 act where they are defined"
        control.fail("cycle-call", "no cycle is defined that could be called", hint=hint)
    if not parameters.live:
        return parameters
    now = {each: control.variables.read(f"Q{each}") for each in parameters.values}
    return parameters.replaced({each: value for each, value in now.items() if value is not None})


def go_over(control: Control, target: list[float], height: float, *, rapid: bool) -> None:
    """Go over a place, never below a height; where the tool is higher it stays so high."""
    go_to_height(control, max(control.motion.programmed[HEIGHT], height))
    there = list(target)
    there[HEIGHT] = control.motion.programmed[HEIGHT]
    control.line_to(there, rapid=rapid)


def run_raised(control: Control, raised: float, *, second: bool = True) -> None:
    """Run the cycle with its surface raised [mm]; without ``second`` it ends at the first clearance."""
    parameters = defined(control)
    surface = parameters.number(SURFACE) + raised / parameters.unit
    changed = {SURFACE: surface, **({} if second else {SECOND_CLEARANCE: 0.0})}
    _run(control, parameters.replaced(changed))
