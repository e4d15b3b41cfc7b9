"""What the cut came to, in words for the report."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

_FIGURES: tuple[tuple[str, str, Callable[[float], str]], ...] = (
    ("removed_mm3", "Material removed", lambda v: f"{v / 1000.0:,.2f} cm³"),
    ("air_share", "Share of the feed path in air", lambda v: f"{v:.1%}"),
    ("force_n", "Greatest mean cutting force", lambda v: f"{v:,.0f} N"),
    ("power_w", "Greatest mean cutting power", lambda v: f"{v:,.0f} W"),
    ("cell_mm", "Grid of the height map", lambda v: f"{v:g} mm"),
)
_EVENTS = {
    "rapid": "rapid into the stock",
    "flute": "cut deeper than the flutes are long",
    "shank": "shank in the material",
    "holder": "holder in the material",
}


def cut_figures(cut: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Name and value of every figure that was reckoned."""
    return [(name, text(cut[key])) for key, name, text in _FIGURES if cut.get(key) is not None]


def cut_events(cut: Mapping[str, Any]) -> Sequence[Mapping[str, Any]]:
    """What the cut must not do, by time: ``what`` in words, ``line``, ``time_s``, ``depth_mm``."""
    events = [*cut.get("gouges", ()), *cut.get("rapid_into_stock", ())]
    events.sort(key=lambda event: event["time_s"])
    return [{**event, "what": _EVENTS.get(event["what"], event["what"])} for event in events]
