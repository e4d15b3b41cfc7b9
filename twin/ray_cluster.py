"""The Ray cluster that a command is given: connected to, or started on this computer."""

import os
import socket
from pathlib import Path
from typing import Any

from twin.errors import UsageError
from twin.extras import require_extra

HERE = "local"
"""The address that starts a cluster on this computer."""
ANSWERED_S = 5.0
"""Longest that a cluster's head takes to say that it is one [s]; Ray itself waits for minutes, then ends the process."""
_HTTP2_BEGIN = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + bytes((0, 0, 0, 4, 0, 0, 0, 0, 0))
_SETTINGS = 4
"""RFC 9113, 3.4: what a client begins with; an HTTP/2 server, as every gRPC server is, answers with a SETTINGS frame."""


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
        _require_answer(address)
        options["address"] = address
    try:
        ray.init(**options)
    except (ConnectionError, RuntimeError, ValueError, RayError) as error:
        raise UsageError(
            f"--cluster {address}: no cluster answers: {error}; one that asks for a token wants RAY_AUTH_MODE=token set here too"
        ) from error
    return ray


def _require_answer(address: str) -> None:
    """Refuse an address at which nobody, or something else than Ray, listens; what is no host and port is left to Ray."""
    host, _, port = address.removeprefix("ray://").rpartition(":")
    if not host or not port.isdecimal():
        return
    try:
        with socket.create_connection((host.strip("[]"), int(port)), ANSWERED_S) as line:
            line.settimeout(ANSWERED_S)
            if os.environ.get("RAY_USE_TLS") == "1":
                return
            line.sendall(_HTTP2_BEGIN)
            frame = line.recv(9)
        why = "" if len(frame) == 9 and frame[3] == _SETTINGS else "what listens there is not Ray"
    except (OSError, OverflowError) as error:
        why = str(error)
    if why:
        raise UsageError(
            f"--cluster {address}: no cluster answers: {why}; 'ray start --head --port PORT' begins one, and says its "
            f"address; '--cluster {HERE}' begins one on this computer for this run"
        )
