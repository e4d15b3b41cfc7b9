"""O-words and assignments of LinuxCNC as instructions for the compiled tier: the same as ``flow`` does."""

import re
from collections.abc import Callable

from twin.nc.bytecode.assembler import Assembler, UnsupportedError
from twin.nc.control.block_compiler import BlockCompiler
from twin.nc.control.control import Control
from twin.nc.dialects.linuxcnc import flow
from twin.nc.dialects.linuxcnc.flow import DEEPEST_CALL
from twin.nc.dialects.linuxcnc.memory import memory_of
from twin.nc.dialects.linuxcnc.parameters import LiveParameters
from twin.nc.dialects.linuxcnc.structure import OWord, o_word, scope, structure
from twin.nc.text import arithmetic
from twin.nc.text.blocks import Block, Location, Statement
from twin.nc.text.expressions import NumberedVariable

_INTERPRETED_CALLS = re.compile(rb"_value|M[ \t]*0*7[0-3]", re.IGNORECASE)
"""What tells of a call's end, or acts at it."""
_LIVE = LiveParameters()


def compile_block(compiler: BlockCompiler, block: Block) -> None:
    """Write a block.

    Raises:
        UnsupportedError: It is left to the interpreter tier.
    """
    if block.statement is not None:
        word = o_word(block.statement)
        compile_word = None if word is None else _WORDS.get(word.keyword)
        if word is None or compile_word is None:
            raise UnsupportedError
        flow.check_rest(compiler.control, block.statement, word)
        compile_word(compiler.control, block.statement, word, compiler.assembler)
    elif block.assignments:
        _assign(block, compiler.assembler)
    else:
        compiler.words(block.words)


def _assign(block: Block, assembler: Assembler) -> None:
    if block.words or len(block.assignments) > 1:
        raise UnsupportedError
    (only,) = block.assignments
    if isinstance(only.target, NumberedVariable):
        assembler.value(only.target.index)
        assembler.value(only.value)
        assembler.assign_numbered("#")
    elif only.target.name in _LIVE or only.target.name == "#0":
        raise UnsupportedError
    else:
        assembler.value(only.value)
        assembler.assign(only.target.name)


def _check_label(control: Control, word: OWord) -> None:
    """A label that is given twice is for the interpreter tier, which refuses it."""
    here = control.block.line - 1
    own = scope(control, here)
    same = [
        each
        for each in structure(control).constructs
        if each.name == word.label and scope(control, each.begin) == own
    ]
    if len(same) != 1:
        raise UnsupportedError


def _if(control: Control, statement: Statement, word: OWord, assembler: Assembler) -> None:
    _check_label(control, word)
    construct = flow.construct_of(control, statement, word)
    assembler.value(flow.condition_of(control, word, statement)[0])
    assembler.jump_if(Location(control.block.line, 0))
    for branch in construct.branches:
        if branch.keyword == "ELSE":
            assembler.jump(Location(branch.line + 1, 0))
            return
        other, its = flow.line_of(control, branch.line)
        assembler.value(flow.condition_of(control, its, other)[0])
        assembler.jump_if(Location(branch.line + 1, 0))
    assembler.jump(flow.behind(construct))


def _leave(control: Control, statement: Statement, word: OWord, assembler: Assembler) -> None:
    assembler.jump(flow.behind(flow.construct_of(control, statement, word)))


def _nothing(control: Control, statement: Statement, word: OWord, assembler: Assembler) -> None:
    del assembler
    flow.construct_of(control, statement, word)


def _while(control: Control, statement: Statement, word: OWord, assembler: Assembler) -> None:
    construct = flow.construct_of(control, statement, word)
    assembler.value(flow.condition_of(control, word, statement)[0])
    if construct.keyword == "DO":
        assembler.jump_if(Location(construct.begin + 1, 0))
    else:
        _check_label(control, word)
        assembler.jump_unless(flow.behind(construct))


def _do(control: Control, statement: Statement, word: OWord, assembler: Assembler) -> None:
    _check_label(control, word)
    _nothing(control, statement, word, assembler)


def _again(control: Control, statement: Statement, word: OWord, assembler: Assembler) -> None:
    assembler.jump(Location(flow.construct_of(control, statement, word).begin, 0))


def _end_repeat(control: Control, statement: Statement, word: OWord, assembler: Assembler) -> None:
    construct = flow.construct_of(control, statement, word)
    counter = flow.counter_of(construct)
    assembler.constant(1.0)
    assembler.change(counter, arithmetic.subtract)
    assembler.load(counter)
    assembler.constant(0.0)
    assembler.compute(arithmetic.greater, 2)
    assembler.jump_if(Location(construct.begin + 1, 0))


def _break(control: Control, statement: Statement, word: OWord, assembler: Assembler) -> None:
    assembler.jump(flow.behind(flow.enclosing(control, statement, word)))


def _continue(control: Control, statement: Statement, word: OWord, assembler: Assembler) -> None:
    construct = flow.enclosing(control, statement, word)
    assert construct.end is not None
    assembler.jump(Location(construct.end, 0))


def _is_told(control: Control) -> bool:
    """The program reads what a call has given, or keeps what is in force around it."""
    memory = memory_of(control)
    if memory.tells_calls is None:
        memory.tells_calls = control.program_counter.lines.any_holds(_INTERPRETED_CALLS)
    return memory.tells_calls


def _call(control: Control, statement: Statement, word: OWord, assembler: Assembler) -> None:
    if word.label[0] in "#[" or _is_told(control):
        raise UnsupportedError
    line, here = flow.called_line(control, statement, word), control.block.line - 1
    if here <= line < flow.first_file(control):
        raise UnsupportedError
    names: list[str] = []
    for number, (value, _) in enumerate(flow.arguments(control, statement, word), 1):
        assembler.value(value)
        names.append(f"#{number}")
    assembler.call(Location(line + 1, 0), DEEPEST_CALL, names)


def _return(control: Control, statement: Statement, word: OWord, assembler: Assembler) -> None:
    if _is_told(control) or flow.values_of(control, word, statement):
        raise UnsupportedError
    assembler.check_return()
    assembler.end_call()


_WORDS: dict[str, Callable[[Control, Statement, OWord, Assembler], None]] = {
    "IF": _if,
    "ELSEIF": _leave,
    "ELSE": _leave,
    "ENDIF": _nothing,
    "WHILE": _while,
    "ENDWHILE": _again,
    "DO": _do,
    "ENDREPEAT": _end_repeat,
    "BREAK": _break,
    "CONTINUE": _continue,
    "CALL": _call,
    "ENDSUB": _return,
    "RETURN": _return,
}
"""The others are run once, or round their values."""
