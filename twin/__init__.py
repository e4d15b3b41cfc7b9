"""A digital twin of a 4-axis mill.

NC text flows one way through six rooms: ``nc`` reads it, ``toolpath`` knows its geometry,
``motion`` plans it, ``machine`` simulates it, ``compare`` judges it; ``cutting`` and ``render``
watch. ``twin.interpret``, ``twin.plan``, ``twin.run`` and ``twin.compare`` are the Python API
(``twin.api``).
"""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from twin.kernel_cache import forget_stale

if TYPE_CHECKING:
    from twin.api import compare, interpret, plan, run

__version__ = "0.1.0"
__all__ = ["__version__", "compare", "interpret", "plan", "run"]

forget_stale(Path(__file__).parent)


def __getattr__(name: str) -> Any:
    """The Python API, loaded when it is first asked for: ``import twin`` alone stays quick."""
    if name in __all__:
        from twin import api

        return getattr(api, name)
    raise AttributeError(f"module 'twin' has no attribute '{name}'")
