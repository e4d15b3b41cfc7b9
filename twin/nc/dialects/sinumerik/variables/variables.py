"""Variables of the SINUMERIK: R parameters, those of DEF and PROC, tables, axes."""

import re

from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik.memory import memory_of
from twin.nc.dialects.sinumerik.variables import system_variables
from twin.nc.dialects.sinumerik.variables.expressions import SECOND
from twin.nc.text.blocks import Word
from twin.nc.text.expressions.expressions import ExpressionError


def read_variable(control: Control, name: str, index: float | None) -> float:
    """Value of ``R5``, ``R[..]``, ``NAME``, ``NAME[..]``, ``$NAME[..]`` or ``'H1F'``."""
    if name.startswith("'"):
        return float(int(name[2:-1], 16 if name[1] == "H" else 2))
    if name.startswith("$"):
        return system_variables.read(control, name)
    if name == "R" and index is not None:
        name, index = f"R{_whole_index(name, index)}", None
    if not is_parameter(name):
        name = _element_name(control, name, index)
    value = control.variables.read(name)
    if value is not None:
        return value
    hint = f"set it before, or in the job: [variables] {name} = 0.0"
    if not is_parameter(name):
        hint = f"define it before: DEF REAL {name}; or give it to the job: [variables] {name} = 0.0"
    raise ExpressionError("unknown-variable", f"{name} has no value", None, hint)


def is_parameter(name: str) -> bool:
    """Whether a name is that of an R parameter, which all of a program shares."""
    return name[0] == "R" and name[1:].isdigit()


def is_local(name: str) -> bool:
    """Whether a variable belongs to the call: those that DEF or PROC have defined (LUD)."""
    return not is_parameter(name)


def _whole_index(name: str, index: float) -> int:
    if index < 0.0 or index != int(index):
        raise ExpressionError("parameter-number", f"there is no {name}[{index:g}]")
    return int(index)


def _element_name(control: Control, name: str, index: float | None) -> str:
    """How an element of a table, or a variable that is none, is called among the control's variables."""
    call = memory_of(control).calls[-1]
    if name in call.texts:
        raise ExpressionError("text-value", f"{name} holds a text, and a number is wanted here")
    size = call.sizes.get(name)
    if size is None and index is None:
        return name
    if size is None or index is None:
        what = "is no table" if size is None else "is a table and needs an index"
        raise ExpressionError("parameter-number", f"{name} {what}", None, f"DEF REAL {name}[10]")
    second, first = divmod(_whole_index(name, index), int(SECOND))
    if first >= size[0] or second >= size[1]:
        shown = f"{name}[{first},{second}]" if size[1] > 1 else f"{name}[{first}]"
        last = f"{size[0] - 1},{size[1] - 1}" if size[1] > 1 else f"{size[0] - 1}"
        raise ExpressionError("parameter-number", f"there is no {shown}: the last is [{last}]")
    return f"{name}[{first},{second}]"


def write_variable(control: Control, name: str, index: float | None, value: float) -> None:
    """Give a variable a value, as its type holds it.

    Raises:
        ExpressionError: There is no such variable.
    """
    if name.startswith("$"):
        system_variables.write(control, name, value)
        return
    if name == "R" and index is not None:
        name, index = f"R{_whole_index(name, index)}", None
    if not is_parameter(name):
        kind = memory_of(control).calls[-1].types.get(name)
        if kind is None:
            hint = f"define it before: DEF REAL {name}"
            raise ExpressionError("unknown-variable", f"{name} is not defined", None, hint)
        name, value = _element_name(control, name, index), kind.converted(value)
    control.variables.write(name, value)


# --- axes


_COMPARED = re.compile(r"(\w+)[ \t]*(==|<>)[ \t]*\"([^\"]*)\"")
_AXIS = re.compile(r"\(?[ \t]*(\w+)[ \t]*\)?")


def axis_at(control: Control, line: str, at: int, column: int) -> tuple[str, int]:
    """The axis that is in a line, also in brackets, and the place behind it."""
    match = _AXIS.match(line, at)
    axis = None if match is None else system_variables.axis_named(control, match[1].upper())
    if match is None or axis is None:
        known = ", ".join(control.settings.axes.names)
        message = f"an axis must stand here: {known}"
        control.report.fail("no-such-axis", message, column + at, 1)
    return axis, match.end()


def axis_of_value(control: Control, text: str, column: int) -> str:
    """The axis that a call gives for a parameter of the type AXIS."""
    blanks = len(text) - len(text.lstrip())
    return axis_at(control, text, blanks, column)[0]


def text_named(control: Control, text: str, column: int) -> str:
    """The text that a call gives: in quotes, or of a variable that holds one."""
    bare = text.strip()
    held = memory_of(control).calls[-1].texts.get(bare.upper())
    if not (len(bare) > 1 and bare[0] == bare[-1] == '"') and held is None:
        message, hint = "a text must stand here", 'write it in quotes: "NAME"'
        control.report.fail("text-value", message, column, max(len(text), 1), hint)
    return bare.strip('"') if held is None else held


def with_texts_compared(control: Control, text: str, column: int) -> str:
    """A condition with 1 or 0 for every comparison of a variable with a text in quotes, and as long as before."""

    def compared(match: re.Match[str]) -> str:
        held = text_named(control, match[1], column + match.start(1))
        holds = (held == match[3]) is (match[2] == "==")
        return ("1" if holds else "0").ljust(len(match[0]))

    return _COMPARED.sub(compared, text)


def indexed_axis(control: Control, word: Word) -> str:
    """The axis of ``AX[NAME]=10``."""
    name = word.address.partition("[")[2].rstrip("] \t").strip()
    axis = system_variables.axis_named(control, name)
    if axis is None:
        message = f"{name} is no axis, and no variable that holds one"
        control.fail("no-such-axis", message, word, f"DEF AXIS {name}=X")
    return axis


def text_of(word: Word) -> str:
    """The text of a word, upper case, without its quotes."""
    return word.mark.strip('"').strip().upper()
