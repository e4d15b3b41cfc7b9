"""Where the rooms of a class run: forked from a warm process on this computer, or spread over a Ray cluster."""

import contextlib
import multiprocessing as mp
import secrets
import tempfile
from multiprocessing import forkserver
from multiprocessing.connection import Client, Connection, Listener
from multiprocessing.context import BaseContext
from typing import Any, Protocol, cast

from twin.errors import TwinError
from twin.ray_cluster import connected
from twin.training.classroom.room_process import RoomOrder, run_room

START_S = 120.0
"""Longest that a room takes to begin [s]; on an empty cache kernels are compiled first."""
_ROOM_CORES = 0.1
"""Of a core, what Ray counts for a room: most of them stand most of the time."""


class RoomError(TwinError):
    """A room could not be begun."""


class RoomWorker(Protocol):
    """What a room runs in."""

    def is_alive(self) -> bool:
        """Whether it runs."""
        ...

    def kill(self) -> None:
        """End it at once."""
        ...

    def join(self, timeout: float | None = None) -> None:
        """Wait for its end, at most so long [s]."""
        ...


class RoomHost(Protocol):
    """Begins rooms."""

    def begin(self, order: RoomOrder) -> tuple[RoomWorker, Connection]:
        """Begin a room; what goes through the pipe is ``run_room``'s.

        Raises:
            RoomError: It cannot be begun.
        """
        ...

    def close(self) -> None:
        """No more rooms are begun."""
        ...


class ForkHost:
    """This computer: rooms are forked from a process that is warm, and serve their pages at Unix sockets."""

    def __init__(self) -> None:
        self._context = _room_context()
        self._sockets = tempfile.TemporaryDirectory(prefix="twin-class-")
        self._begun = 0

    def begin(self, order: RoomOrder) -> tuple[RoomWorker, Connection]:
        """Fork a room."""
        self._begun += 1
        order = order.at_socket(f"{self._sockets.name}/{self._begun}")
        ours, theirs = cast("tuple[Connection, Connection]", mp.Pipe())
        process = self._context.Process(target=run_room, args=(order, theirs), daemon=True)  # pyright: ignore[reportAttributeAccessIssue]
        process.start()
        theirs.close()
        return process, ours

    def close(self) -> None:
        """Remove the sockets."""
        self._sockets.cleanup()


class ClusterHost:
    """A Ray cluster, whose nodes see the same files under the same paths; rooms are tasks, spread over its nodes."""

    def __init__(self, address: str) -> None:
        """Connect.

        Args:
            address: As for ``twin check --cluster``.

        Raises:
            UsageError: Ray is not installed, or the cluster does not answer.
        """
        self._ray = connected(address)
        # A worker that was limited as a room serves nothing else afterwards.
        options = {"num_cpus": _ROOM_CORES, "max_retries": 0, "max_calls": 1}
        self._room = self._ray.remote(
            num_returns="streaming", scheduling_strategy="SPREAD", **options
        )(_room_here)

    def begin(self, order: RoomOrder) -> tuple[RoomWorker, Connection]:
        """Begin a room on the node that has the fewest."""
        key = secrets.token_bytes(16)
        task = self._room.remote(order, key)
        try:
            address = self._ray.get(next(task), timeout=START_S)
            pipe = cast("Connection", Client(tuple(address), authkey=key))
            return _ClusterRoom(self._ray, task), pipe
        except Exception as error:
            # Whatever Ray or the line has to say of it.
            raise RoomError(f"the cluster began no room: {error}") from error

    def close(self) -> None:
        """Leave the cluster."""
        self._ray.shutdown()


class _ClusterRoom:
    """A room's task."""

    def __init__(self, ray: Any, task: Any) -> None:
        self._ray, self._task = ray, task

    def is_alive(self) -> bool:
        return not self._over(0.0)

    def kill(self) -> None:
        with contextlib.suppress(self._ray.exceptions.RayError, ValueError):
            self._ray.cancel(self._task, force=True)

    def join(self, timeout: float | None = None) -> None:
        self._over(timeout)

    def _over(self, timeout: float | None) -> bool:
        done, _ = self._ray.wait([self._task.completed()], timeout=timeout)
        return bool(done)


def _room_here(order: RoomOrder, key: bytes) -> Any:
    """A room's task on its node: says where its pipe is, then plays until that is closed."""
    import ray

    host = ray.util.get_node_ip_address()
    with Listener((host, 0), authkey=key) as listener:
        yield listener.address
        pipe = cast("Connection", listener.accept())
    run_room(order.on_port(host, ray.get_runtime_context().get_node_id()), pipe)


def _room_context() -> BaseContext:
    """How processes are begun: forked from one that is warm, where the system can."""
    if "forkserver" not in mp.get_all_start_methods():
        return mp.get_context("spawn")
    context = mp.get_context("forkserver")
    forkserver.set_forkserver_preload(["twin.training.classroom.preload"])
    # At once: by the time that the first pupil comes it is warm.
    forkserver.ensure_running()
    return context
