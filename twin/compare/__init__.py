"""A recording against the toolpath: figures, verdict, report. Knows nothing of MuJoCo.

The package is a function too: ``twin.compare(first, second)`` of the Python API and this room bear
one name.
"""

import sys
import types
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from twin.compare.track_comparison import TrackDifference


class _Compare(types.ModuleType):
    def __call__(self, *arguments: Any, **options: Any) -> "TrackDifference":
        """Compare two recordings, or a recording and a log: see ``twin.api.compare``."""
        from twin.compare.track_comparison import compare_files

        return compare_files(*arguments, **options)


sys.modules[__name__].__class__ = _Compare
