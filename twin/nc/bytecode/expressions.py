"""How expressions are computed: instructions in the order of their values, for both tiers.

The interpreter tier runs them on a list, and looks variables up by name; the compiled tier has them as
rows of its table. The operators and functions of ``text/arithmetic`` go by number.
"""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from twin.compilation.compilable import compilable_choice, inlined
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.bytecode import Instruction
from twin.nc.canonical import FloatArray
from twin.nc.text import arithmetic
from twin.nc.text.expressions import (
    LARGEST_NUMBER,
    Computed,
    Exists,
    Expression,
    ExpressionError,
    Negative,
    Number,
    NumberedVariable,
    OrZero,
    Scope,
    Tree,
    Variable,
)

Function = Callable[..., float]
Stack = list[float] | FloatArray

UNDEFINED, TOO_LARGE = -4, -5
"""Instead of the number of values: an operator or a function has no value there; one that is no
coordinate, count or feed."""

_OF_MATH: tuple[tuple[Function, ...], ...] = (
    (
        math.sin,
        math.cos,
        math.tan,
        math.asin,
        math.acos,
        math.atan,
        math.fabs,
        math.sqrt,
        math.exp,
        math.log,
        math.log10,
    ),
    (math.fmod, math.pow),
    (),
)
"""Functions of one, two and three values besides those of ``arithmetic``."""


def _functions(values: int) -> list[Function]:
    """All that take so many values."""
    named = (each for name, each in vars(arithmetic).items() if not name.startswith("_"))
    own = [each for each in named if getattr(each, "__module__", "") == arithmetic.__name__]
    return [*(each for each in own if each.__code__.co_argcount == values), *_OF_MATH[values - 1]]


FUNCTIONS = (_functions(1), _functions(2), _functions(3))
"""Functions of one, two and three values; those of other packages' dialects join them behind."""
_NUMBERS: list[dict[Function, int]] = [
    {function: number for number, function in enumerate(each)} for each in FUNCTIONS
]
_COMPILED = tuple(map(len, FUNCTIONS))

unary, binary, ternary = map(compilable_choice, FUNCTIONS)
"""The functions with these numbers; the number is the first argument."""


class Operation(NamedTuple):
    """One instruction of an expression.

    Attributes:
        opcode: One from ``LOAD`` to ``DEFINED``, or from ``CONSTANT`` to ``TERNARY``.
        operand: Number of a function.
        immediate: A constant; of a variable the value where it has none, NaN: none either.
        name: Of the variable, of the operator or of the function.
        inner: What ``DEFINED`` asks of.
    """

    opcode: int
    operand: int = 0
    immediate: float = math.nan
    name: str = ""
    inner: "tuple[Operation, ...]" = ()

    @property
    def values(self) -> int:
        """How many values its function takes; below 1: it has none."""
        return self.opcode - opcodes.UNARY + 1

    @property
    def has_compiled_form(self) -> bool:
        """Whether kernels know its function."""
        return self.values < 1 or self.operand < _COMPILED[self.values - 1]


def code_of(tree: Tree) -> tuple[Operation, ...]:
    """The instructions that put the value of an expression on the stack."""
    match tree:
        case Number(value):
            return (Operation(opcodes.CONSTANT, immediate=value),)
        case Variable(name):
            return (Operation(opcodes.LOAD, name=name),)
        case NumberedVariable(name, index):
            return (*code_of(index), Operation(opcodes.LOAD_NUMBERED, name=name))
        case OrZero(operand):
            *index, load = code_of(operand)
            return (*index, load._replace(immediate=0.0))
        case Negative(operand):
            return (*code_of(operand), Operation(opcodes.NEGATE))
        case Exists(operand):
            return (Operation(opcodes.DEFINED, inner=code_of(operand)),)
        case Computed(what, compute, operands):
            values = (each for operand in operands for each in code_of(operand))
            return (*values, _operation(compute, len(operands), what))


def operation_of(function: Function) -> Operation:
    """The instruction that replaces the topmost values by a function of them."""
    return _operation(function, function.__code__.co_argcount, function.__name__)


def _operation(function: Function, values: int, name: str) -> Operation:
    functions, numbers = FUNCTIONS[values - 1], _NUMBERS[values - 1]
    if function not in numbers:
        numbers[function] = len(functions)
        functions.append(function)
    return Operation(opcodes.UNARY + values - 1, numbers[function], name=name)


def evaluate(expression: Expression | Tree, scope: Scope) -> float:
    """The value of an expression, at the interpreter tier.

    Raises:
        ExpressionError: It has none.
    """
    if not isinstance(expression, Expression):
        return _run(code_of(expression), scope)
    if not expression.code:
        expression.code.extend(code_of(expression.tree))
    return _run(expression.code, scope)


def _run(code: Sequence[Operation], scope: Scope) -> float:
    stack, top = [0.0] * len(code), 0
    for each in code:
        if opcodes.LOAD <= each.opcode <= opcodes.DEFINED:
            top = _load(each, stack, top, scope)
            continue
        after = compute_value(each, stack, top)
        if after == UNDEFINED:
            raise ExpressionError.undefined(each.name, stack[top - each.values : top])
        if after == TOO_LARGE:
            raise ExpressionError.too_large()
        top = after
    return stack[0]


def _load(operation: Operation, stack: list[float], top: int, scope: Scope) -> int:
    """Put a variable on the stack, or whether a value is there; how many values there are then."""
    if operation.opcode == opcodes.DEFINED:
        try:
            _run(operation.inner, scope)
        except ExpressionError:
            stack[top] = 0.0
        else:
            stack[top] = 1.0
        return top + 1
    index = None
    if operation.opcode == opcodes.LOAD_NUMBERED:
        top -= 1
        index = stack[top]
    value = float(scope.read_variable(operation.name, index))
    stack[top] = value if value == value else operation.immediate
    return top + 1


@inlined
def compute_value(instruction: Instruction | Operation, stack: Stack, top: int) -> int:
    """Run an instruction that computes of nothing but values on the stack.

    Args:
        instruction: ``CONSTANT``, ``DROP``, or one from ``NEGATE`` to ``TERNARY``.
        stack: Values.
        top: How many there are.

    Returns:
        How many there are then; ``UNDEFINED`` or ``TOO_LARGE`` with the stack untouched. A value that
        is not there (NaN) stays so.
    """
    opcode, operand = instruction.opcode, instruction.operand
    if opcode == opcodes.CONSTANT:
        stack[top] = instruction.immediate
        return top + 1
    if opcode == opcodes.DROP:
        return top - 1
    if opcode == opcodes.NEGATE:
        stack[top - 1] = -stack[top - 1]
        return top
    place = top - 1 - (opcode - opcodes.UNARY)
    if opcode == opcodes.BINARY:
        value = binary(operand, stack[place], stack[place + 1])
    elif opcode == opcodes.UNARY:
        value = unary(operand, stack[place])
    else:
        value = ternary(operand, stack[place], stack[place + 1], stack[place + 2])
    if not abs(value) <= LARGEST_NUMBER:
        if value == value:
            return TOO_LARGE
        if stack[place] == stack[place]:
            return UNDEFINED
    stack[place] = value
    return place + 1
