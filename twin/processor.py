"""What this process may use of the processor."""

import os
import sys


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


def give_way() -> None:
    """End what ``take_precedence`` was granted to this thread."""
    if sys.platform == "linux":
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
