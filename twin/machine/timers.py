"""MuJoCo's own timers, switched off: nobody reads them, and they take a fifth of a run.

MuJoCo asks the clock around every stage of every step, of which RK4 has four passes. What it
measures stands in ``MjData.timer``, for profilers of interactive viewers.
"""

import mujoco
import numba

from twin.compilation.cache import keep_kernels_by_content

keep_kernels_by_content()


@numba.cfunc("float64()", cache=True)
def _no_time() -> float:
    return 0.0


def switch_off_timers() -> None:
    """Let ``MjData.timer`` stand still in this process, unless somebody has set a clock of their own.

    ``mujoco.set_mjcb_time(None)`` brings MuJoCo's clock back.
    """
    if mujoco.get_mjcb_time() is None:
        mujoco.set_mjcb_time(_no_time.ctypes)
