"""MuJoCo's own step, callable from compiled kernels: for loops in which something reacts to every step.

A kernel is handed the addresses of the model, its data and the functions as numbers. It steps exactly what
``mujoco.mj_step`` steps; between two steps it may read and write the arrays of the data.
"""

import ctypes
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
from llvmlite import ir
from numba import types
from numba.extending import intrinsic


class Stepper(NamedTuple):
    """Addresses of what is stepped and of what steps it.

    Attributes:
        step: Of ``mj_step``.
        get_state: Of ``mj_getState``.
        set_state: Of ``mj_setState``.
    """

    model: int
    data: int
    step: int
    get_state: int
    set_state: int


def stepper(model: mujoco.MjModel, data: mujoco.MjData) -> Stepper:
    """The addresses for a kernel; model and data must outlive their use."""
    library = _library()
    functions = (
        ctypes.cast(function, ctypes.c_void_p).value or 0
        for function in (library.mj_step, library.mj_getState, library.mj_setState)
    )
    return Stepper(model._address, data._address, *functions)  # noqa: SLF001 - MuJoCo has no public place for it


def _library() -> ctypes.CDLL:
    """The library that the Python package has loaded."""
    folder = Path(mujoco.__file__).parent
    names = ("libmujoco.so.*", "libmujoco.*.dylib", "mujoco.dll")
    (path,) = (path for name in names for path in folder.glob(name))
    return ctypes.CDLL(str(path))


def _step(_context: Any, step: Any, model: Any, data: Any) -> Any:
    """What Numba asks for: the types, and the code of a call."""

    def code(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        address, *pointers = arguments
        pointer = ir.IntType(8).as_pointer()
        kind = ir.FunctionType(ir.VoidType(), [pointer, pointer])
        function = builder.inttoptr(address, kind.as_pointer())
        builder.call(function, [builder.inttoptr(each, pointer) for each in pointers])
        return ir.Constant(ir.IntType(64), 0)

    return types.int64(step, model, data), code


step_machine: Any = intrinsic(_step)
"""``mj_step(model, data)``: takes the addresses of ``mj_step``, model and data; in kernels alone."""


def _pass_state(
    _context: Any, function: Any, model: Any, data: Any, state: Any, signature: Any
) -> Any:
    """What Numba asks for: the types, and the code of a call."""

    def code(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        address, *pointers, what = arguments
        pointer = ir.IntType(8).as_pointer()
        number = ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [pointer, pointer, pointer, number])
        function = builder.inttoptr(address, kind.as_pointer())
        placed = [builder.inttoptr(each, pointer) for each in pointers]
        builder.call(function, [*placed, builder.trunc(what, number)])
        return ir.Constant(ir.IntType(64), 0)

    return types.int64(function, model, data, state, signature), code


pass_state: Any = intrinsic(_pass_state)
"""``mj_getState`` or ``mj_setState(model, data, state, signature)``: takes the addresses of the function,
model, data and state, and the signature; in kernels alone."""
