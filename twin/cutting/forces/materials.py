"""What materials resist with, read from one table with its sources."""

import dataclasses
import functools
from pathlib import Path

from twin.errors import ConfigError
from twin.files.toml import load_toml
from twin.job.job_file import StockTable


@dataclasses.dataclass(frozen=True, slots=True)
class Kienzle:
    """How a material resists: kc = kc1.1 h^-mc (Kienzle, 1952).

    Attributes:
        kc: Specific cutting force of a chip 1 mm wide and 1 mm thick [N/mm²].
        mc: Its fall with the chip's thickness.
        density: [g/cm³].
        source: Where the first two are published.
    """

    kc: float
    mc: float
    density: float
    source: str = ""


@functools.cache
def materials() -> dict[str, Kienzle]:
    """Every known material by the name that a job gives it."""
    tables = load_toml(Path(__file__).with_name("materials.toml"))
    return {
        name: Kienzle(table["specific_force"], table["exponent"], table["density"], table["source"])
        for name, table in tables.items()
    }


def kienzle(stock: StockTable) -> Kienzle | None:
    """The constants of a stock's material, or None where the job names none.

    Raises:
        ConfigError: The material is not known.
    """
    if stock.material is None:
        return None
    known = materials()
    if stock.material not in known:
        names = ", ".join(sorted(known))
        raise ConfigError(f"stock.material = '{stock.material}' is not known: there are {names}")
    return known[stock.material]
