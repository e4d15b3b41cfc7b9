"""Compiled kernels, kept by the content of everything that they were compiled from.

Numba's own cache keeps what it compiled for as long as the file that a kernel is in stays as it
is: it does not see that a function or a constant of another file, compiled into this one, has
changed; it compiles again when an environment was moved; and a file of it that was cut short ends the
program. Here a kernel's folder is named by its content, its file by its types and its processor; a
file carries a checksum, and one that is damaged is compiled again. Processes that lack the same
kernel at the same time wait for the one that compiles it.
"""

import contextlib
import fcntl
import functools
import hashlib
import os
import pickle
import secrets
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Generic, NamedTuple, TypeVar

from llvmlite.binding import add_symbol
from numba.core.caching import _Cache
from numba.core.compiler import CompileResult
from numba.core.runtime._nrt_python import c_helpers
from numba.core.serialize import dumps
from numba.core.sigutils import normalize_signature

from twin.compilation.content import PACKAGE, content_key
from twin.compilation.folders import (
    SHIPPED,
    remove_forgotten,
    touch,
    trusted_folders,
    writable_folder,
)

GENERIC = ("generic", "")
"""Processor and features of kernels that run on every processor of an architecture."""

_CHECKSUM_BYTES = hashlib.sha256().digest_size
_SUFFIX = ".kernel"

Compiled = TypeVar("Compiled")


class CacheFormat(NamedTuple, Generic[Compiled]):
    """How what was compiled is written.

    Attributes:
        pack: Its bytes; None of what holds addresses of this process.
        unpack: What was compiled, of its bytes and Numba's context, which it is loaded into.
    """

    pack: Callable[[Compiled], bytes | None]
    unpack: Callable[[bytes, Any], Compiled]


def _pack_result(result: Any) -> bytes | None:
    whole = not result.lifted and not result.library.has_dynamic_globals
    return dumps(result._reduce()) if whole else None  # noqa: SLF001 - Numba has no public place for it


def _unpack_result(data: bytes, context: Any) -> Any:
    return CompileResult._rebuild(context, *pickle.loads(data))  # noqa: S301, SLF001 (from folders that nobody else writes to; Numba has no public place for it)


RESULT: CacheFormat[Any] = CacheFormat(_pack_result, _unpack_result)
"""What Numba's own compiler gives."""


def kernel_cache(function: Callable[..., Any], form: CacheFormat[Any]) -> "KernelCache | None":
    """Where the compiled forms of a function are kept; None for one of another package.

    Args:
        form: How they are written.
    """
    file = _whole(function.__code__.co_filename)
    return KernelCache(function, file, form) if file.is_relative_to(PACKAGE) else None


@functools.cache
def _whole(file: str) -> Path:
    return Path(file).resolve()


def is_compiled(kernel: Any, arguments: Iterable[object]) -> bool:
    """Whether a kernel is compiled for these arguments."""
    types = tuple(map(kernel.typeof_pyval, arguments))
    return types in kernel.overloads or kernel._cache.holds(types, kernel.targetctx)  # noqa: SLF001 - Numba has no public place for it


