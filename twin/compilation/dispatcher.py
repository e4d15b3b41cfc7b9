"""A compiled function: code of its own for Python, and a part of the kernels that call it."""

import functools
from collections.abc import Callable, Sequence
from typing import Any

from numba.core import event, sigutils
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import CPUDispatcher

from twin.compilation.cache import CacheFormat, kernel_cache
from twin.compilation.entry import entry_of, packed, unpacked
from twin.compilation.part import parts_only
from twin.compilation.shortcuts import take_array_shortcut

_WITHOUT_WRAPPERS = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}


class KernelDispatcher(CPUDispatcher):
    """Replaces a kernel's function.

    The function is lowered once for each type of its arguments, as a part. Machine code is made of it
    when Python calls it, and kept; a kernel that is called by kernels alone has none.
    """

    def __init__(self, function: Callable[..., Any], *, vectorize: bool, **options: Any) -> None:
        """Compile nothing yet.

        Args:
            vectorize: Whether its loops may gain by several rounds at a time.
            **options: Of Numba's compiler.
        """
        options["nopython"] = True
        super().__init__(function, targetoptions=options)
        self._vectorize = vectorize
        self._cache: Any = kernel_cache(function, CacheFormat(packed, unpacked)) or self._cache

    @functools.cached_property
    def _part(self) -> Any:
        return CPUDispatcher(self.py_func, targetoptions=self.targetoptions | _WITHOUT_WRAPPERS)

    def get_call_template(self, args: Sequence[Any], kws: Any) -> Any:
        """What a kernel that calls this one needs to know of its types; arguments are Numba's."""
        return self._part.get_call_template(args, kws)

    def get_overload(self, sig: Any) -> Any:
        """What a kernel calls; the argument is Numba's."""
        return self._part.get_overload(sig)

    def compile(self, sig: Any) -> Callable[..., object]:
        """What Python calls for arguments of these types, loaded or compiled; the argument is Numba's."""
        with global_compiler_lock:
            arguments = tuple(sigutils.normalize_signature(sig)[0])
            entry: Any = self.overloads.get(arguments)
            if entry is None:
                entry = self._cache.load_overload(sig, self.targetctx)
                if entry is None:
                    self.stats.cache_misses[sig] += 1
                    entry = self._compiled(arguments)
                    self._cache.save_overload(sig, entry)
                else:
                    self.stats.cache_hits[sig] += 1
                self.add_overload(entry)
            return entry.entry_point

    def _compiled(self, arguments: tuple[Any, ...]) -> Any:
        take_array_shortcut()
        details = {"dispatcher": self, "args": arguments, "return_type": None}
        context: Any = self.targetctx
        with event.trigger_event("numba:compile", data=details):
            with parts_only(context.codegen()):
                self._part.compile(arguments)
            return entry_of(
                self._part.overloads[arguments],
                release_gil=bool(self.targetoptions.get("nogil")),
                vectorize=self._vectorize,
            )
