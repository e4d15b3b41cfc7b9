"""Events of the compiled run."""

from twin.nc.compile_kernels import kernel
from twin.nc.plain_state import Rows, State


@kernel
def report(
    rows: Rows, state: State, before: int, line: int, kind: int, number: int, amount: float
) -> None:
    """Write an event."""
    at = state.happened[0]
    event = rows.events[at]
    event[0], event[1], event[2], event[3] = before, line, kind, number
    rows.amounts[at] = amount
    state.happened[0] = at + 1
