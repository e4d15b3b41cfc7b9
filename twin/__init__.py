"""A digital twin of a 4-axis mill: NC text in, a verdict, a part and a picture out.

    import twin

    moves = twin.interpret("G1 X10 F100", dialect="haas")
    setpoints = twin.plan("part.nc")
    result = twin.run("part.toml", out="out/part")
    variants = twin.sweep("part.toml", {"machine.axes.X.kv": [5.0, 7.5]})
    difference = twin.compare("out/part/recording.h5", "log.csv")

Each function's help has shapes, units and an example. Errors are raised as ``twin.errors.TwinError``.
"""

import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from twin.api import (
        Job,
        Machine,
        Result,
        Session,
        Stock,
        Tolerance,
        Tool,
        compare,
        interpret,
        plan,
        run,
        sweep,
    )

from twin.version import __version__

__all__ = [
    "Job",
    "Machine",
    "Result",
    "Session",
    "Stock",
    "Tolerance",
    "Tool",
    "__version__",
    "compare",
    "interpret",
    "plan",
    "run",
    "sweep",
]


def __getattr__(name: str) -> Any:
    """The Python API, loaded when it is first asked for: ``import twin`` alone stays quick."""
    if name in __all__:
        from twin import api

        return getattr(api, name)
    raise AttributeError(f"module 'twin' has no attribute '{name}'")


def __dir__() -> list[str]:
    """The public names; packages are imported by their own names."""
    return sorted(__all__)


class _Package(ModuleType):
    """Keeps ``twin.run`` and ``twin.compare`` functions, although packages have these names."""

    def __setattr__(self, name: str, value: object) -> None:
        if not (name in __all__ and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
