"""A jog as the block that an operator would have typed for it."""

from twin.nc.control.dialect import Dialect
from twin.nc.control.modal import FEED_FACTORS, FeedMode


def jog_block(dialect: Dialect, axis: str, distance: float, feed: float) -> str:
    """One straight move by a distance, in a control's own language.

    Args:
        dialect: The control's.
        axis: Name of the axis.
        distance: How far, and which way [mm or deg].
        feed: [mm/min or deg/min]
    """
    mode = dialect.start_state.get("feed_mode", FeedMode.PER_MINUTE)
    return f"N1 G91 G1 {axis}{_written(distance)} F{_written(feed / FEED_FACTORS[mode])}"


def _written(number: float) -> str:
    """A number to a nanometre, without an exponent and without zeros that say nothing."""
    return f"{number:.6f}".rstrip("0").rstrip(".")
