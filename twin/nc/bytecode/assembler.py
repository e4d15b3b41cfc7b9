"""The vocabulary in which codes, words and statements of a dialect say what they do: instructions.

An assembler of the compiled tier writes them down; that of the interpreter tier does each at once.
"""

import abc
from collections.abc import Callable, Iterable
from typing import NamedTuple

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.bytecode import number_of_location
from twin.nc.text.blocks import Location, Word
from twin.nc.text.expressions import Expression, Tree, Variable

Target = Location | Callable[[], Location]
"""Where a jump leads, or what finds that when the jump is taken."""


class UnsupportedError(Exception):
    """The block is left to the interpreter tier."""


class Finding(NamedTuple):
    """What is said where a check does not hold.

    Attributes:
        code: Of the diagnostic.
        message: ``{word}`` stands for the word that is to blame.
        hint: What would have worked.
        blames_word: A word is to blame, else the block.
    """

    code: str
    message: str
    hint: str | None = None
    blames_word: bool = True


Otherwise = Finding | Callable[[], None]
"""What the interpreter tier says or does where a check does not hold."""


class Assembler(abc.ABC):
    """Takes the instructions of one block."""

    @abc.abstractmethod
    def _add(self, opcode: int, operand: int = 0, immediate: float = 0.0) -> None:
        """Take an instruction."""

    @abc.abstractmethod
    def _slot(self, name: str) -> int:
        """The slot of a variable."""

    # --- values

    @abc.abstractmethod
    def value(self, expression: Expression | Tree, column: int = 0) -> None:
        """Put a value on the stack; it stands in this column.

        Raises:
            UnsupportedError: The compiled tier does not know how to compute it.
            ProgramError: It cannot be computed.
        """

    @abc.abstractmethod
    def word_value(self, word: Word | None, default: float = 0.0) -> None:
        """Put the value of a word on the stack, or of a missing one a default; as ``value``."""

    def constant(self, value: float) -> None:
        """Put a number on the stack."""
        self._add(opcodes.CONSTANT, 0, value)

    def drop(self) -> None:
        """Take the topmost value off the stack."""
        self._add(opcodes.DROP)

    @abc.abstractmethod
    def compute(self, function: Callable[..., float]) -> None:
        """Replace the topmost values by a function of them; as ``value``."""

    @abc.abstractmethod
    def emit(self, opcode: int, operand: int = 0) -> None:
        """Take one of the instructions that do more than compute, move and jump."""

    # --- registers

    def register(self, place: int) -> None:
        """Put a register on the stack."""
        self.emit(opcodes.REGISTER, place)

    def set_register(self, place: int) -> None:
        """The topmost value becomes a register."""
        self.emit(opcodes.SET_REGISTER, place)

    def empty_register(self, place: int) -> None:
        """A register has no value from here on."""
        self.emit(opcodes.EMPTY_REGISTER, place)

    @abc.abstractmethod
    def check(
        self, check: int, otherwise: Otherwise, bound: float = 0.0, blamed: Word | None = None
    ) -> None:
        """The topmost value, which stays, must be as a check says.

        Args:
            check: One of those of ``opcodes``.
            otherwise: What follows where it is not.
            bound: ``immediate`` of the check.
            blamed: The word to blame; None: that of the topmost value.
        """

    @abc.abstractmethod
    def interpreted(self, action: Callable[[], None]) -> None:
        """What only the interpreter tier can do.

        Raises:
            UnsupportedError: This is the compiled tier.
        """

    def rare(self) -> None:
        """Leave the block to the interpreter tier; nothing where this is it already."""
        self.interpreted(lambda: None)

    @abc.abstractmethod
    def disturbed(self, action: Callable[[], None]) -> None:
        """What matters only where ``Dialect.disturbed`` keeps the compiled tier from running."""

    @abc.abstractmethod
    def known(self, word: Word) -> float:
        """The value of a word that must be known before the block is run.

        Raises:
            UnsupportedError: It is computed, and this is the compiled tier.
        """

    # --- variables

    def assign(self, name: str, *, undeclared: str | None = None) -> None:
        """The topmost value goes to a variable.

        Args:
            name: The variable.
            undeclared: It must have a value already, and this is a hint where it has none.
        """
        opcode = opcodes.STORE if undeclared is None else opcodes.STORE_DECLARED
        self._add(opcode, self._slot(name))

    @abc.abstractmethod
    def assign_numbered(self, name: str) -> None:
        """The topmost value goes to the variable whose number lies below it."""

    def begin_for(self, name: str, behind: Location) -> None:
        """First, last and step are on the stack: a counted loop begins, or ends at once."""
        self._add(opcodes.BEGIN_FOR)
        self.assign(name)
        self.jump_if(behind)

    def step_for(self, name: str, again: Location) -> None:
        """First, last and step are on the stack: a counted loop goes on."""
        self.value(Variable(name))
        self._add(opcodes.STEP_FOR)
        self.assign(name)
        self.jump_if(again)

    # --- flow

    def jump(self, location: Location) -> None:
        """Jump to a location."""
        self._add(opcodes.JUMP, number_of_location(location))

    def jump_if(self, location: Target) -> None:
        """Jump to a location if the topmost value is true."""
        self._add(opcodes.JUMP_IF, number_of_location(found(location)))

    def jump_unless(self, location: Location) -> None:
        """Jump to a location unless the topmost value is true."""
        self._add(opcodes.JUMP_UNLESS, number_of_location(location))

    def jump_case(self, location: Location) -> None:
        """Jump to a location if the topmost value equals the one below, which stays."""
        self._add(opcodes.JUMP_CASE, number_of_location(location))

    def jump_counted(self, location: Target, counter: str, times: float) -> None:
        """Go on at a location so many times; then on, and the counter begins anew."""
        self._add(opcodes.COUNT_DOWN, self._slot(counter), times)
        self.jump_if(location)

    def call(
        self,
        location: Location,
        deepest: int,
        own: Iterable[str] | None = None,
        *,
        restores: bool = False,
        often: bool = False,
    ) -> None:
        """Run the part that begins at a location and ends by a word.

        Args:
            location: Where it begins.
            deepest: Parts that may call each other.
            own: Its own variables, which get the topmost values; None: it has the caller's.
            restores: Its end puts back into force what is in force now.
            often: The value below those of its own variables says how often it runs.
        """
        self._add(opcodes.CHECK_CALL, deepest)
        if own is not None:
            self._add(opcodes.OWN_VARIABLES)
            done: set[str] = set()
            for name in reversed(list(own)):
                if name in done:
                    self.drop()
                else:
                    self.assign(name)
                done.add(name)
        if restores:
            self._add(opcodes.RESTORE_CODES)
        self._add(opcodes.REPEAT if often else opcodes.CALL, number_of_location(location))

    def repeat(self, first: Location, last: Location, deepest: int) -> None:
        """Run a range as often as the topmost value says."""
        self._add(opcodes.CHECK_CALL, deepest)
        self._add(opcodes.RANGE, number_of_location(last))
        self._add(opcodes.REPEAT, number_of_location(first))

    def check_return(self) -> None:
        """What ``go_back`` needs, to be written before anything that cannot be undone."""
        self._add(opcodes.CHECK_RETURN)

    def end_call(self) -> None:
        """Go on behind the call."""
        self._add(opcodes.RETURN)


def found(target: Target) -> Location:
    """Where a jump leads."""
    return target if isinstance(target, Location) else target()
