"""Many programs over the cores; one that breaks does not stop the others."""

import concurrent.futures
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.context import SpawnContext
from multiprocessing.synchronize import Lock
from pathlib import Path
from typing import TypeVar

from twin.check.outcome import CheckOutcome, died
from twin.check.task import CheckSettings, Variant
from twin.processor import available_cores

TaskT = TypeVar("TaskT")
"""A program or a variant of one."""


def check_program(path: Path, settings: CheckSettings) -> CheckOutcome:
    """Run a job or a program and say how it came out; what is wrong with it becomes a finding."""
    return check_variant(Variant(path, ()), settings)


def check_variant(variant: Variant, settings: CheckSettings) -> CheckOutcome:
    """Run a job with some values of it or of its machine changed, and say how it came out.

    What runs programs is loaded by the process that runs one, and not by the one that hands them out.
    """
    from twin.check.program import run_variant

    return run_variant(variant, settings)


def check_all(
    programs: Sequence[TaskT], check: Callable[[TaskT], CheckOutcome], *, jobs: int | None = None
) -> Iterator[CheckOutcome]:
    """Check programs, several at a time.

    Args:
        programs: What to check.
        check: How one is checked; sent to other processes, so a module's function or a partial.
        jobs: How many processes; one for each core by default.

    Yields:
        The outcomes as they become known, in any order.
    """
    workers = min(jobs or available_cores(), len(programs))
    if workers <= 1:
        _tell_of_compilation()
        yield from map(check, programs)
        return
    # Fresh processes: a fork of one that has run threads or OpenGL may hang.
    context = SpawnContext()
    crashed = []
    with _pool(workers, context) as pool:
        futures = {pool.submit(check, path): path for path in programs}
        try:
            for future in concurrent.futures.as_completed(futures):
                try:
                    yield future.result()
                except BrokenProcessPool:
                    crashed.append(futures[future])
        finally:
            # When interrupted, what has not begun shall not begin.
            pool.shutdown(wait=False, cancel_futures=True)
    # A process that died took every waiting program with it: each gets a process of its own.
    for path in crashed:
        yield _check_alone(path, check, context)


def run_tasks(
    tasks: Sequence[TaskT],
    check: Callable[[TaskT], CheckOutcome],
    *,
    jobs: int | None,
    cluster: str | None,
) -> Iterator[CheckOutcome]:
    """Run tasks over this computer's cores or, given its address, on a Ray cluster."""
    if cluster is None:
        return check_all(tasks, check, jobs=jobs)
    from twin.check.cluster import check_on_cluster

    return check_on_cluster(tasks, check, address=cluster)


def _pool(workers: int, context: SpawnContext) -> concurrent.futures.ProcessPoolExecutor:
    return concurrent.futures.ProcessPoolExecutor(
        workers, mp_context=context, initializer=_begin, initargs=(context.Lock(),)
    )


def _begin(telling: Lock) -> None:
    """An interrupt from the keyboard ends a process at once; one process tells of compilation."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    _tell_of_compilation(lambda: telling.acquire(block=False))


def _tell_of_compilation(is_first: Callable[[], bool] = lambda: True) -> None:
    """Only processes that run programs load the compiler."""
    from twin.compilation.announcement import announce_compilation

    announce_compilation(is_first)


def _check_alone(
    task: TaskT, check: Callable[[TaskT], CheckOutcome], context: SpawnContext
) -> CheckOutcome:
    with _pool(1, context) as pool:
        try:
            return pool.submit(check, task).result()
        except BrokenProcessPool:
            return died(str(task))
