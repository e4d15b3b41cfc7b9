"""A digital twin of a 4-axis mill.

NC text flows one way through six rooms: ``nc`` reads it, ``toolpath`` knows its geometry,
``motion`` plans it, ``machine`` simulates it, ``compare`` judges it; ``cutting`` and ``render``
watch. ``twin.interpret``, ``twin.plan``, ``twin.run`` and ``twin.compare`` are the Python API
(``twin.api``).
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from twin.api import compare, interpret, plan, run

from twin.version import __version__

__all__ = ["__version__", "compare", "interpret", "plan", "run"]


def __getattr__(name: str) -> Any:
    """The Python API, loaded when it is first asked for: ``import twin`` alone stays quick."""
    if name in __all__:
        from twin import api

        return getattr(api, name)
    raise AttributeError(f"module 'twin' has no attribute '{name}'")
