"""Program flow of Fanuc's custom macro B: IF GOTO, IF THEN, GOTO, WHILE DO END."""

import re

from twin.nc.control.codes import StatementAction
from twin.nc.control.constructs import Construct, Structure
from twin.nc.control.control import Control
from twin.nc.dialects.fanuc.macros.variables import write_variable
from twin.nc.dialects.fanuc.memory import holds_any, letter_patterns, memory_of
from twin.nc.dialects.fanuc.programs import lines_around
from twin.nc.text.blocks import Assignment, Block, Location, Statement, assignment_of
from twin.nc.text.expressions.expressions import Expression, Number, NumberedVariable, Variable
from twin.nc.text.lines import Lines

PATTERN = (
    r"IF(?=[ \t]*\[)|WH(?:ILE)?(?=[ \t]*\[)|GOTO(?![A-Z])|DO(?=[ \t]*[0-9])|END(?=[ \t]*[0-9])"
    r"|G6[56](?![0-9.])|DPRNT(?=\[)|BPRNT(?=\[)|POPEN|PCLOS|SETVN(?![A-Z])"
)
"""What begins a statement."""
DEEPEST_LOOP = 3
_LOOP = re.compile(
    r"[ \t]*/?[1-9]?[ \t]*(?:N[ \t]*[0-9]+[ \t]*)?"
    r"(?:(?:WH(?:ILE)?[^(]*\][ \t]*)?DO[ \t]*(?P<begin>[0-9]+)|END[ \t]*(?P<end>[0-9]+))",
    re.IGNORECASE,
)
_LOOP_SOMEWHERE = letter_patterns("D", rb"[Oo][ \t]*[0-9]")
_DO = re.compile(r"[ \t]*DO[ \t]*([0-9]+)[ \t]*\Z", re.IGNORECASE)
_COUNT = re.compile(r"[ \t]*([0-9]+)[ \t]*\Z")
_NAMED_BLOCK = re.compile(r"[ \t]*N[ \t]*([0-9]+)", re.IGNORECASE)
_BEHIND_CONDITION = re.compile(r"[ \t]*(GOTO|THEN)(?![A-Z])", re.IGNORECASE)
_EQUALS = re.compile(r"[ \t]*=")


def loops_of(lines: Lines, headings: list[int]) -> Structure:
    """The loops of a file; those without an end stay open."""
    loops = Structure({"END": "DO"})
    if not holds_any(lines, _LOOP_SOMEWHERE):
        return loops
    begins = set(headings)
    for line, text in enumerate(lines):
        if line in begins:
            loops.close()
        match = _LOOP.match(text)
        if match is not None:
            keyword = "DO" if match["begin"] else "END"
            loops.add(keyword, line, str(int(match["begin"] or match["end"])))
    return loops


def _loops(control: Control) -> Structure:
    memory = memory_of(control)
    if memory.loops is None:
        memory.loops = loops_of(control.program_counter.lines, memory.headings)
    return memory.loops


def _loop(control: Control, statement: Statement) -> Construct:
    """The loop that the block begins or ends."""
    loop = _loops(control).by_line.get(control.block.line - 1)
    if loop is None or loop.end is None:
        message = f"{statement.keyword} has no counterpart"
        hint = "DO1 ends at END1 of its program, and loops do not cross"
        control.fail("open-structure", message, statement, hint)
    if not 1 <= int(loop.name) <= DEEPEST_LOOP or loop.depth > DEEPEST_LOOP:
        message = f"loops are numbered 1 to {DEEPEST_LOOP}, and no more lie within each other"
        control.fail("structure", message, statement)
    return loop


def _operand(control: Control, statement: Statement, at: int) -> tuple[Expression, int]:
    """The operand at a place of a statement's text, and where it ends."""
    return control.statements.operand(statement.text, at, statement.text_column)


def _while(control: Control, statement: Statement) -> None:
    """WHILE [...] DO1: run the blocks up to END1 as long as the condition holds."""
    condition, at = _operand(control, statement, 0)
    loop = _loop(control, statement)
    if _DO.match(statement.text, at) is None:
        message = f"{statement.keyword} needs DO and its number behind the condition, and no more"
        hint = "WHILE [#1 LT 5] DO1; what the loop does is in lines of its own"
        control.fail("structure", message, statement, hint)
    if not control.compute(condition, statement.text_column):
        control.jump(loop.behind)


def _do(control: Control, statement: Statement) -> None:
    """DO1: the blocks up to END1 run until a jump leaves them."""
    _loop(control, statement)
    _whole(control, statement)


def _end(control: Control, statement: Statement) -> None:
    """END1: back to the loop's first line."""
    loop = _loop(control, statement)
    _whole(control, statement)
    control.jump(Location(loop.begin, 0))


def _whole(control: Control, statement: Statement) -> None:
    if _COUNT.match(statement.text) is None:
        control.fail("structure", f"only a number follows {statement.keyword}", statement)


