"""MuJoCo's own timers, switched off: nobody reads them, and they take a fifth of a run.

MuJoCo asks the clock around every stage of every step, of which RK4 has four passes. What it
measures is in ``MjData.timer``, for profilers of interactive viewers.
"""

from typing import Any

import mujoco
from numba import types
from numba.core.ccallback import CFunc

from twin.compilation.cache import RESULT, kernel_cache


def _no_time() -> float:
    return 0.0


def _callback() -> Any:
    compiled: Any = CFunc(_no_time, ((), types.float64), {}, {})
    compiled._cache = kernel_cache(_no_time, RESULT)  # noqa: SLF001 (Numba has no public place for it)
    compiled.compile()
    return compiled.ctypes


_NO_TIME = _callback()


def switch_off_timers() -> None:
    """Let ``MjData.timer`` stand still in this process, unless somebody has set a clock of their own.

    ``mujoco.set_mjcb_time(None)`` brings MuJoCo's clock back.
    """
    if mujoco.get_mjcb_time() is None:
        mujoco.set_mjcb_time(_NO_TIME)
