"""How Numba keeps and optimises code: of functions that kernels take in, and of kernels of branches."""

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


class BranchingLibrary(JITCodeLibrary):
    """Code of branches: its few loops are not made to take several rounds at a time.

    To look for such loops is a quarter of what it costs to compile a kernel that has none.
    """

    def _optimize_final_module(self) -> None:
        for options in ({"opt": 0, "cost": "cheap"}, {}):  # the two passes of Numba
            passes, builder = self._codegen._module_pass_manager(  # noqa: SLF001 (as Numba does)
                loop_vectorize=False, slp_vectorize=False, **options
            )
            passes.run(self._final_module, builder)


class BranchingCompiler(Compiler):
    """Compiles into such a library."""

    def __init__(self, typingctx: Any, targetctx: Any, library: Any, *rest: Any) -> None:
        if library is None:
            library = BranchingLibrary(targetctx.codegen(), "kernel")
            library.enable_object_caching()
        super().__init__(typingctx, targetctx, library, *rest)
