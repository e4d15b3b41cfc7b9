"""The cycles of the SINUMERIK by name."""

from collections.abc import Mapping

from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik.cycles.calls import CycleForm, read_call
from twin.nc.dialects.sinumerik.cycles.contours import CONTOURS
from twin.nc.dialects.sinumerik.cycles.drilling import DRILLING
from twin.nc.dialects.sinumerik.cycles.milling import MILLING
from twin.nc.dialects.sinumerik.cycles.patterns import PATTERNS
from twin.nc.text.blocks import Statement

CYCLES: Mapping[str, CycleForm] = {**DRILLING, **PATTERNS, **MILLING, **CONTOURS}


def call_cycle(control: Control, statement: Statement) -> None:
    """Run a cycle with the values of its call."""
    form = CYCLES[statement.keyword]
    form.run(read_call(control, statement, form))
