"""What the SINUMERIK knows and the twin passes over or refuses, by its name: ``known.toml``."""

import tomllib
from collections.abc import Mapping
from pathlib import Path

_DATA: Mapping[str, Mapping[str, str]] = tomllib.loads(
    Path(__file__).with_name("known.toml").read_text(encoding="utf-8")
)


def _each(of_names: Mapping[str, str]) -> dict[str, str]:
    """What is said of every name, given that of names with commas between them."""
    return {name: said for names, said in of_names.items() for name in names.split(", ")}


PASSED_CODES, REFUSED_CODES = _DATA["passed_codes"], _DATA["refused_codes"]
"""What is said of codes, by their names with commas between them."""
PASSED_STATEMENTS = _each(_DATA["passed_statements"])
REFUSED_STATEMENTS = _each(_DATA["refused_statements"])
"""What is said of statements, by each name."""
