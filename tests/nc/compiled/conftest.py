"""The compiler sets CPython's limit of recursion, which hypothesis watches: it is loaded before any example."""

import twin.compilation.kernel  # noqa: F401
