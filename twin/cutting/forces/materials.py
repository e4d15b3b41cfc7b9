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
    """The constants of a stock's material, or None where the job gives none; its own outweigh the table's.

    Raises:
        ConfigError: The material is not known.
    """
    known = materials()
    if stock.specific_force is not None and stock.exponent is not None:
        density = stock.density or 0.0
        if not density and stock.material in known:
            density = known[stock.material].density
        return Kienzle(stock.specific_force, stock.exponent, density, "the job")
    if stock.material is None:
        return None
    if stock.material not in known:
        names = ", ".join(sorted(known))
        raise ConfigError(
            f"stock.material = '{stock.material}' is not known: there are {names}; of another give "
            "stock.specific_force (kc1.1 [N/mm²]) and stock.exponent (mc)"
        )
    return known[stock.material]
