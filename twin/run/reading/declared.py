"""What a program itself declares of its blank and its tools, as Klartext does by BLK FORM and TOOL DEF, and a SINUMERIK by WORKPIECE."""

import re
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from twin.nc.canonical import FloatArray, Function
from twin.nc.functions import BLANK
from twin.run.reading.assumed_tools import ToolComment

_RADIUS = "R"
_TABLE = re.compile(r"(?<![A-Z])G[ \t]*10(?![0-9.])[^A-Z]*L[ \t]*1(?![0-9.])", re.IGNORECASE)
_TABLE_NUMBER = re.compile(r"P[ \t]*([0-9]+)(?![0-9.])", re.IGNORECASE)
_TABLE_LENGTH = re.compile(r"Z[ \t]*([0-9]+\.?[0-9]*|\.[0-9]+)", re.IGNORECASE)
_TABLE_RADIUS = re.compile(r"R[ \t]*([0-9]+\.?[0-9]*|\.[0-9]+)", re.IGNORECASE)
_CALLS_LENGTH = re.compile(r"(?<![A-Z])G[ \t]*4[34](?![0-9])", re.IGNORECASE)


class DeclaredStock(NamedTuple):
    """The blank of a program.

    Attributes:
        lines: Of the job file.
        top: Centre of its top face, shape (3,) [mm].
    """

    lines: list[str]
    top: FloatArray
    told: str


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
            "", 2.0 * each.arguments[_RADIUS], None, f"TOOL DEF R {each.arguments[_RADIUS]:g}"
        )
        for each in functions
        if each.word[:1] == "T" and each.word[1:].isdigit() and each.arguments.get(_RADIUS)
    }


def table_tools(blocks: Sequence[str], *, inches: bool) -> dict[int, ToolComment]:
    """The tools whose radius G10 L1 writes, by number, and the lengths that it writes where the program calls lengths.

    A control counts heights from what is in its table, and so a tool without a length there is none of
    a program that calls it.
    """
    calls_lengths = any(map(_CALLS_LENGTH.search, blocks))
    unit = 25.4 if inches else 1.0
    tools: dict[int, ToolComment] = {}
    for block in filter(_TABLE.search, blocks):
        number, radius = _TABLE_NUMBER.search(block), _TABLE_RADIUS.search(block)
        if number and radius and float(radius[1]) > 0.0:
            tool = ToolComment("", 2.0 * float(radius[1]) * unit, None, block.strip())
            if calls_lengths:
                written = _TABLE_LENGTH.search(block)
                if written is None or not float(written[1]) > 0.0:
                    continue
                tool = tool._replace(length=float(written[1]) * unit)
            tools[int(number[1])] = tool
    return tools
