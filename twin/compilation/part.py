"""Numba's form of a function that has none of its own: code that kernels take in and compile with theirs."""

from typing import Any

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler


class PartLibrary(JITCodeLibrary):
    """Code as it was lowered; what links it optimises it and makes machine code of it.

    Numba makes machine code of every function that it compiles, and again of its copy in each
    function that calls it, however deep: of a chain of ten calls ten times.
    """

    @property
    def codegen(self) -> Any:
        """Numba's, as it asks for it."""
        return _WithoutEnvironment(self._codegen)

    def get_pointer_to_function(self, name: str) -> int:  # noqa: ARG002 (Numba passes it)
        """No address: there is no machine code."""
        self._ensure_finalized()
        return 0

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True


class _WithoutEnvironment:
    """Numba's generator of code, which does not write to variables that have no address."""

    def __init__(self, codegen: Any) -> None:
        self._codegen = codegen

    def __getattr__(self, name: str) -> Any:
        return getattr(self._codegen, name)

    def set_env(self, env_name: str, env: Any) -> None:
        """Nothing of the code is in memory yet."""


class PartCompiler(Compiler):
    """Compiles into such a library."""

    def __init__(self, typingctx: Any, targetctx: Any, library: Any, *rest: Any) -> None:
        if library is None:
            library = PartLibrary(targetctx.codegen(), "part")
        super().__init__(typingctx, targetctx, library, *rest)
