"""Code as it was lowered, of functions that only compiled code calls.

Numba makes machine code of every function that it compiles, and again of its copy in each function
that calls it, however deep: of a chain of ten calls ten times. Here what compiled code calls stays as it
was lowered, and machine code is made once of each kernel that Python calls, with all that it needs.
"""

import contextlib
from collections.abc import Iterable, Iterator
from typing import Any

from numba.core.codegen import CodeLibrary, JITCodeLibrary


class PartLibrary(JITCodeLibrary):
    """The code of one function; it has no address."""

    @property
    def codegen(self) -> Any:
        """Numba's, as it asks for it."""
        return _WithoutEnvironment(self._codegen)

    @property
    def module(self) -> Any:
        """The function without those that it calls."""
        return self._final_module

    @property
    def calls(self) -> Iterable[CodeLibrary]:
        """What the function calls, where it is compiled too."""
        return self._linking_libraries

    def finalize(self) -> None:
        """Nothing is linked yet; arguments as for Numba's own."""
        self._raise_if_finalized()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:  # noqa: ARG002 (Numba passes it)
        """No address: there is no machine code."""
        self._ensure_finalized()
        return 0

    def serialize_using_object_code(self) -> Any:
        """Never: a part is kept within the kernels that call it."""
        raise NotImplementedError

    def _get_module_for_linking(self) -> Any:
        """The function with all that it calls, for a function that is compiled as Numba does."""
        if self._shared_module is None:
            module = self._final_module.clone()
            link([self], module)
            for function in module.functions:
                if not function.is_declaration:
                    function.linkage = "linkonce_odr"
            self._shared_module = module
        return self._shared_module


class _WithoutEnvironment:
    """Numba's generator of code, which does not write to variables that have no address."""

    def __init__(self, codegen: Any) -> None:
        self._codegen = codegen

    def __getattr__(self, name: str) -> Any:
        return getattr(self._codegen, name)

    def set_env(self, env_name: str, env: Any) -> None:
        """Nothing of the code is in memory yet."""


def link(libraries: Iterable[CodeLibrary], module: Any) -> None:
    """Put libraries and all that they call into a module, each once.

    Args:
        libraries: What the module calls; one whose functions it holds already is not put in again.
        module: LLVM's.
    """
    held = {function.name for function in module.functions if not function.is_declaration}
    whole: dict[CodeLibrary, None] = {}
    seen: set[CodeLibrary] = set()
    waiting = list(libraries)
    while waiting:
        library = waiting.pop()
        if library in seen:
            continue
        seen.add(library)
        if not isinstance(library, PartLibrary):
            whole[library] = None
            continue
        if all(function.name not in held for function in library.get_defined_functions()):
            module.link_in(library.module, preserve=True)
        waiting.extend(library.calls)
    # LLVM takes of these what is called by now.
    for library in whole:
        module.link_in(library._get_module_for_linking(), preserve=True)  # type: ignore[attr-defined]  # noqa: SLF001 (as Numba does)


@contextlib.contextmanager
def parts_only(codegen: Any) -> Iterator[None]:
    """Let Numba put all that it compiles meanwhile into such libraries, its own functions too."""
    usual = codegen._library_class  # noqa: SLF001 (Numba has no public place for it)
    codegen._library_class = PartLibrary  # noqa: SLF001
    try:
        yield
    finally:
        codegen._library_class = usual  # noqa: SLF001
