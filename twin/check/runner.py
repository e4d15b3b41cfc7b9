"""Many programs over the cores of this computer or of a cluster; one that breaks does not stop the others."""

import concurrent.futures
import signal
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.context import SpawnContext
from multiprocessing.synchronize import Lock
from pathlib import Path
from typing import TypeVar

from twin.check.outcome import CheckOutcome, died
from twin.check.task import CheckSettings, JobVariant
from twin.processor import available_cores
from twin.ray_cluster import connected

TaskT = TypeVar("TaskT")
"""A program or a variant of one."""
WORKER_PAYS_S = 8.0
"""Work that is left for one worker from which on another one shortens it: to begin costs it some 3 s, of which
half is work that the first one has done already (libraries, loading of kernels) [s]."""
RETRIES = 3
"""How often a task whose worker on a cluster was lost is run again."""
LONG_S = 6.0
"""A program that takes longer is none of those that are over before another worker has begun [s]."""


def check_program(path: Path, settings: CheckSettings) -> CheckOutcome:
    """Run a job or a program and say how it came out; what is wrong with it becomes a finding."""
    return check_variant(JobVariant(path, ()), settings)


def check_variant(variant: JobVariant, settings: CheckSettings) -> CheckOutcome:
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
        check: How one is checked; sent to other processes, so a module's function or a partial.
        jobs: How many processes; by default as many as there are cores, where that pays: one begins.

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
    waiting, running = deque(programs), dict[Future[CheckOutcome], TaskT]()
    crashed: list[TaskT] = []
    at_a_time, is_warm = workers if jobs else 1, False
    with _pool(workers, context) as pool:
        try:
            while waiting or running:
                while waiting and len(running) < at_a_time:
                    future = pool.submit(check, waiting[0])
                    running[future] = waiting.popleft()
                began = time.perf_counter()
                patience_s = LONG_S if at_a_time < workers else None
                done, _ = concurrent.futures.wait(running, patience_s, FIRST_COMPLETED)
                # The first program also takes the worker's own start.
                left_s = (time.perf_counter() - began) * len(waiting) * is_warm
                if not done or left_s > WORKER_PAYS_S:
                    at_a_time = workers
                is_warm = bool(done)
                for future in done:
                    program = running.pop(future)
                    try:
                        yield future.result()
                    except BrokenProcessPool:
                        crashed.append(program)
        except BrokenProcessPool:
            crashed += waiting
        finally:
            # When interrupted, what has not begun shall not begin.
            pool.shutdown(wait=False, cancel_futures=True)
    # A process that died took every waiting program with it: each gets a process of its own.
    for program in crashed:
        yield _check_alone(program, check, context)


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
    return _check_on_cluster(tasks, check, address=cluster)


def _pool(workers: int, context: SpawnContext) -> concurrent.futures.ProcessPoolExecutor:
    return concurrent.futures.ProcessPoolExecutor(
        workers, mp_context=context, initializer=_begin, initargs=(context.Lock(),)
    )


def _begin(telling: Lock) -> None:
    """An interrupt from the keyboard ends a process at once; one process reports compilation."""
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


def _check_on_cluster(
    tasks: Sequence[TaskT], check: Callable[[TaskT], CheckOutcome], *, address: str
) -> Iterator[CheckOutcome]:
    """Run tasks on a Ray cluster, whose nodes see the same files under the same paths.

    Args:
        check: How one is run.
        address: Of the cluster (``ray://host:10001``, ``auto``), or ``local``.

    Yields:
        The outcomes as they become known, in any order.

    Raises:
        UsageError: Ray is not installed, or the cluster does not answer.
    """
    ray = connected(address)
    try:
        run = ray.remote(max_retries=RETRIES)(_checked)
        waiting = {run.remote(check, task): task for task in tasks}
        while waiting:
            (ready, *_), _ = ray.wait(list(waiting), num_returns=1)
            task = waiting.pop(ready)
            try:
                yield ray.get(ready)
            except (ray.exceptions.WorkerCrashedError, ray.exceptions.OutOfMemoryError):
                yield died(str(task))
    finally:
        ray.shutdown()


def _checked(check: Callable[[TaskT], CheckOutcome], task: TaskT) -> CheckOutcome:
    return check(task)
