"""Machine code of a kernel that Python calls: the kernel with all that it calls, behind a wrapper."""

import pickle
from collections.abc import Callable
from typing import Any, NamedTuple

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompileResult
from numba.core.funcdesc import FunctionDescriptor
from numba.core.serialize import dumps
from numba.core.typing.templates import Signature

from twin.compilation.part import link


class CompiledKernel(NamedTuple):
    """A kernel compiled for arguments of one type, as Numba's dispatcher asks for it.

    Attributes:
        entry_point: What Python calls.
        environment: Python's objects that the code uses.
        objectmode: Whether the code works on Python's objects; Numba asks.
    """

    signature: Signature
    entry_point: Callable[..., object]
    library: "EntryLibrary"
    descriptor: FunctionDescriptor
    environment: Any
    objectmode: bool = False


class EntryLibrary(JITCodeLibrary):
    """Optimised once, when it holds all that it needs."""

    def __init__(self, codegen: Any, name: str, *, vectorize: bool = True) -> None:
        """Begin an empty library.

        Args:
            codegen: Numba's generator of code.
            vectorize: Whether loops are looked for that gain by several rounds at a time. To look for
                them is a quarter of what it costs to compile a kernel that has none.
        """
        super().__init__(codegen, name)
        self._vectorize = vectorize
        self.enable_object_caching()

    @property
    def object_code(self) -> bytes:
        """The machine code."""
        return self._get_compiled_object()

    def finalize(self) -> None:
        """Link, optimise and compile."""
        self._raise_if_finalized()
        module = self._final_module
        called = {function.name for function in module.functions if not function.is_declaration}
        link(self._linking_libraries, module)
        for function in module.functions:
            if not function.is_declaration and function.name not in called:
                # Nobody else calls this copy, and a function of another kernel may have its name.
                function.linkage = "internal"
        self._optimize_final_module()
        module.verify()
        self._finalize_final_module()

    def load(self, object_code: bytes) -> None:
        """Take machine code that was compiled before."""
        self._set_compiled_object(object_code)
        self._finalize_final_module()

    def get_pointer_to_function(self, name: str) -> int:
        """Address of the function of a name."""
        self._ensure_finalized()
        return self._codegen._engine.get_function_address(name)  # noqa: SLF001 (as Numba does)

    def _optimize_functions(self, ll_module: Any) -> None:
        """All functions are optimised together."""
        ll_module.data_layout = self._codegen._data_layout  # noqa: SLF001 (as Numba does)

    def _optimize_final_module(self) -> None:
        loops = {} if self._vectorize else {"loop_vectorize": False, "slp_vectorize": False}
        inline = {"opt": 0, "cost": "cheap", "loop_vectorize": False, "slp_vectorize": False}
        for options in (inline, loops):  # the two passes of Numba
            passes, builder = self._codegen._module_pass_manager(**options)  # noqa: SLF001 (as Numba does)
            passes.run(self._final_module, builder)


def entry_of(part: CompileResult, *, release_gil: bool, vectorize: bool) -> CompiledKernel:
    """Make machine code of a kernel.

    Args:
        release_gil: Whether other threads may run Python meanwhile.
        vectorize: Whether loops are looked for that gain by several rounds at a time.
    """
    context: Any = part.target_context
    library = EntryLibrary(context.codegen(), part.fndesc.qualname, vectorize=vectorize)
    context.create_cpython_wrapper(
        library, part.fndesc, part.environment, part.call_helper, release_gil=release_gil
    )
    library.add_linking_library(part.library)
    called = context.get_executable(library, part.fndesc, part.environment)
    return CompiledKernel(part.signature, called, library, part.fndesc, part.environment)


def packed(entry: CompiledKernel) -> bytes | None:
    """An entry to be kept; None of one that holds addresses of this process."""
    if entry.library.has_dynamic_globals:
        return None
    descriptor = entry.descriptor
    descriptor.typemap = descriptor.calltypes = (
        None  # as Numba does: these are large, and of no use
    )
    return dumps((entry.library.object_code, descriptor, entry.environment, entry.signature))


def unpacked(data: bytes, context: Any) -> CompiledKernel:
    """The entry that was kept.

    Args:
        context: Numba's, which the kernel is loaded into.
    """
    object_code, descriptor, environment, signature = pickle.loads(data)  # noqa: S301 (from folders that nobody else writes to)
    library = EntryLibrary(context.codegen(), descriptor.qualname)
    library.load(object_code)
    called = context.get_executable(library, descriptor, environment)
    return CompiledKernel(signature, called, library, descriptor, environment)