class KernelCache(_Cache):
    """The compiled forms of one kernel."""

    def __init__(self, function: Callable[..., Any], file: Path, form: CacheFormat[Any]) -> None:
        self._name = f"{function.__module__}.{function.__qualname__}"
        self._file = file
        self._form = form
        self._locks: dict[str, int] = {}

    @functools.cached_property
    def _folder(self) -> str:
        return content_key(self._file)

    @property
    def cache_path(self) -> Any:
        """Where the kernel is kept that is compiled next."""
        return str(writable_folder() / self._folder)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The kernel for these types, or None: then this process compiles it and no other.

        Args:
            sig: Types of the arguments and of the result.
            target_context: Numba's, which the kernel is loaded into.
        """
        _register_helpers()
        data = self._read(sig, target_context)
        if data is None:
            self._begin(self._file_name(sig, _processor(target_context.codegen())))
            # Another process may have compiled it while this one waited.
            data = self._read(sig, target_context)
            if data is None:
                return None
            self._end(self._file_name(sig, _processor(target_context.codegen())))
        return self._form.unpack(data, target_context)

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep what was compiled; a full disk loses it and nothing else."""
        name = self._file_name(sig, _processor(data.library.codegen))
        try:
            packed = self._form.pack(data)
            if packed is not None:
                with contextlib.suppress(OSError):
                    self._write(name, packed)
        finally:
            self._end(name)

    def holds(self, sig: Any, target_context: Any) -> bool:
        """Whether the kernel for these types is kept; the arguments are those of ``load_overload``."""
        return self._read(sig, target_context) is not None

    def enable(self) -> None:
        """Numba asks for it; this cache is always on."""

    def disable(self) -> None:
        """Numba asks for it; this cache is always on."""

    def flush(self) -> None:
        """Numba asks for it; what is kept by content is never stale."""

    def _read(self, sig: Any, target_context: Any) -> bytes | None:
        here = _processor(target_context.codegen())
        own = self._file_name(sig, here)
        shipped = self._file_name(sig, (here[0], *GENERIC))
        for root, name in [(SHIPPED, shipped), *((root, own) for root in trusted_folders())]:
            data = _checked(root / self._folder / name)
            if data is not None:
                if root is not SHIPPED:
                    touch(root / self._folder)
                return data
        return None

    def _write(self, name: str, data: bytes) -> None:
        root = writable_folder()
        folder = root / self._folder
        folder.mkdir(mode=0o700, exist_ok=True)
        temporary = folder / f"{name}.{secrets.token_hex(8)}"
        try:
            temporary.write_bytes(hashlib.sha256(data).digest() + data)
            temporary.replace(folder / name)
        finally:
            temporary.unlink(missing_ok=True)
        remove_forgotten(root)

    def _begin(self, name: str) -> None:
        """Wait until no other process compiles this; where locks are not to be had, do not wait."""
        self._end(name)
        with contextlib.suppress(OSError):
            folder = writable_folder() / self._folder
            folder.mkdir(mode=0o700, exist_ok=True)
            handle = os.open(folder / f"{name}.lock", os.O_CREAT | os.O_RDWR, 0o600)
            self._locks[name] = handle
            fcntl.flock(handle, fcntl.LOCK_EX)

    def _end(self, name: str) -> None:
        handle = self._locks.pop(name, None)
        if handle is not None:
            with contextlib.suppress(OSError):
                (writable_folder() / self._folder / f"{name}.lock").unlink()
            os.close(handle)

    def _file_name(self, sig: Any, processor: tuple[str, ...]) -> str:
        arguments, result = normalize_signature(sig)
        about = "\n".join((self._name, *map(str, arguments), str(result), *processor))
        stem = self._name.rpartition(".")[2]
        return f"{stem}-{hashlib.sha256(about.encode()).hexdigest()[:24]}{_SUFFIX}"


@functools.cache
def _register_helpers() -> None:
    """Let code that is compiled already find the C functions of Numba's run time.

    Numba's own cache makes the context ready to compile for that, which takes a fifth of the start of a run: it compiles
    the run time, which the code holds already, and loads all that kernels may call, SciPy with it. Its compiler does so
    too, when there is something to compile.
    """
    for name, address in c_helpers.items():
        add_symbol(name if name.startswith("_") else f"NRT_{name}", address)


def _processor(codegen: Any) -> tuple[str, ...]:
    """System, processor and its features that Numba's generator of code compiles for."""
    return tuple(map(str, codegen.magic_tuple()))


def _checked(file: Path) -> bytes | None:
    """A file's content behind its checksum; None where there is none or it is damaged."""
    try:
        content = file.read_bytes()
    except OSError:
        return None
    data = content[_CHECKSUM_BYTES:]
    whole = content[:_CHECKSUM_BYTES] == hashlib.sha256(data).digest()
    return data if whole else None
