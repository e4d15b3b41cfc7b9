"""A digital twin of a 4-axis mill.

NC text flows one way through six rooms: ``nc`` reads it, ``toolpath`` knows its geometry,
``motion`` plans it, ``machine`` simulates it, ``compare`` judges it; ``cutting`` and ``render``
watch. ``twin.interpret``, ``twin.plan``, ``twin.run`` and ``twin.compare`` are the Python API
(``twin.api``).
"""

import sys
import types
from typing import TYPE_CHECKING, Any

from twin.version import __version__

if TYPE_CHECKING:
    from twin.api import compare, interpret, plan, run

__all__ = ["__version__", "compare", "interpret", "plan", "run"]


class _CallableRoom(types.ModuleType):
    """A room that bears the name of a function of the Python API is that function too."""

    def __call__(self, *arguments: Any, **options: Any) -> Any:
        from twin import api

        return getattr(api, self.__name__.rpartition(".")[2])(*arguments, **options)


class _Package(types.ModuleType):
    """Whoever imports the room ``twin.run`` binds its name here and must not hide ``twin.run()``."""

    def __setattr__(self, name: str, value: Any) -> None:
        if name in __all__ and isinstance(value, types.ModuleType):
            value.__class__ = _CallableRoom
        super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package


def __getattr__(name: str) -> Any:
    """The Python API, loaded when it is first asked for: ``import twin`` alone stays quick."""
    if name in __all__:
        from twin import api

        return getattr(api, name)
    raise AttributeError(f"module 'twin' has no attribute '{name}'")
