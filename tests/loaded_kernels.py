"""Which kernels a process holds."""

import gc

from numba.core.dispatcher import Dispatcher


def loaded() -> set[tuple[str, str]]:
    """Kernels of this package that are in memory, with their signatures."""
    # ``isinstance`` would ask weak references for a class that may be gone.
    kernels = [one for one in gc.get_objects() if issubclass(type(one), Dispatcher)]
    return {
        (f"{one.py_func.__module__}.{one.py_func.__qualname__}", str(signature))
        for one in kernels
        for signature in one.overloads
        if one.py_func.__module__.startswith("twin.")
    }
