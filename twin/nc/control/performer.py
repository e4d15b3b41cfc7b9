"""Does at once what codes, words and statements say as instructions: the interpreter tier's assembler.

What an instruction does, ``bytecode`` says for both tiers.
"""

import contextlib
from collections.abc import Callable
from typing import NoReturn

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import Assembler, Finding, Otherwise, Target, found
from twin.nc.bytecode.bytecode import MOST_VALUES, Instruction, number_of_location
from twin.nc.bytecode.effects import BlockPlace
from twin.nc.bytecode.flow import keep_codes, straight_on
from twin.nc.bytecode.frames import CALLS, DEPTH, go_to
from twin.nc.bytecode.instructions import Surroundings, run_instruction
from twin.nc.bytecode.variables import store
from twin.nc.control.compensation import compensate
from twin.nc.control.control import Control
from twin.nc.text.blocks import Word
from twin.nc.text.expressions import Computed, Expression, Number, Tree


def refuse(
    control: Control,
    finding: Finding,
    word: Word | None = None,
    span: tuple[int, int] | None = None,
) -> NoReturn:
    """Say what is wrong with an effect, or with an action that follows the same rule.

    Args:
        control: Whose block it is.
        finding: What is wrong.
        word: What the instruction was given.
        span: Column and width of what is blamed where no word is; None: what a control blames.

    Raises:
        ProgramError: Always.
    """
    message = finding.message.format(word="" if word is None else word.text)
    if span is None or (finding.blames_word and word is not None):
        blamed = word if finding.blames_word else None
        control.fail(finding.code, message, blamed, finding.hint)
    control.report.fail(finding.code, message, *span, finding.hint)


class _Gone(Exception):  # noqa: N818 (nothing is wrong)
    """The program goes on elsewhere: what the block says behind that is not done."""


def perform(control: Control, write: Callable[[Assembler], None], span: tuple[int, int]) -> None:
    """Do at once what a block says as instructions.

    Args:
        control: Whose block it is.
        write: Says it.
        span: Column and width of what is blamed where nothing else is to blame.
    """
    with contextlib.suppress(_Gone):
        write(Performer(control, span))


