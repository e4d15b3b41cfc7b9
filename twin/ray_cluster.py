"""The Ray cluster that a command is given: connected to, or started on this computer."""

import os
from pathlib import Path
from typing import Any

from twin.errors import UsageError
from twin.extras import require_extra

HERE = "local"
"""The address that starts a cluster on this computer."""


def connected(address: str) -> Any:
    """The module ``ray``, connected to a cluster.

    Args:
        address: Of the cluster (``ray://host:10001``, ``auto``), or ``local``.

    Raises:
        UsageError: Ray is not installed, or the cluster does not answer.
    """
    require_extra("cluster", "--cluster")
    import ray
    from ray.exceptions import RayError

    path = os.pathsep.join(filter(None, [str(Path.cwd()), os.environ.get("PYTHONPATH")]))
    here = {"PYTHONPATH": path}
    options: dict[str, Any] = {"log_to_driver": False, "logging_level": "error"}
    if address == HERE:
        # Without an address Ray takes a cluster that someone else has on this computer, and waits for it when it is gone.
        options |= {
            "address": "local",
            "include_dashboard": False,
            "runtime_env": {"env_vars": here},
        }
    else:
        options["address"] = address
    try:
        ray.init(**options)
    except (ConnectionError, RuntimeError, ValueError, RayError) as error:
        raise UsageError(f"--cluster {address}: no cluster answers: {error}") from error
    return ray
