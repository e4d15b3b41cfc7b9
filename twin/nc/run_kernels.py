"""One block's words, run once or several times, and compensated."""

from twin.nc.bench_kernels import Bench
from twin.nc.compile_kernels import inlined_kernel
from twin.nc.contour_kernels import follow
from twin.nc.contour_state import OFF, STAGE, Contour
from twin.nc.plain_kernels import run_words
from twin.nc.plain_state import BlockTables, Constants, Rows, State


@inlined_kernel
def run_times(
    times: int,
    line: int,
    words: int,
    polar: bool,
    made: int,
    first_event: int,
    tables: BlockTables,
    constants: Constants,
    state: State,
    rows: Rows,
    contour: Contour,
    bench: Bench,
) -> int:
    """Run the words on the bench.

    Args:
        times: How often; more than once only while nothing is compensated.
        line: The block's line, from 1.
        words: How many there are.
        polar: As for ``run_words``.
        made: The next row.
        first_event: The block's first event that has not been seen to.
        tables: What words mean.
        constants: What stays.
        state: What changes.
        rows: Room for the moves.
        contour: Radius compensation.
        bench: The words.

    Returns:
        The row after the block's moves, ``NOT_PLAIN``, ``DOUBTFUL`` or ``NO_ROOM``.
    """
    after = made
    for _ in range(times):
        after = run_words(
            line,
            bench.roles[:words],
            bench.values[:words],
            tables,
            constants,
            state,
            bench.modal,
            rows,
            after,
            polar,
        )
        if after < 0:
            return after
    if contour.counts[STAGE] != OFF:
        return follow(made, after, first_event, state.happened[0], contour, rows)
    return after