class Performer(Assembler):
    """Runs the instructions of one block; arguments as for ``perform``."""

    def __init__(self, control: Control, span: tuple[int, int]) -> None:
        counter = control.program_counter
        self._span = span
        self._control = control
        self._stack = [0.0] * MOST_VALUES
        self._top = 0
        self._word: Word | None = None
        self._to = straight_on(counter.progress, number_of_location(counter.location))

    def _slot(self, name: str) -> int:
        return self._control.variables.slot(name)

    def _push(self, value: float) -> None:
        self._stack[self._top] = value
        self._top += 1

    def _pop(self) -> float:
        self._top -= 1
        return self._stack[self._top]

    def value(self, expression: Expression | Tree, column: int = 0) -> None:
        """Put a value on the stack; it stands in this column."""
        self._push(self._control.compute(expression, column))

    def word_value(self, word: Word | None, default: float = 0.0) -> None:
        """Put the value of a word on the stack, or of a missing one a default."""
        self._word = self._word if word is None else word
        if word is None:
            self._push(default)
        elif isinstance(word.value, Expression):
            self._push(self._control.evaluate(word.value, word))
        else:
            self._push(word.value)

    def known(self, word: Word) -> float:
        """The value of a word."""
        return self._control.number(word)

    def interpreted(self, action: Callable[[], None]) -> None:
        """Do what has no instruction."""
        action()

    def assign(self, name: str, *, undeclared: str | None = None) -> None:
        """The topmost value goes to a variable.

        Raises:
            ProgramError: It must have a value already, and has none.
        """
        if undeclared is not None and self._control.variables.read(name) is None:
            self._fail("unknown-variable", f"{name} is not declared", undeclared)
        super().assign(name)

    def assign_numbered(self, name: str) -> None:
        """The topmost value goes to the variable whose number lies below it.

        Raises:
            ProgramError: That is no number of a variable.
        """
        value, index = self._pop(), self._pop()
        if index < 0.0 or index != int(index):
            self._fail("parameter-number", f"there is no parameter {name}[{index:g}]")
        self._control.variables.write(f"{name}{int(index)}", value)

    def jump_if(self, location: Target) -> None:
        """Jump to a location, which is looked for only now, if the topmost value is true."""
        if self._pop():
            self.jump(found(location))

    def disturbed(self, action: Callable[[], None]) -> None:
        """Do it."""
        action()

    def compute(self, function: Callable[..., float]) -> None:
        """Replace the topmost values by a function of them."""
        self._top -= function.__code__.co_argcount
        values = self._stack[self._top : self._top + function.__code__.co_argcount]
        tree = Computed(function.__name__, function, tuple(map(Number, map(float, values))))
        self.value(tree, self._span[0])

    def emit(self, opcode: int, operand: int = 0) -> None:
        """Run one of the instructions that do more than compute, move and jump."""
        if opcode == opcodes.COMPENSATE:
            compensate(self._control, float(operand), float(self._pop()))
        elif opcode == opcodes.END_COMPENSATION:
            self._control.path.end_compensation()
        elif opcodes.REGISTER <= opcode <= opcodes.EMPTY_REGISTER:
            self._add(opcode, operand)
        else:
            self._control.begin_effect()
            self._add(opcode, operand)
            self._control.end_effect()

    def check(
        self, check: int, otherwise: Otherwise, bound: float = 0.0, blamed: Word | None = None
    ) -> None:
        """The topmost value must be as a check says.

        Raises:
            ProgramError: It is not.
        """
        if self._run(Instruction(opcodes.CHECK, check, bound)):
            return
        if isinstance(otherwise, Finding):
            refuse(self._control, otherwise, blamed or self._word, self._span)
        otherwise()

    def _add(self, opcode: int, operand: int = 0, immediate: float = 0.0) -> None:
        if opcode == opcodes.STORE:
            store(self._control.variables.columns, self._to.depth, operand, self._pop())
            return
        if opcode == opcodes.CHECK_CALL:
            self._control.variables.make_room(self._to.depth + 1)
        instruction = Instruction(opcode, operand, immediate)
        if not self._run(instruction):
            self._refuse(instruction)
        if self._to.ends:
            self._leave(opcode)

    def _run(self, instruction: Instruction) -> bool:
        """Run an instruction; whether nothing is wrong."""
        control = self._control
        around = Surroundings(
            control.variables.columns,
            control.program_counter.calls,
            BlockPlace(control.block.line, 0, control.path.compensating),
            control.affected,
        )
        top, to = run_instruction(instruction, self._stack, self._top, self._to, around)
        if top >= 0:
            self._top, self._to = top, to
        return top >= 0

    def _leave(self, opcode: int) -> NoReturn:
        """The program goes on where the block leads."""
        control, counter, to = self._control, self._control.program_counter, self._to
        go_to(to.going, counter.progress)
        counter.progress[DEPTH], counter.progress[CALLS] = to.depth, to.called
        keep_codes(opcode, to, control.state.modal, control.modal_of_calls)
        if control.modal.cycle is None:
            control.forget_cycle()
        raise _Gone

    def _refuse(self, instruction: Instruction) -> NoReturn:
        """Say why an instruction that jumps, counts or calls cannot be run.

        Raises:
            ProgramError: Always.
        """
        if instruction.opcode in (opcodes.BEGIN_FOR, opcodes.STEP_FOR):
            self._fail("structure", "a step of 0 never ends")
        if instruction.opcode == opcodes.CHECK_CALL:
            self._fail("call-depth", f"more than {instruction.operand} calls within calls")
        if instruction.opcode == opcodes.CHECK_RETURN:
            self._fail("return-outside", "there is no subroutine to return from")
        self._fail("repeat-range", "the range or the number of runs is none")

    def _fail(self, code: str, message: str, hint: str | None = None) -> NoReturn:
        self._control.report.fail(code, message, *self._span, hint)
