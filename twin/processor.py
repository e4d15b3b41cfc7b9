"""What this process may use of the processor."""

import os
import sys
import threading
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

STACK_BYTES = 64 << 20
"""Stack of a thread that may compile kernels: as deep as the calls of the compiler, of which the system's own 512 kB to 8 MB
may be too little."""

ItemT = TypeVar("ItemT")


def available_cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def take_precedence() -> bool:
    """Let this thread run before those of other programs; whether the system grants it.

    It asks for real-time scheduling, as a machine's control does. Linux grants that to root and to
    whom ``ulimit -r`` allows it. Threads that are begun from here on do not inherit it. A single
    core is left to everybody.
    """
    if sys.platform != "linux" or available_cores() < 2:
        return False
    try:
        os.sched_setscheduler(0, os.SCHED_RR | os.SCHED_RESET_ON_FORK, os.sched_param(1))
    except OSError:
        return False
    return True


def release_precedence() -> None:
    """End what ``take_precedence`` was granted to this thread."""
    if sys.platform == "linux":
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


def made_ahead(items: Iterable[ItemT]) -> Iterator[ItemT]:
    """Pass items on, none of them None, while the next one is made in another thread, if there is another core for it.

    Who stops early, by an error or an interrupt too, waits for the one that is being made, which is dropped. What is raised
    while one is made is raised where it would have been passed on.
    """
    if available_cores() < 2:
        yield from items
        return
    iterator = iter(items)
    before = threading.stack_size(STACK_BYTES)
    with ThreadPoolExecutor(1, "ahead") as other:
        following = other.submit(next, iterator, None)
        threading.stack_size(before)
        while (item := following.result()) is not None:
            following = other.submit(next, iterator, None)
            yield item
