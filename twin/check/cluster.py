"""Many runs on a Ray cluster: each is a task, results come as they are ready."""

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from twin.check.outcome import CheckOutcome, died
from twin.ray_cluster import connected

TaskT = TypeVar("TaskT")

RETRIES = 3
"""How often a task whose worker was lost is run again."""


def check_on_cluster(
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
