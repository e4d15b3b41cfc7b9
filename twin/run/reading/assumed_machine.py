"""The machine that is assumed for a raw program: the first shipped one with the rotary axes that the program turns."""

import re
from collections.abc import Iterator

from twin.files.shipped import machine_file, machine_names
from twin.job.job_file import DEFAULT_MACHINE
from twin.machine.load import read_machine
from twin.nc.dialects.recognition import block_pages, lines_with
from twin.nc.text.source import Source

_ROTARY = re.compile(
    r"(?<![A-Z#\[,<_])([ABC])[ \t]*(=?[ \t]*[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)|=?[ \t]*[-+]?(?:[#\[(]|[QR][0-9])|=[ \t]*[A-Z])",
    re.IGNORECASE,
)
_ANYWHERE = re.compile(rb"[ABCabc][ \t]*[-+=#\[(QRqr.0-9]")
_OTHER_USE = re.compile(
    r"G[ \t]*0*(?:6[5-9]|10|1[23]|5[01]|15[0-9])(?![0-9])|M[ \t]*0*98|CYCL|PLANE|CYCLE|POCKET|\b(?:DEF|IF|WHILE|FN|LBL)\b|[;\"]",
    re.IGNORECASE,
)
"""Lines in which A, B and C are arguments, angles of a plane or parts of words."""

_UNDECIDED = "B"
"""Of mills with one rotary axis B it is a table's, of the shipped one the head's: which is meant is not known."""


def assumed_machine(source: Source) -> tuple[str, str] | None:
    """The machine that a program needs whose rotary axes the usual one lacks, and why; None: the usual one does."""
    turned = turned_axes(source)
    if not turned or _UNDECIDED in turned or turned <= _axes_of(DEFAULT_MACHINE):
        return None
    for name in machine_names():
        if turned <= _axes_of(name):
            axes = " and ".join(sorted(turned))
            lacks = " and ".join(sorted(turned - _axes_of(DEFAULT_MACHINE)))
            return (
                name,
                f"machine {name}: the program turns {axes}, and {DEFAULT_MACHINE} has no {lacks}",
            )
    return None


def turned_axes(source: Source) -> set[str]:
    """The rotary axes that a program turns: it names them somewhere else than at 0."""
    return {word for word, value in _rotary_words(source) if not _is_zero(value)}


def _rotary_words(source: Source) -> Iterator[tuple[str, str]]:
    if not source.lines.any_holds(_ANYWHERE):
        return
    for text in block_pages(source):
        for block in lines_with(text, _ROTARY):
            if not _OTHER_USE.search(block):
                for found in _ROTARY.finditer(block):
                    yield found[1].upper(), found[2].lstrip("= \t")


def _is_zero(value: str) -> bool:
    try:
        return float(value.replace(" ", "")) == 0.0
    except ValueError:
        return False


def _axes_of(machine: str) -> set[str]:
    return set(read_machine(machine_file(machine)).axes.names)
