"""Many runs on a Ray cluster: each is a task, results come as they are ready."""

import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, TypeVar

from twin.check.outcome import CheckOutcome, died
from twin.errors import UsageError
from twin.extras import require_extra

TaskT = TypeVar("TaskT")

HERE = "local"
"""The address that starts a cluster on this computer."""
RETRIES = 3
"""How often a task whose worker was lost is run again."""


def check_on_cluster(
    tasks: Sequence[TaskT], check: Callable[[TaskT], CheckOutcome], *, address: str
) -> Iterator[CheckOutcome]:
    """Run tasks on a Ray cluster, whose nodes see the same files under the same paths.

    Args:
        tasks: What to run.
        check: How one is run.
        address: Of the cluster (``ray://host:10001``, ``auto``), or ``local``.

    Yields:
        The outcomes as they become known, in any order.

    Raises:
        UsageError: Ray is not installed, or the cluster does not answer.
    """
    ray = _connected(address)
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


def _connected(address: str) -> Any:
    require_extra("cluster", "--cluster")
    import ray

    path = os.pathsep.join(filter(None, [str(Path.cwd()), os.environ.get("PYTHONPATH")]))
    here = {"PYTHONPATH": path}
    options: dict[str, Any] = {"log_to_driver": False, "logging_level": "error"}
    if address == HERE:
        options |= {"include_dashboard": False, "runtime_env": {"env_vars": here}}
    else:
        options["address"] = address
    try:
        ray.init(**options)
    except (ConnectionError, RuntimeError, ValueError) as error:
        raise UsageError(f"--cluster {address}: no cluster answers: {error}") from error
    return ray
