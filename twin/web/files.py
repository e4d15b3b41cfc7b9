"""The files of the pages: our own, and three.js, which the set-up puts beside them."""

from pathlib import Path

from twin.errors import UsageError

ASSETS = Path(__file__).resolve().parent / "assets"
THREE = ASSETS / "three"
"""Put there by ``scripts/fetch_three.py``; not committed."""


def require_three() -> None:
    """Refuse to open a page without the view's library.

    Raises:
        UsageError: It is not there.
    """
    if not (THREE / "three.module.js").is_file():
        raise UsageError(
            "three.js is missing, which a checkout fetches when it is set up: "
            "run scripts/setup.sh, or python scripts/fetch_three.py"
        )