def _if(control: Control, statement: Statement) -> None:
    """IF [...] GOTO 10, IF [...] THEN #1=5."""
    condition, at = _operand(control, statement, 0)
    match = _BEHIND_CONDITION.match(statement.text, at)
    if match is None:
        hint = "IF [#1 EQ 5] GOTO 10, or IF [#1 EQ 5] THEN #2=1"
        control.fail("structure", "GOTO or THEN must follow the condition", statement, hint)
    holds = control.compute(condition, statement.text_column) != 0.0
    if match[1].upper() == "GOTO":
        target = _target(control, statement, match.end())
        if holds:
            _jump(control, statement, target)
        return
    block = _block_behind_then(control, statement, match.end())
    if block is not None:
        if holds:
            control.run(block)
        return
    assignment = _assignment(control, statement, match.end())
    if holds:
        _assign(control, assignment)


def _block_behind_then(control: Control, statement: Statement, at: int) -> Block | None:
    """What a Haas runs where the condition holds, if words belong to it (manual); else None."""
    if not memory_of(control).variant.then_takes_words:
        return None
    blocks = control.statements.blocks(
        statement.text[at:], statement.text_column + at, control.block.line
    )
    if len(blocks) != 1 or blocks[0].statement is not None:
        hint = "THEN #2=1, or THEN G1 X10."
        control.fail("structure", "assignments and words follow THEN", statement, hint)
    return blocks[0]._replace(number=control.block.number) if blocks[0].words else None


def _assignment(control: Control, statement: Statement, at: int) -> Assignment:
    """The assignment behind THEN."""
    text = statement.text
    at += len(text[at:]) - len(text[at:].lstrip())
    target, end = Expression("", Number(0.0)), at
    if text.startswith("#", at):
        target, end = _operand(control, statement, at)
    equals = _EQUALS.match(text, end)
    if equals is None or not isinstance(target.tree, Variable | NumberedVariable):
        control.fail("structure", "one assignment follows THEN", statement, "THEN #2=1")
    value, end = control.statements.longest(text, equals.end(), statement.text_column)
    if text[end:].strip():
        control.fail("structure", "one assignment follows THEN, and no more", statement)
    column = statement.text_column + at
    return assignment_of(target.tree, value, column, end - at)


def _assign(control: Control, assignment: Assignment) -> None:
    target, index = assignment.target, None
    if assignment.number is not None:
        index = control.compute(assignment.number, assignment.column)
    value = control.compute(assignment.value, assignment.column)
    write_variable(control, target.name, index, value, assignment)


def _go_to(control: Control, statement: Statement) -> None:
    """GOTO 10, GOTO #1, GOTO [#1+10]."""
    _jump(control, statement, _target(control, statement, 0))


def _target(control: Control, statement: Statement, at: int) -> Expression:
    if (named := _NAMED_BLOCK.match(statement.text, at)) is not None:
        message = "GOTO takes the number of the block without its N"
        control.fail("jump-target", message, statement, f"GOTO {named[1]}")
    target, end = _operand(control, statement, at)
    if statement.text[end:].strip():
        control.fail("jump-target", "GOTO needs one number and no more", statement, "GOTO 10")
    return target


def _jump(control: Control, statement: Statement, target: Expression) -> None:
    value = control.compute(target, statement.text_column)
    control.jump(destination(control, statement, value))


def destination(control: Control, statement: Statement, number: float) -> Location:
    """Where a jump leads: the next block of that number, else the first of the program."""
    if not number >= 0.0 or number != int(number):
        control.fail("jump-target", f"there is no block N{number:g}", statement)
    counter, around, here = control.program_counter, lines_around(control), control.block.line - 1
    places = [place for place in counter.labels().get(int(number), []) if place.line in around]
    if places:
        place = next((each for each in places if each.line > here), places[0])
    else:
        span = statement.column, len(statement.keyword)
        place = counter.find_label(int(number), span, "GOTO", around)
    for loop in _loops(control).constructs:
        end = -1 if loop.end is None else loop.end
        if loop.begin < place.line <= end and not loop.begin <= here <= end:
            message = f"N{int(number)} lies in a loop, and a jump must not lead into one"
            control.fail("jump-into-structure", message, statement)
    return place


def _pass_over(control: Control, statement: Statement) -> None:
    message = f"{statement.keyword} changes nothing of the path: it writes to a file or a name"
    span = statement.column, len(statement.keyword)
    control.report.notice(statement.keyword, message, *span)


STATEMENTS: dict[str, StatementAction] = {
    "IF": _if,
    "GOTO": _go_to,
    **dict.fromkeys(("WHILE", "WH"), _while),
    "DO": _do,
    "END": _end,
    **dict.fromkeys(("DPRNT", "BPRNT", "POPEN", "PCLOS", "SETVN"), _pass_over),
}
