"""What a program itself declares of its blank and its tools, as Klartext does by BLK FORM and TOOL DEF, and a SINUMERIK by WORKPIECE."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np

from twin.errors import UsageError
from twin.nc.canonical import FloatArray, Function
from twin.nc.functions import BLANK
from twin.run.reading.tool_comments import ToolComment

_RADIUS = "R"


_WRITTEN = "what the program writes"


class DeclaredStock(NamedTuple):
    """The blank of a program.

    Attributes:
        lines: Of the job file.
        top: Centre of its top face, shape (3,) [mm].
    """

    lines: list[str]
    top: FloatArray
    description: str


def declared_stock(functions: Iterable[Function]) -> DeclaredStock | None:
    """The blank that a program declares last; None: it declares none that has a volume."""
    blanks = [each.arguments for each in functions if each.word == BLANK]
    if not blanks:
        return None
    values = blanks[-1]
    if "D" in values:
        top = np.array([0.0, 0.0, values["Z2"]])
        shape = ["cylinder", f"diameter = {values['D']:g}", f"height = {values['L']:g}"]
        whole, said = min(values["D"], values["L"]) > 0.0, f"⌀ {values['D']:g} x {values['L']:g}"
    else:
        low, high = (np.array([values[f"{name}{side}"] for name in "XYZ"]) for side in (1, 2))
        low, high = np.minimum(low, high), np.maximum(low, high)
        size, middle = high - low, (low + high) / 2.0
        top = np.array([middle[0], middle[1], high[2]])
        shape = ["box", f"size = [{', '.join(f'{value:g}' for value in size)}]"]
        whole, said = bool((size > 0.0).all()), " x ".join(f"{value:g}" for value in size)
    if not whole:
        return None
    place = ", ".join(f"{value:.3f}" for value in top)
    lines = [
        "[stock]",
        f'shape = "{shape[0]}"',
        *(f"{line}  # mm: the program's own" for line in shape[1:]),
        f"position = [{place}]  # centre of its top face, mm",
        "",
    ]
    return DeclaredStock(lines, top, f"stock {said} mm, top at Z{top[2]:g}: the program's own")


def declared_tools(functions: Iterable[Function]) -> dict[int, ToolComment]:
    """The tools that a program gives a radius, by number."""
    return {
        int(each.word[1:]): ToolComment(
            "",
            2.0 * each.arguments[_RADIUS],
            None,
            f"TOOL DEF R {each.arguments[_RADIUS]:g}",
            source=_WRITTEN,
        )
        for each in functions
        if each.word[:1] == "T" and each.word[1:].isdigit() and each.arguments.get(_RADIUS)
    }


def table_tools(
    written: Mapping[int, Mapping[str, float]], called: Iterable[int], *, calls_lengths: bool
) -> dict[int, ToolComment]:
    """The tools whose radius or length a program writes into the control's table, by number.

    Args:
        written: Radius and length, by tool [mm].
        called: Tools that it brings into the spindle.
        calls_lengths: The program calls lengths, and heights count from those that it writes.

    Raises:
        UsageError: It calls lengths and writes one that no tool has, or those of some tools alone.
    """
    lengths = {number: each["length"] for number, each in written.items() if "length" in each}
    if calls_lengths and lengths:
        _require_lengths(lengths, called)
    return {
        number: ToolComment(
            "",
            2.0 * values["radius"] if values.get("radius", 0.0) > 0.0 else None,
            None,
            " ".join(f"{name} {value:g}" for name, value in values.items()),
            length=values.get("length") if calls_lengths else None,
            source=_WRITTEN,
        )
        for number, values in written.items()
    }


def _require_lengths(lengths: Mapping[int, float], called: Iterable[int]) -> None:
    hint = "leave out what writes lengths, and the tools have those of the job"
    for number, length in lengths.items():
        if length <= 0.0:
            raise UsageError(
                f"the program writes {length:g} mm as the length of tool {number} and calls it, as where zero is taken "
                f"with each tool: no tool is so long; {hint}"
            )
    for number in called:
        if number not in lengths:
            one = next(iter(lengths))
            raise UsageError(
                f"the program writes the length of tool {one} and calls it, and not that of tool {number}: its "
                f"length is not known; write it too, or {hint}"
            )
