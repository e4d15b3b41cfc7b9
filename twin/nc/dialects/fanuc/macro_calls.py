"""Macro calls of a Fanuc control: G65, G66 and G67, with arguments of both kinds.

A letter gives the variable of its own: A is #1, B #2, C #3, I J K #4 to #6, D #7 and so on. I, J and K
may be written ten times: the second I, or an I behind a J or K, is #7, and so on. The later word wins.
"""

from collections.abc import Iterator

from twin.nc.control.codes import StatementAction
from twin.nc.control.control import Control
from twin.nc.dialects.fanuc import decimal_point
from twin.nc.dialects.fanuc.memory import ModalCall, memory_of
from twin.nc.dialects.fanuc.programs import NAME, line_of, named, program_word, whole
from twin.nc.text.blocks import Location, Statement, Word
from twin.nc.text.expressions.expressions import Expression

_LETTERS = "ABCIJKDEF_H_M___QRSTUVWXYZ"
VARIABLES = {letter: f"#{number}" for number, letter in enumerate(_LETTERS, 1) if letter != "_"}
"""Variables of the letters."""
_REPEATED = "IJK"
_MOST_GROUPS = 10


def _words(control: Control, statement: Statement) -> tuple[Word, ...]:
    """The words behind G65 or G66."""
    blocks = control.statements.blocks(statement.text, statement.text_column, control.block.line)
    if not blocks:
        message = f"{statement.keyword} needs P, the number of the program"
        control.fail("call-values", message, statement, f"{statement.keyword} P1000 A1.")
    if len(blocks) != 1 or blocks[0].statement is not None or blocks[0].assignments:
        control.fail("call-values", f"{statement.keyword} takes words only", statement)
    return blocks[0].words


def _arguments(control: Control, words: tuple[Word, ...]) -> Iterator[tuple[str, Word]]:
    """The variables that words set, each with its word."""
    group, last = 0, -1
    for word in words:
        if word.address in ("P", "L", NAME):
            continue
        if word.address in _REPEATED:
            place = _REPEATED.index(word.address)
            if place <= last:
                group += 1
            last = place
            if group >= _MOST_GROUPS:
                message = f"{word.address} occurs more than {_MOST_GROUPS} times"
                control.fail("call-values", message, word)
            yield f"#{4 + 3 * group + place}", word
        elif word.address in VARIABLES:
            yield VARIABLES[word.address], word
        else:
            known = " ".join(VARIABLES)
            message = f"{word.address} gives a macro no value"
            control.fail("call-values", message, word, f"letters of arguments: {known}")


def _one(control: Control, words: tuple[Word, ...], address: str) -> Word | None:
    found = [word for word in words if word.address == address]
    if len(found) > 1:
        control.fail("duplicate-word", f"'{address}' occurs twice in the block", found[1])
    return found[0] if found else None


def _call(control: Control, statement: Statement) -> None:
    """G65 P L, G65 <NAME> L: run a program with variables of its own."""
    _run(control, _modal_call(control, statement), statement)


def _modal_call(control: Control, statement: Statement) -> ModalCall:
    """What G65 or G66 asks for, computed."""
    words = _words(control, statement)
    by_number, by_name, often = (_one(control, words, each) for each in ("P", NAME, "L"))
    program = program_word(control, statement.keyword, (by_number, by_name), statement)
    if program.mark:
        key = named(control, program)
    else:
        key = whole(control, _computed(control, program), "call-values", "program number")
    count = 1
    if often is not None:
        count = whole(control, _computed(control, often), "repeat-count", "count")
        if count < 1:
            control.fail("repeat-count", "a program runs once at least", often)
    values: dict[str, float] = {}
    for name, word in _arguments(control, words):
        values[name] = control.number(_computed(control, decimal_point.argument(control, word)))
    return ModalCall(line_of(control, key, program), count, values, program)


def _computed(control: Control, word: Word) -> Word:
    if isinstance(word.value, Expression):
        return word._replace(value=control.compute(word.value, word))
    return word


def _run(control: Control, asked: ModalCall, error_at: Word | Statement) -> None:
    deepest, values = memory_of(control).variant.deepest_call, asked.values.items()
    control.call(Location(asked.line, 0), deepest, error_at, values, times=float(asked.often))


def call_modally(control: Control, statement: Statement) -> None:
    """G66 P L, G66 <NAME> L: run a program behind every block that moves, until G67."""
    memory = memory_of(control)
    if memory.modal_call is not None:
        message = "a modal call is in force already, and one within another is not simulated"
        control.fail("call-values", message, statement, "end it by G67 first")
    memory.modal_call = _modal_call(control, statement)
    memory.modal_depth = control.program_counter.depth
    control.modal.active.put("modal call", 66.0)


def end_modal_call(control: Control) -> None:
    """G67."""
    memory_of(control).modal_call = None


def call_after_motion(control: Control) -> None:
    """The modal call, when a block of its own program has moved."""
    memory = memory_of(control)
    depth = control.program_counter.depth
    if memory.modal_call is not None and depth == memory.modal_depth:
        _run(control, memory.modal_call, memory.modal_call.word)


def refuse_late_call(control: Control) -> None:
    """G65 or G66 behind other words."""
    word = control.codes[-1][0]
    message = f"{word.text} must stand before the other words of its block"
    control.fail("call-values", message, word, "write the other codes in a block before it")


CALLS_BY_CODE: dict[str, StatementAction] = {
    "G65": _call,
    "G66": call_modally,
}
