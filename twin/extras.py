"""What the package's extras bring, for commands that need one."""

from importlib.util import find_spec

from twin.errors import UsageError

PACKAGES = {
    "calibrate": ("scipy", "threadpoolctl"),
    "cluster": ("ray",),
    "fmu": ("pythonfmu3",),
    "gym": ("gymnasium",),
    "notebook": ("pandas",),
    "opcua": ("asyncua", "starlette", "uvicorn"),
    "serve": ("starlette", "uvicorn"),
    "train": ("starlette", "uvicorn", "websockets"),
}
"""Packages of each extra, as ``pyproject.toml`` has them."""


def require_extra(extra: str, what: str) -> None:
    """Refuse what needs an extra where a package of it is missing.

    Args:
        what: What needs it, as a message begins.

    Raises:
        UsageError: Packages are missing; the message names all of them and how to get them.
    """
    missing = [name for name in PACKAGES[extra] if find_spec(name) is None]
    if missing:
        raise UsageError(
            f"{what} needs {' and '.join(missing)}: install mill-twin with its extra '{extra}' "
            f"(in a clone: pip install -c constraints.txt -e '.[{extra}]')"
        )
